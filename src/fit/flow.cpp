#include "fit/flow.hpp"

#include "integrate/dormand_prince.hpp"
#include "integrate/events.hpp"

#include <cmath>

namespace doppel {
namespace {

/// The angle at t seconds into a step of h: the polynomial of degree 5 through angle, rate and acceleration at both
/// ends (error h⁶ θ⁽⁶⁾/46080). Weights of these six, in that order.
std::array<double, 6> angle_weights(double t, double h) {
    const double s = t / h, s2 = s * s, s3 = s2 * s, s4 = s3 * s, s5 = s4 * s;
    return {1 - 10 * s3 + 15 * s4 - 6 * s5,
            h * (s - 6 * s3 + 8 * s4 - 3 * s5),
            h * h * (0.5 * s2 - 1.5 * s3 + 1.5 * s4 - 0.5 * s5),
            10 * s3 - 15 * s4 + 6 * s5,
            h * (-4 * s3 + 7 * s4 - 3 * s5),
            h * h * (0.5 * s3 - s4 + 0.5 * s5)};
}
/// Those of its rate.
std::array<double, 6> rate_weights(double t, double h) {
    const double s = t / h, s2 = s * s, s3 = s2 * s, s4 = s3 * s;
    return {(-30 * s2 + 60 * s3 - 30 * s4) / h, 1 - 18 * s2 + 32 * s3 - 15 * s4, h * (s - 4.5 * s2 + 6 * s3 - 2.5 * s4),
            (30 * s2 - 60 * s3 + 30 * s4) / h,  -12 * s2 + 28 * s3 - 15 * s4,    h * (1.5 * s2 - 4 * s3 + 2.5 * s4)};
}

}  // namespace

template <int N>
Flow<N>::Flow(const ModelSpec& model, const Parameters& parameters, const ArmState& start, double step)
    : arms_(arms_of<Scalar>(model, parameters)),
      values_(arms_of<double>(model, parameters)),
      step_(step),
      before_(State::Zero()) {
    before_.row(0) = start;
    if constexpr (N > 0) before_.template block<4, 4>(1, 0).setIdentity();
    arms_.modes = values_.modes = turning(start);
    slope_before_ = slope_of(before_);
    go_on();
}

template <int N>
bool Flow<N>::reach(double t) {
    while (t > begin() + (event_ ? event_->after : step_)) {
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

template <int N>
typename Flow<N>::Column Flow<N>::angle(std::size_t arm, double t) const {
    return weighted(angle_weights(t - begin(), step_), arm);
}

template <int N>
double Flow<N>::rate(std::size_t arm, double t) const {
    return weighted(rate_weights(t - begin(), step_), arm)[0];
}

template <int N>
typename Flow<N>::State Flow<N>::slope_of(const State& y) const {
    const auto number = [&](Eigen::Index q) -> Scalar {
        if constexpr (N == 0)
            return y(0, q);
        else
            return {y(0, q), y.col(q).template tail<N>()};
    };
    State slope;
    slope.template leftCols<2>() = y.template rightCols<2>();
    const auto alpha = arms_.accelerations(arms_.sides(number(0), number(1), number(2), number(3)));
    for (std::size_t arm = 0; arm < 2; ++arm)
        if constexpr (N == 0)
            slope(0, arm + 2) = alpha[arm];
        else
            slope.col(arm + 2) << alpha[arm].value, alpha[arm].tangent;
    return slope;
}

template <int N>
void Flow<N>::take_step(double h, State& y, State& slope) const {
    constexpr std::size_t stages = Dopri5::pair.stages;
    std::array<State, stages> k;
    const State from = y;
    for (std::size_t i = 1; i <= stages; ++i) {
        k[i - 1] = slope;
        y = from;
        for (std::size_t j = 0; j < i; ++j) y += (h * value<double>(Dopri5::pair.a[i][j])) * k[j];
        slope = slope_of(y);
    }
}

template <int N>
bool Flow<N>::go_on() {
    after_ = before_;
    slope_after_ = slope_before_;
    take_step(step_, after_, slope_after_);
    event_.reset();
    constexpr double fastest = 1e4;  // rad/s
    const bool is_finite = std::abs(after_(0, 2)) < fastest && std::abs(after_(0, 3)) < fastest;
    if (is_finite && arms_.has_coulomb)
        for (std::size_t joint = 0; joint < 2; ++joint) find_event(joint);
    return is_finite;
}

template <int N>
void Flow<N>::find_event(std::size_t joint) {
    const auto margin_at = [&](double t) {
        const double at = begin() + t;
        return margin(values_, joint,
                      values_.is_held(joint) ? values_at(at) : ArmState(0, 0, rate(0, at), rate(1, at)));
    };
    double last = event_ ? event_->after : step_;
    if (!(margin_at(last) < 0)) {
        const double slope = values_.modes[joint] * relative(slope_before_, joint)[0];
        const double slope_then = values_.modes[joint] * relative(slope_after_, joint)[0];
        if (!(slope < 0 && slope_then > 0)) return;
        last = std::min(last, step_ * slope / (slope - slope_then));
        if (!(margin_at(last) < 0)) return;
    }
    event_ = {bisect_event(0.0, last, step_, margin_at), joint};
}

template <int N>
bool Flow<N>::pass_event() {
    constexpr double at_once = 100, a_step = 4;  // events
    const auto [after, joint] = *event_;
    take_step(after, before_, slope_before_);
    origin_ = begin() + after;
    done_ = 0;
    const bool was_held = values_.is_held(joint);
    arms_.modes = values_.modes = settled(values_, joint, before_.row(0));
    const Column rate = relative(before_, joint), acceleration = relative(slope_before_, joint);
    if (N > 0 && !was_held && acceleration[0] != 0)
        before_.template bottomRows<N>() -=
            rate.template tail<N>() * ((slope_before_ - slope_of(before_)).row(0) / acceleration[0]);
    if (arms_.is_held(0)) before_.col(2).setZero();
    if (arms_.is_held(1)) before_.col(3) = before_.col(2);
    slope_before_ = slope_of(before_);
    ++events_;
    return events_ < at_once + a_step * origin_ / step_;
}

template class Flow<0>;
template class Flow<start_directions>;
template class Flow<all_directions>;

}  // namespace doppel
