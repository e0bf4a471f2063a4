#include "analysis/share_at_least.hpp"

#include <cmath>

namespace doppel {
namespace {

/// That as many hits, or more, are drawn where the share is `share`.
double chance(int hits, int trials, double share) {
    double sum = 0;
    for (int k = hits; k <= trials; ++k)
        sum += std::exp(std::lgamma(trials + 1) - std::lgamma(k + 1) - std::lgamma(trials - k + 1) +
                        k * std::log(share) + (k < trials ? (trials - k) * std::log1p(-share) : 0));
    return sum;
}

}  // namespace

double share_at_least(int hits, int trials) {
    constexpr double unlikely = 0.05;
    if (hits == 0) return 0;
    double low = 0, high = 1;
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        (chance(hits, trials, middle) < unlikely ? low : high) = middle;
    }
    return low;
}

}  // namespace doppel
