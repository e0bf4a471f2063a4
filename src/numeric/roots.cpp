#include "numeric/roots.hpp"

#include <utility>

namespace doppel {
namespace {

using Coefficients = std::pmr::vector<double>;

/// Zero counts as positive, so that a rise ends where 0 is reached.
int sign_changes(const Coefficients& b) {
    int changes = 0;
    for (std::size_t i = 1; i < b.size(); ++i) changes += (b[i - 1] < 0) != (b[i] < 0);
    return changes;
}

/// The coefficients of both halves, by de Casteljau's algorithm.
std::pair<Coefficients, Coefficients> halves(const Coefficients& whole) {
    Coefficients left(whole, whole.get_allocator()), right(whole, whole.get_allocator());
    for (std::size_t i = 1; i < right.size(); ++i) {
        for (std::size_t j = 0; j + i < right.size(); ++j) right[j] = 0.5 * (right[j] + right[j + 1]);
        left[i] = right[0];
    }
    return {std::move(left), std::move(right)};
}

void add_rises(const Coefficients& b, const Bracket& part, int halved, std::pmr::vector<Bracket>& found) {
    constexpr int max_halvings = 50;
    const int changes = sign_changes(b);
    if (changes == 0) return;
    if (changes == 1 || halved == max_halvings) {
        if (b.front() < 0 && !(b.back() < 0)) found.push_back(part);
        return;
    }
    const auto [left, right] = halves(b);
    const double middle = 0.5 * (part.low + part.high);
    add_rises(left, {part.low, middle}, halved + 1, found);
    add_rises(right, {middle, part.high}, halved + 1, found);
}

}  // namespace

/// b_j = Σ_i C(j,i) a_i length^i / C(n,i), in n rounds of sums.
Bernstein Bernstein::of_powers(std::span<const double> a, double length, std::pmr::memory_resource* memory) {
    const auto n = a.size() - 1;
    Bernstein polynomial{.b = Coefficients(a.begin(), a.end(), memory), .length = length};
    auto& b = polynomial.b;
    double factor = 1;  // length^i / C(n,i)
    for (std::size_t i = 1; i <= n; ++i) {
        factor *= length * (static_cast<double>(i) / static_cast<double>(n + 1 - i));
        b[i] *= factor;
    }
    for (std::size_t round = 1; round <= n; ++round)
        for (std::size_t j = n; j >= round; --j) b[j] += b[j - 1];
    return polynomial;
}

std::pmr::vector<Bracket> Bernstein::rises(double level) const {
    Coefficients above(b, b.get_allocator());
    for (double& value : above) value -= level;
    std::pmr::vector<Bracket> found(b.get_allocator());
    add_rises(above, {0, length}, 0, found);
    return found;
}

}  // namespace doppel
