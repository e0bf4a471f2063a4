#pragma once

#include "integrate/dormand_prince.hpp"
#include "integrate/events.hpp"
#include "track/model.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <optional>
#include <utility>

namespace doppel {

/// The coefficients of Dormand & Prince's order 5: six stages, then the weights of the step.
inline constexpr auto fifth_order = [] {
    std::array<std::array<double, 6>, 7> a{};
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < 6; ++j) {
            const auto& fraction = Dopri5::pair.a[i][j];
            a[i][j] = static_cast<double>(fraction.numerator) / static_cast<double>(fraction.denominator);
        }
    return a;
}();

/// y + h Σ a_j k_j over the stages j of a row.
template <std::size_t row, std::size_t... j>
double stage_sum(std::index_sequence<j...>, double h, double y, const std::same_as<double> auto&... k) {
    return (y + ... + ((h * fifth_order[row][j]) * k));
}
template <std::size_t row, std::size_t... j, int N>
Dual<double, N> stage_sum(std::index_sequence<j...>, double h, const Dual<double, N>& y,
                          const std::same_as<Dual<double, N>> auto&... k) {
    return {(y.value + ... + ((h * fifth_order[row][j]) * k.value)),
            (y.tangent + ... + ((h * fifth_order[row][j]) * k.tangent))};
}
template <std::size_t row, class Stages, class Scalar>
ArmState<Scalar> stage_sums(Stages stages, double h, const ArmState<Scalar>& y, const auto&... k) {
    const auto of = [&](std::size_t q) { return stage_sum<row>(stages, h, y[q], k[q]...); };
    return {of(0), of(1), of(2), of(3)};
}

/// One fixed step of h seconds: the state and its slope, which is the first stage of the next step. Steps are fixed so
/// that derivatives are those of what is computed.
template <class Model, class Scalar>
void take_step(const Model& arms, double h, ArmState<Scalar>& y, ArmState<Scalar>& slope) {
    const auto& k0 = slope;
    const auto k1 = arms.rate(stage_sums<1>(std::index_sequence<0>(), h, y, k0));
    const auto k2 = arms.rate(stage_sums<2>(std::index_sequence<0, 1>(), h, y, k0, k1));
    const auto k3 = arms.rate(stage_sums<3>(std::index_sequence<0, 1, 2>(), h, y, k0, k1, k2));
    const auto k4 = arms.rate(stage_sums<4>(std::index_sequence<0, 1, 2, 3>(), h, y, k0, k1, k2, k3));
    const auto k5 = arms.rate(stage_sums<5>(std::index_sequence<0, 1, 2, 3, 4>(), h, y, k0, k1, k2, k3, k4));
    static_assert(fifth_order[6][1] == 0);
    y = stage_sums<6>(std::index_sequence<0, 2, 3, 4, 5>(), h, y, k0, k2, k3, k4, k5);
    slope = arms.rate(y);
}

/// The angle at t seconds into a step of h: the polynomial of degree 5 through angle, rate and acceleration at both
/// ends (error h⁶ θ⁽⁶⁾/46080). Weights of these six, in that order.
struct AngleWeights {
    std::array<double, 6> angle;

    AngleWeights(double t, double h) {
        const double s = t / h, s2 = s * s, s3 = s2 * s, s4 = s3 * s, s5 = s4 * s;
        angle = {1 - 10 * s3 + 15 * s4 - 6 * s5,
                 h * (s - 6 * s3 + 8 * s4 - 3 * s5),
                 h * h * (0.5 * s2 - 1.5 * s3 + 1.5 * s4 - 0.5 * s5),
                 10 * s3 - 15 * s4 + 6 * s5,
                 h * (-4 * s3 + 7 * s4 - 3 * s5),
                 h * h * (0.5 * s3 - s4 + 0.5 * s5)};
    }
};

