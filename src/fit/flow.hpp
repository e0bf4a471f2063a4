#pragma once

#include "fit/arms.hpp"
#include "integrate/dormand_prince.hpp"
#include "integrate/events.hpp"

#include <optional>

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

/// The angle at t seconds into a step of h: the polynomial of degree 5 through angle, rate and acceleration at both
/// ends (error h⁶ θ⁽⁶⁾/46080). Weights of these six, in that order.
inline std::array<double, 6> angle_weights(double t, double h) {
    const double s = t / h, s2 = s * s, s3 = s2 * s, s4 = s3 * s, s5 = s4 * s;
    return {1 - 10 * s3 + 15 * s4 - 6 * s5,
            h * (s - 6 * s3 + 8 * s4 - 3 * s5),
            h * h * (0.5 * s2 - 1.5 * s3 + 1.5 * s4 - 0.5 * s5),
            10 * s3 - 15 * s4 + 6 * s5,
            h * (-4 * s3 + 7 * s4 - 3 * s5),
            h * h * (0.5 * s3 - s4 + 0.5 * s5)};
}
/// Those of its rate.
inline std::array<double, 6> rate_weights(double t, double h) {
    const double s = t / h, s2 = s * s, s3 = s2 * s, s4 = s3 * s;
    return {(-30 * s2 + 60 * s3 - 30 * s4) / h, 1 - 18 * s2 + 32 * s3 - 15 * s4, h * (s - 4.5 * s2 + 6 * s3 - 2.5 * s4),
            (30 * s2 - 60 * s3 + 30 * s4) / h,  -12 * s2 + 28 * s3 - 15 * s4,    h * (1.5 * s2 - 4 * s3 + 2.5 * s4)};
}

/// Σ weight_j x_j of numbers that may carry derivatives.
template <class Scalar, std::size_t n>
Scalar weighed(const std::array<double, n>& weights, const std::array<const Scalar*, n>& x) {
    return [&]<std::size_t... j>(std::index_sequence<j...>)->Scalar {
        if constexpr (requires { x[0]->tangent; })
            return {(... + (weights[j] * x[j]->value)), (... + (weights[j] * x[j]->tangent))};
        else
            return (... + (weights[j] * *x[j]));
    }
    (std::make_index_sequence<n>());
}

/// The motion from one start, step after step, to be asked for angles at ascending times. Steps are fixed, so that
/// derivatives are those of what is computed.
///
/// With Coulomb friction each step keeps to one law and counts as far as that holds, until a joint comes to rest or is let
/// go. Then the slope f jumps, and with it how the state changes with what fixes the time t* of the event:
///     ∂y after = ∂y before + (f before − f after) ∂t*,   ∂t* = −∂ω/ω′ of the joint's rate ω
template <class Scalar>
class Flow {
public:
    Flow(const Arms<Scalar>& arms, const ArmState<Scalar>& start, double step)
        : arms_(arms), law_(arms.template cast<double>()), step_(step), before_(start) {
        law_.take_modes(values(start));
        arms_.modes = law_.modes;
        slope_before_ = arms_.rate(start);
        go_on();
    }

    /// Steps on until `t` (s from the start) is in the last step. False where the motion left what is finite.
    bool reach(double t) {
        while (t > (event_ ? begin() + event_->after : begin() + step_)) {
            if (event_) {
                if (!pass_event()) return false;
            } else {
                std::swap(before_, after_);
                std::swap(slope_before_, slope_after_);
                ++done_;
            }
            if (!go_on()) return false;
        }
        return true;
    }

    // For a time in the last step, or a little outside:

    Scalar angle(std::size_t arm, double t) const { return weighed(angle_weights(t - begin(), step_), nodes(arm)); }
    double rate(std::size_t arm, double t) const { return rate_in_step(arm, t - begin()); }
    ArmState<double> values_at(double t) const {
        return {value_of(angle(0, t)), value_of(angle(1, t)), rate(0, t), rate(1, t)};
    }

private:
    struct Event {
        double after;  // s into the step
        std::size_t joint;
    };

    double begin() const { return origin_ + static_cast<double>(done_) * step_; }
    static ArmState<double> values(const ArmState<Scalar>& y) {
        return {value_of(y[0]), value_of(y[1]), value_of(y[2]), value_of(y[3])};
    }
    std::array<const Scalar*, 6> nodes(std::size_t arm) const {
        return {&before_[arm], &before_[arm + 2], &slope_before_[arm + 2],
                &after_[arm],  &after_[arm + 2],  &slope_after_[arm + 2]};
    }
    double rate_in_step(std::size_t arm, double t) const {
        const auto weights = rate_weights(t, step_);
        const auto all = nodes(arm);
        double sum = 0;
        for (std::size_t k = 0; k < 6; ++k) sum += weights[k] * value_of(*all[k]);
        return sum;
    }

    /// y and its slope h seconds later; the slope is the first stage of the next step.
    void take_step(double h, ArmState<Scalar>& y, ArmState<Scalar>& slope) const {
        std::array<ArmState<Scalar>, 6> k;
        k[0] = slope;
        const auto moved = [&]<std::size_t row>() {
            ArmState<Scalar> to;
            std::array<double, row + 1> weights{1};
            for (std::size_t j = 0; j < row; ++j) weights[j + 1] = h * fifth_order[row][j];
            for (std::size_t q = 0; q < 4; ++q) {
                std::array<const Scalar*, row + 1> parts{&y[q]};
                for (std::size_t j = 0; j < row; ++j) parts[j + 1] = &k[j][q];
                to[q] = weighed(weights, parts);
            }
            return to;
        };
        [&]<std::size_t... i>(std::index_sequence<i...>) {
            ((k[i + 1] = arms_.rate(moved.template operator()<i + 1>())), ...);
        }
        (std::make_index_sequence<5>());
        y = moved.template operator()<6>();
        slope = arms_.rate(y);
    }

