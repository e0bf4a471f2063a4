#include "numeric/bernstein.hpp"

#include <utility>

namespace doppel {
namespace {

/// Zeros count as positive: a rise ends where 0 is reached.
int sign_changes(const std::vector<double>& b) {
    int changes = 0;
    for (std::size_t i = 1; i < b.size(); ++i) changes += (b[i - 1] < 0) != (b[i] < 0);
    return changes;
}

/// Both halves, by de Casteljau's averages.
std::pair<Bernstein, Bernstein> halves(const Bernstein& whole) {
    Bernstein left{whole.b}, right{whole.b};
    auto& average = right.b;
    for (std::size_t i = 1; i < average.size(); ++i) {
        for (std::size_t j = 0; j + i < average.size(); ++j) average[j] = 0.5 * (average[j] + average[j + 1]);
        left.b[i] = average[0];
    }
    return {left, right};
}

void add_rises(const Bernstein& part, double low, double high, int halved, std::vector<Bernstein::Bracket>& found) {
    constexpr int most_halved = 50;
    const int changes = sign_changes(part.b);
    if (changes == 0) return;
    if (changes == 1 || halved == most_halved) {
        if (part.b.front() < 0 && !(part.b.back() < 0)) found.push_back({low, high});
        return;
    }
    const auto [left, right] = halves(part);
    const double middle = 0.5 * (low + high);
    add_rises(left, low, middle, halved + 1, found);
    add_rises(right, middle, high, halved + 1, found);
}

}  // namespace

/// b_j = Σ_i C(j,i) a_i length^i / C(n,i), by n rounds of sums.
Bernstein Bernstein::of_powers(std::span<const double> a, double length) {
    const auto n = a.size() - 1;
    Bernstein polynomial;
    double power = 1, choose = 1;  // length^i, C(n,i)
    for (std::size_t i = 0; i <= n; ++i) {
        polynomial.b.push_back(a[i] * power / choose);
        power *= length;
        choose *= static_cast<double>(n - i) / static_cast<double>(i + 1);
    }
    for (std::size_t round = 1; round <= n; ++round)
        for (std::size_t j = n; j >= round; --j) polynomial.b[j] += polynomial.b[j - 1];
    return polynomial;
}

std::vector<Bernstein::Bracket> Bernstein::rises() const {
    std::vector<Bracket> found;
    add_rises(*this, 0, 1, 0, found);
    return found;
}

}  // namespace doppel
