#pragma once

#include "numeric/lanes.hpp"
#include "physics/pendulum.hpp"

#include <cmath>
#include <concepts>
#include <limits>

namespace doppel {

/// The Taylor series in time of a model's motion about one state, by recurrence, order after order.
///
///     (const Model&, int order)               allocates all it will need
///     expand(const State& y)                  the series about y: rates to the order, coordinates to one more
///     move(const Scalar& h, State& change)    change ← y(t + h) − y(t), by the series
///     size(int k)                             the greatest coefficient k of the rates over the rates' amount, 1/s^k;
///                                             NaN where a coefficient is NaN
///     longest_step()                          s, what no step should exceed however smooth the motion seems
///
/// The rates' amount is max |ω_i| + √max |ω_i′|: never 0 but at rest in an equilibrium.
template <class S, class Model>
concept TaylorSeries = std::constructible_from<S, const Model&, int> &&
    requires(S series, const typename Model::State& y, typename Model::State& change, const typename Model::Scalar& h,
             int k) {
    series.expand(y);
    series.move(h, change);
    { series.size(k) } -> std::convertible_to<double>;
    { series.longest_step() } -> std::convertible_to<double>;
};

/// The series of a model: specialised, with a member `type`, in the one header that defines the series.
template <class Model>
struct SeriesOf;

template <class Model>
concept HasSeries = requires {
    requires TaylorSeries<typename SeriesOf<Model>::type, Model>;
};

/// How many of the last coefficients a step goes by. Four, because of a motion from rest at 90° three in every four
/// vanish.
inline constexpr int watched_coefficients = 4;

/// The order that a tolerance takes: more than the usual 1 − ½ ln ε, since the work grows more like p than like p².
inline int taylor_order(double tolerance) {
    return static_cast<int>(std::lround(10 - 0.5 * std::log(tolerance)));
}

/// A number in double, without the derivatives it may carry: what step control goes by.
template <class Scalar>
double plain_value(const Scalar& x) {
    if constexpr (requires { x.value; })
        return plain_value(x.value);
    else
        return static_cast<double>(x);
}

/// Twice √(l/g) of a chain outstretched, s, about a third of its slowest swing.
inline double longest_chain_step(double reach, double gravity) {
    return gravity == 0 ? std::numeric_limits<double>::max() : 2 * std::sqrt(reach / std::abs(gravity));
}

}  // namespace doppel
