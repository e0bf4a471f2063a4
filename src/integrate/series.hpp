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
template <class Scalar, int N>
class PhysicalChain;

/// The Taylor series in time of a motion about one state.
template <class S>
class Series {
public:
    using Scalar = S;
    using State = doppel::State<Scalar, Eigen::Dynamic>;

    virtual ~Series() = default;
    /// Computes the series about y: rates up to the order, coordinates up to one more.
    virtual void expand(const State& y) = 0;
    /// change ← y(t + h) − y(t) by the series.
    virtual void move(const Scalar& h, State& change) = 0;
    /// Coefficient k of the rate of coordinate i, in double.
    virtual double rate(int k, Eigen::Index i) const = 0;
    /// The time, s, just after the first event at which the series becomes invalid; at most h.
    virtual double first_event(double h) const { return h; }
    /// The limit of a step, s, however smooth the motion seems.
    double longest_step() const { return longest_step_; }

    /// The largest coefficient k of the rates divided by their scale, 1/s^k; NaN if a coefficient is NaN. The scale is
    /// max |ω_i| + √max |ω_i′|, where an acceleration a, m/s², counts as √(length |a|); it is 0 only at rest in an
    /// equilibrium.
    double size(int k) const { return scale_ == 0 ? 0 : static_cast<double>(largest(k)) / scale_; }
    /// log2(tolerance / size(k)), also if that size exceeds double: in quad, coefficients like 10^(14 k) are usual soon
    /// after rest with quadratic drag, or with a very light mass. NaN if the coefficient is not finite.
    double log2_tolerance_ratio(double tolerance, int k) const {
        const double now = size(k);
        if (!is_quad_tape_ && now <= std::numeric_limits<double>::max()) return rough_log2(tolerance / now);
        Scalar size = largest(k);
        if (!(size - size == Scalar(0))) return std::numeric_limits<double>::quiet_NaN();  // infinite, or NaN
        if (scale_ == 0) return std::numeric_limits<double>::infinity();
        constexpr int shift = 512;
        int shifts = 0;
        for (; size > Scalar(0x1p512); ++shifts) size *= Scalar(0x1p-512);
        return rough_log2(tolerance) - (rough_log2(static_cast<double>(size) / scale_) + shift * shifts);
    }

protected:
    /// The ratios of a tape in quad are always those of the wider range: their last digits differ.
    explicit Series(double longest_step, bool is_quad_tape = false)
        : longest_step_(longest_step), is_quad_tape_(is_quad_tape) {}

    /// The largest coefficient k of the rates, rad/s or m/s over s^k.
    virtual Scalar largest(int k) const = 0;
    /// After each expansion.
    void take_scale(double length = 1) {
        scale_ = static_cast<double>(largest(0)) + std::sqrt(length * static_cast<double>(largest(1)));
    }

private:
    double longest_step_, scale_ = 0;
    bool is_quad_tape_;
};

/// The series of a model up to an order. All memory is allocated here, or at the first expansion. The series of rigid
/// bodies uses the modes of the model's joints, so the model must outlive it.
template <class Scalar>
std::unique_ptr<Series<Scalar>> series_of(const Pendulum<Scalar>& p, int order);
template <class Scalar>
std::unique_ptr<Series<Scalar>> series_of(const PhysicalChain<Scalar, Eigen::Dynamic>& model, int order);
template <class Scalar>
std::unique_ptr<Series<Scalar>> series_of(const Assembly<Scalar>& parts, int order);
// Each scalar is compiled in its own file.
template <class Scalar>
using SeriesOfBodies = std::unique_ptr<Series<Scalar>>(const PhysicalChain<Scalar, Eigen::Dynamic>& model, int order);
template <class Scalar>
using SeriesOfMechanism = std::unique_ptr<Series<Scalar>>(const Assembly<Scalar>& parts, int order);

/// The number of last coefficients that determine a step. It is four, because in a motion from rest at 90° three of
/// every four vanish.
inline constexpr int watched_coefficients = 4;

/// Twice √(l/g) of an outstretched chain, s, about a third of its longest period.
inline double longest_chain_step(double reach, double gravity) {
    return gravity == 0 ? std::numeric_limits<double>::max() : 2 * std::sqrt(reach / std::abs(gravity));
}

}  // namespace doppel