/// Those of its rate.
inline std::array<double, 6> rate_weights(double t, double h) {
    const double s = t / h, s2 = s * s, s3 = s2 * s, s4 = s3 * s;
    return {(-30 * s2 + 60 * s3 - 30 * s4) / h, 1 - 18 * s2 + 32 * s3 - 15 * s4, h * (s - 4.5 * s2 + 6 * s3 - 2.5 * s4),
            (30 * s2 - 60 * s3 + 30 * s4) / h,  -12 * s2 + 28 * s3 - 15 * s4,    h * (1.5 * s2 - 4 * s3 + 2.5 * s4)};
}

template <class Scalar>
double value_of(const Scalar& x) {
    if constexpr (requires { x.tangent; })
        return x.value;
    else
        return x;
}

/// The arms of a model, which may carry derivatives, too.
template <class Model>
auto& arms_in(Model& model) {
    if constexpr (requires { model.arms; })
        return model.arms;
    else
        return model;
}

/// The motion from one start, step after step, to be asked for angles at ascending times.
///
/// Of sharp dry friction each step keeps to one law and counts as far as that holds, until a joint comes to rest or is let
/// go. Then the slope f jumps, and with it how the state changes with what fixes the time t* of the event:
///     ∂y after = ∂y before + (f before − f after) ∂t*,   ∂t* = −∂ω/ω′ of the joint's rate ω
template <class Scalar, class Model = Arms<Scalar>>
class Flow {
public:
    Flow(const Model& arms, const ArmState<Scalar>& start, double step)
        : arms_(arms), step_(step), before_(start), slope_before_(start) {
        arms_in(arms_).take_modes(value_of(start[2]), value_of(start[3]));
        slope_before_ = arms_.rate(start);
        go_on();
    }

    /// Steps on until `t` (s from the start) is in the last step. False where the motion left what is finite.
    bool reach(double t) {
        while (t > end()) {
            if (event_) {
                if (!turn_over()) return false;
            } else {
                std::swap(before_, after_);
                std::swap(slope_before_, slope_after_);
                ++done_;
            }
            if (!go_on()) return false;
        }
        return true;
    }

    /// For a time in the last step, or a little outside.
    AngleWeights weights(double t) const { return {t - begin(), step_}; }
    /// What these weights weigh, of one arm, 0 or 1.
    std::array<const Scalar*, 6> nodes(std::size_t arm) const {
        return {&before_[arm], &before_[arm + 2], &slope_before_[arm + 2],
                &after_[arm],  &after_[arm + 2],  &slope_after_[arm + 2]};
    }
    Scalar angle(std::size_t arm, double t) const {
        const auto of = weights(t);
        const auto values = nodes(arm);
        Scalar sum(0);
        for (std::size_t k = 0; k < 6; ++k) sum += of.angle[k] * *values[k];
        return sum;
    }

    /// The values alone of a Scalar with derivatives.
    double angle_value(std::size_t arm, double t) const { return weighed(arm, weights(t).angle); }
    double angle_rate(std::size_t arm, double t) const { return weighed(arm, rate_weights(t - begin(), step_)); }
    ArmState<double> values_at(double t) const {
        return {angle_value(0, t), angle_value(1, t), angle_rate(0, t), angle_rate(1, t)};
    }

    /// Its state at the end of the last step, at `time()` s; where an event cut that, as the law before would have it.
    const ArmState<Scalar>& state() const { return after_; }
    double time() const { return origin_ + static_cast<double>(done_ + 1) * step_; }

private:
    struct Event {
        double after;  // s into the step
        std::size_t joint;
    };

    double begin() const { return origin_ + static_cast<double>(done_) * step_; }
    double end() const { return event_ ? begin() + event_->after : time(); }

    static ArmState<double> values(const ArmState<Scalar>& y) {
        return {value_of(y[0]), value_of(y[1]), value_of(y[2]), value_of(y[3])};
    }
    static double rate_of(const ArmState<double>& y, std::size_t joint) { return joint == 0 ? y[2] : y[3] - y[2]; }
    double weighed(std::size_t arm, const std::array<double, 6>& by) const {
        const auto all = nodes(arm);
        double sum = 0;
        for (std::size_t k = 0; k < 6; ++k) sum += by[k] * value_of(*all[k]);
        return sum;
    }

