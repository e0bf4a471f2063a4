#pragma once

#include "numeric/lanes.hpp"
#include "numeric/state.hpp"

#include <cmath>
#include <limits>
#include <memory>

namespace doppel {

template <class Scalar>
struct Pendulum;
template <class Scalar>
struct Assembly;
template <class Scalar>
class PhysicalChain;

/// The Taylor series in time of a motion about one state, order after order.
///
/// The rates' amount is max |ω_i| + √max |ω_i′|: never 0 but at rest in an equilibrium.
template <class S>
class Series {
public:
    using Scalar = S;
    using State = doppel::State<Scalar, Eigen::Dynamic>;

    virtual ~Series() = default;
    /// The series about y: rates to the order, coordinates to one more.
    virtual void expand(const State& y) = 0;
    /// change ← y(t + h) − y(t), by the series.
    virtual void move(const Scalar& h, State& change) = 0;
    /// The greatest coefficient k of the rates over the rates' amount, 1/s^k; NaN where a coefficient is NaN.
    virtual double size(int k) const = 0;
    /// log2 of how many of its size the tolerance holds; NaN where that is not finite.
    virtual double log2_room(double tolerance, int k) const {
        const double now = size(k);
        if (!(now <= std::numeric_limits<double>::max())) return std::numeric_limits<double>::quiet_NaN();
        return rough_log2(tolerance / now);
    }
    /// What no step should exceed however smooth the motion seems, s.
    virtual double longest_step() const = 0;
    /// At most h, s: just behind the first time at which the series ends to hold.
    virtual double first_event(double h) const { return h; }
    /// Coefficient k of the rate of coordinate i, in double.
    virtual double rate(int k, Eigen::Index i) const = 0;
};

/// The series of a model to an order. All memory is allocated here, or when it is first expanded. That of bodies asks the
/// model for the modes of its joints, and so the model must live as long.
template <class Scalar>
std::unique_ptr<Series<Scalar>> series_of(const Pendulum<Scalar>& p, int order);
template <class Scalar>
std::unique_ptr<Series<Scalar>> series_of(const PhysicalChain<Scalar>& model, int order);
template <class Scalar>
std::unique_ptr<Series<Scalar>> series_of(const Assembly<Scalar>& parts, int order);
// As they are compiled, one file a scalar.
template <class Scalar>
using SeriesOfBodies = std::unique_ptr<Series<Scalar>>(const PhysicalChain<Scalar>& model, int order);
template <class Scalar>
using SeriesOfMechanism = std::unique_ptr<Series<Scalar>>(const Assembly<Scalar>& parts, int order);

/// How many of the last coefficients a step goes by. Four, because of a motion from rest at 90° three in every four
/// vanish.
inline constexpr int watched_coefficients = 4;

/// Twice √(l/g) of a chain outstretched, s, about a third of its slowest swing.
inline double longest_chain_step(double reach, double gravity) {
    return gravity == 0 ? std::numeric_limits<double>::max() : 2 * std::sqrt(reach / std::abs(gravity));
}

}  // namespace doppel