    bool go_on() {
        after_ = before_;
        slope_after_ = slope_before_;
        take_step(step_, after_, slope_after_);
        event_.reset();
        constexpr double fastest = 1e4;  // rad/s
        const auto is_slow = [](const Scalar& rate) { return std::abs(value_of(rate)) < fastest; };
        const bool is_finite = is_slow(after_[2]) && is_slow(after_[3]);
        if (is_finite && law_.has_coulomb)
            for (std::size_t joint = 0; joint < 2; ++joint) find_event(joint);
        return is_finite;
    }

    /// An event of this joint before those already found: at the end, or where its rate is nearest to rest before.
    void find_event(std::size_t joint) {
        const auto margin = [&](double t) {
            const double first = rate_in_step(0, t), second = joint == 1 ? rate_in_step(1, t) : 0;
            if (!law_.is_held(joint)) return law_.margin(joint, {0, 0, first, second});
            return law_.margin(joint, values_at(begin() + t));
        };
        double last = event_ ? event_->after : step_;
        if (!(margin(last) < 0)) {
            const auto acceleration = [&](const ArmState<Scalar>& slope) {
                return law_.modes[joint] * (value_of(slope[joint + 2]) - (joint == 0 ? 0 : value_of(slope[2])));
            };
            const double slope = acceleration(slope_before_), slope_then = acceleration(slope_after_);
            if (!(slope < 0 && slope_then > 0)) return;
            last = std::min(last, step_ * slope / (slope - slope_then));
            if (!(margin(last) < 0)) return;
        }
        event_ = {bisect_event(0.0, last, step_, margin), joint};
    }

    /// Goes to the event and on by the law that holds from there. False where they are too many to end.
    bool pass_event() {
        constexpr double at_once = 100, a_step = 4;  // events
        const auto [after, joint] = *event_;
        take_step(after, before_, slope_before_);
        origin_ = begin() + after;
        done_ = 0;
        const bool was_held = law_.is_held(joint);
        law_.settle(joint, values(before_));
        arms_.modes = law_.modes;
        if (!was_held) shift_tangents(joint, arms_.rate(before_));
        if (law_.is_held(0)) before_[2] = Scalar(0);
        if (law_.is_held(1)) before_[3] = before_[2];
        slope_before_ = arms_.rate(before_);
        ++events_;
        return events_ < at_once + a_step * origin_ / step_;
    }
    void shift_tangents(std::size_t joint, const ArmState<Scalar>& slope) {
        if constexpr (requires(Scalar y) { y.tangent; }) {
            auto rate = before_[joint + 2], acceleration = slope_before_[joint + 2];
            if (joint == 1) rate -= before_[2], acceleration -= slope_before_[2];
            if (acceleration.value == 0) return;
            for (std::size_t q = 2; q < 4; ++q)
                before_[q].tangent -= ((slope_before_[q].value - slope[q].value) / acceleration.value) * rate.tangent;
        }
    }

    Arms<Scalar> arms_;
    Arms<double> law_;          // the same without derivatives
    double step_, origin_ = 0;  // s, of the last event or the start
    long done_ = 0;             // steps since
    double events_ = 0;
    std::optional<Event> event_;  // that cuts the last step
    ArmState<Scalar> before_, slope_before_, after_, slope_after_;
};

/// How many directions there are for a start and few parameters or none, and for all.
constexpr int few_directions = 8, all_directions = 4 + static_cast<int>(dynamic_count);
extern template class Flow<double>;
extern template class Flow<Dual<double, few_directions>>;
extern template class Flow<Dual<double, all_directions>>;

/// With derivatives by the start (directions 0 to 3) and by the first N − 4 fitted parameters that move the arms (from 4 on).
template <int N>
Flow<Dual<double, N>> varied_flow(const ModelSpec& model, const Parameters& parameters, const ArmState<double>& start,
                                  double step) {
    using enum FitParameter;
    using Number = Dual<double, N>;
    auto arms = arms_of(model, parameters).template cast<Number>();
    const auto of = [&](FitParameter parameter) -> Number& { return arms.p[index_of(parameter)]; };
    for (std::size_t k = 0; k + 4 < N && k < model.fitted.size() && is_dynamic(model.fitted[k]); ++k)
        of(model.fitted[k]).tangent[4 + static_cast<Eigen::Index>(k)] = 1;
    if (model.point_masses) of(gravity_1) = of(inertia) * of(gravity_2) / of(coupling);
    ArmState<Number> from;
    for (std::size_t q = 0; q < 4; ++q) from[q] = Number::variable(start[q], static_cast<Eigen::Index>(q));
    return {arms, from, step};
}

/// What the encoder of an arm shows at the time t of the first; nothing where the motion left what is finite.
inline std::optional<double> shown_angle(const Parameters& p, Flow<double>& flow, std::size_t arm, double t) {
    using enum FitParameter;
    const double at = t + (arm == 1 ? p[index_of(lag)] : 0);
    if (!flow.reach(at)) return std::nullopt;
    return p[index_of(offset_1) + arm] + p[index_of(scale_1) + arm] * flow.angle(arm, at);
}

}  // namespace doppel
