#pragma once

#include "numeric/lanes.hpp"
#include "physics/pendulum.hpp"

#include <cmath>
#include <limits>

namespace doppel {

/// The Taylor series in time of a model's motion about one state, by recurrence, order after order. A model that has
/// one specialises this with a member `type` that offers
///
///     type(const Model&, int order)           allocates all it will need
///     expand(const State& y)                  the series about y: rates to the order, coordinates to one more
///     move(const Scalar& h, State& change)    change ← y(t + h) − y(t), by the series
///     size(int k) → double                    the greatest coefficient k of the rates, in units of what the rates
///     amount
///                                             to, 1/s^k; not a number where a coefficient is none
///     longest_step() → double                 s, what no step should exceed however smooth the motion seems
///
/// The rates' amount is max |ω_i| + √max |ω_i′|: never 0 but at rest in an equilibrium.
template <class Model>
struct SeriesOf;

template <class Model>
concept HasSeries = requires {
    typename SeriesOf<Model>::type;
};

/// A number in double, without the derivatives it may carry: what step control looks at.
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
