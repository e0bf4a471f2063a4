#include "integrate/lane_series.hpp"

#include "integrate/angle_series.hpp"
#include "integrate/widths.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {

LaneRecurrence::~LaneRecurrence() = default;

LaneSeries::LaneSeries(const Pendulum<double>& p, int order, int width)
    : Series<double>(longest_chain_step(p.reach(), p.gravity)), links_(p.links()) {
    const auto make = at_width(std::min(chosen_width(width), 4),
                               []<int chosen>() { return make_lane_recurrence < chosen == 2 ? 2 : 4 > ; });
    lanes_.reset(make(p, order));
}

void LaneSeries::expand(const State& y) {
    lanes_->expand(y.data());
    take_scale();
}

double LaneSeries::largest(int k) const {
    const double* rates = lanes_->rates(k);
    double maximum = 0;
    for (std::size_t i = 0; i < links_; ++i) maximum = greater(maximum, std::abs(rates[i]));
    return maximum;
}

/// Not for a mass much lighter than the next one, for which the mass matrix of the lanes would lose digits.
template <>
std::unique_ptr<Series<double>> series_of(const Pendulum<double>& p, int order) {
    constexpr double light = 1.0 / 64;
    bool is_even = p.links() == 2 || p.links() == 3;
    for (std::size_t k = 0; k + 1 < p.links(); ++k) is_even = is_even && p.mass[k] >= light * p.mass[k + 1];
    if (is_even) return std::make_unique<LaneSeries>(p, order);
    return std::make_unique<AngleSeries<double>>(p, order);
}

}  // namespace doppel
