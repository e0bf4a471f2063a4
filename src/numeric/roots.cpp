#include "numeric/roots.hpp"

#include <utility>

namespace doppel {
namespace {

/// Zero counts as positive, so that a rise ends where 0 is reached.
int sign_changes(const std::vector<double>& b) {
    int changes = 0;
    for (std::size_t i = 1; i < b.size(); ++i) changes += (b[i - 1] < 0) != (b[i] < 0);
    return changes;
}

/// The coefficients of both halves, by de Casteljau's algorithm.
std::pair<std::vector<double>, std::vector<double>> halves(const std::vector<double>& whole) {
    auto left = whole, right = whole;
    for (std::size_t i = 1; i < right.size(); ++i) {
        for (std::size_t j = 0; j + i < right.size(); ++j) right[j] = 0.5 * (right[j] + right[j + 1]);
        left[i] = right[0];
    }
    return {left, right};
}

void add_rises(const std::vector<double>& b, const Bracket& part, int halved, std::vector<Bracket>& found) {
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
Bernstein Bernstein::of_powers(std::span<const double> a, double length) {
    const auto n = a.size() - 1;
    Bernstein polynomial{.b = std::vector<double>(a.begin(), a.end()), .length = length};
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

std::vector<Bracket> Bernstein::rises(double level) const {
    auto above = b;
    for (double& value : above) value -= level;
    std::vector<Bracket> found;
    add_rises(above, {0, length}, 0, found);
    return found;
}

}  // namespace doppel