    bool go_on() {
        after_ = before_;
        slope_after_ = slope_before_;
        take_step(arms_, step_, after_, slope_after_);
        event_.reset();
        constexpr double fastest = 1e4;  // rad/s
        const bool is_finite = after_[2] < Scalar(fastest) && after_[2] > Scalar(-fastest) &&
                               after_[3] < Scalar(fastest) && after_[3] > Scalar(-fastest);
        if (is_finite && arms_in(arms_).is_sharp())
            for (std::size_t joint = 0; joint < 2; ++joint) find_event(joint);
        return is_finite;
    }

    /// 0 or more while the joint keeps to its mode, at t seconds into the step.
    double margin(std::size_t joint, double t) const {
        const auto& law = arms_in(arms_);
        if (law.modes[joint] == 0) return most_held(joint) - std::abs(law.holding(values_at(begin() + t))[joint]);
        const auto by = rate_weights(t, step_);
        return law.modes[joint] * rate_of({0, 0, weighed(0, by), joint == 0 ? 0 : weighed(1, by)}, joint);
    }
    double most_held(std::size_t joint) const {
        constexpr double rounding = 1e-12;
        return arms_in(arms_).p[index_of(FitParameter::coulomb_1) + joint] * (1 + rounding);
    }

    /// An event of this joint before those already found: at the end, or where its rate is nearest to rest before.
    void find_event(std::size_t joint) {
        double last = event_ ? event_->after : step_;
        if (!(margin(joint, last) < 0)) {
            const int mode = arms_in(arms_).modes[joint];
            const double slope = mode * rate_of(values(slope_before_), joint);
            const double slope_then = mode * rate_of(values(slope_after_), joint);
            if (!(slope < 0 && slope_then > 0)) return;
            last = std::min(last, step_ * slope / (slope - slope_then));
            if (!(margin(joint, last) < 0)) return;
        }
        event_ = {bisect_event(0.0, last, step_, [&](double t) { return margin(joint, t); }), joint};
    }

    /// Goes to the event and on by the law that holds from there. False where they are too many to end.
    bool turn_over() {
        constexpr double at_once = 100, a_step = 4;  // events
        const auto [after, joint] = *event_;
        take_step(arms_, after, before_, slope_before_);
        auto& law = arms_in(arms_);
        int& mode = law.modes[joint];
        const bool was_held = mode == 0;
        auto at_rest = values(before_);
        at_rest[joint + 2] = joint == 0 ? 0 : at_rest[2];
        if (law.is_held(1)) at_rest[3] = at_rest[2];
        mode = 0;
        const double torque = law.holding(at_rest)[joint];
        if (was_held || std::abs(torque) > most_held(joint)) mode = torque < 0 ? -1 : 1;
        const auto slope = arms_.rate(before_);
        if constexpr (requires(Scalar y) { y.tangent; }) {
            const double rate_slope = rate_of(values(slope_before_), joint);
            if (!was_held && rate_slope != 0) {
                auto rate = before_[2].tangent;
                if (joint == 1) rate = before_[3].tangent - before_[2].tangent;
                for (std::size_t q = 2; q < 4; ++q)
                    before_[q].tangent -= ((slope_before_[q].value - slope[q].value) / rate_slope) * rate;
            }
        }
        if (law.is_held(0)) before_[2] = Scalar(0);
        if (law.is_held(1)) before_[3] = before_[2];
        slope_before_ = arms_.rate(before_);
        origin_ = begin() + after;
        done_ = 0;
        ++events_;
        return events_ < at_once + a_step * origin_ / step_;
    }

    Model arms_;
    double step_, origin_ = 0;  // s, of the last event or the start
    long done_ = 0;             // steps since
    double events_ = 0;
    std::optional<Event> event_;  // that cuts the last step
    ArmState<Scalar> before_, slope_before_, after_, slope_after_;
};

}  // namespace doppel
