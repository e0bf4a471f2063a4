#include "fit/flow.hpp"

#include "integrate/dormand_prince.hpp"
#include "integrate/events.hpp"

#include <cmath>

namespace doppel {
namespace {

/// Weights of angle, rate and acceleration at both ends, in that order, for the angle at t seconds in a step of h. This
/// is the polynomial of degree 5 through all six (error h⁶ θ⁽⁶⁾/46080).
std::array<double, 6> angle_weights(double t, double h) {
    const double s = t / h, s2 = s * s, s3 = s2 * s, s4 = s3 * s, s5 = s4 * s;
    return {1 - 10 * s3 + 15 * s4 - 6 * s5,
            h * (s - 6 * s3 + 8 * s4 - 3 * s5),
            h * h * (0.5 * s2 - 1.5 * s3 + 1.5 * s4 - 0.5 * s5),
            10 * s3 - 15 * s4 + 6 * s5,
            h * (-4 * s3 + 7 * s4 - 3 * s5),
            h * h * (0.5 * s3 - s4 + 0.5 * s5)};
}
/// The same for the rate.
std::array<double, 6> rate_weights(double t, double h) {
    const double s = t / h, s2 = s * s, s3 = s2 * s, s4 = s3 * s;
    return {(-30 * s2 + 60 * s3 - 30 * s4) / h, 1 - 18 * s2 + 32 * s3 - 15 * s4, h * (s - 4.5 * s2 + 6 * s3 - 2.5 * s4),
            (30 * s2 - 60 * s3 + 30 * s4) / h,  -12 * s2 + 28 * s3 - 15 * s4,    h * (1.5 * s2 - 4 * s3 + 2.5 * s4)};
}

}  // namespace

template <int N>
Flow<N>::Flow(const ModelSpec& model, const Parameters& parameters, const LinkState& start, double step)
    : links_(link_pair_of<Dual<double, N>>(model, parameters)),
      values_(link_pair_of<double>(model, parameters)),
      step_(step) {
    before_.y.setZero();
    before_.y.row(0) = start;
    before_.y.template block<4, 4>(1, 0).setIdentity();
    links_.modes = values_.modes = turning(start);
    before_.slope = slope_of(before_.y);
    take_step();
}

template <int N>
bool Flow<N>::reach(double t) {
    while (t > begin() + length_) {
        if (joint_) {
            if (!pass_event()) return false;
        } else {
            before_ = after_;
            ++done_;
        }
        if (!take_step()) return false;
    }
    return true;
}

template <int N>
typename Flow<N>::Column Flow<N>::angle(std::size_t link, double t) const {
    return weighted(angle_weights(t - begin(), step_), link);
}

template <int N>
double Flow<N>::rate(std::size_t link, double t) const {
    return weighted(rate_weights(t - begin(), step_), link)[0];
}

template <int N>
typename Flow<N>::State Flow<N>::slope_of(const State& y) const {
    const auto number = [&](Eigen::Index q) { return Dual<double, N>(y(0, q), y.col(q).template tail<N>()); };
    State slope;
    slope.template leftCols<2>() = y.template rightCols<2>();
    const auto alpha = links_.accelerations(links_.sides(number(0), number(1), number(2), number(3)));
    for (std::size_t link = 0; link < 2; ++link) slope.col(link + 2) << alpha[link].value, alpha[link].tangent;
    return slope;
}

/// The slope is the first stage of the next step.
template <int N>
typename Flow<N>::Moment Flow<N>::advanced(const Moment& from, double h) const {
    constexpr std::size_t stages = Dopri5::pair.stages;
    std::array<State, stages> k;
    Moment to = from;
    for (std::size_t i = 1; i <= stages; ++i) {
        k[i - 1] = to.slope;
        to.y = from.y;
        for (std::size_t j = 0; j < i; ++j) to.y += (h * value<double>(Dopri5::pair.a[i][j])) * k[j];
        to.slope = slope_of(to.y);
    }
    return to;
}

template <int N>
bool Flow<N>::take_step() {
    after_ = advanced(before_, step_);
    length_ = step_;
    joint_.reset();
    constexpr double fastest = 1e4;  // rad/s
    const bool is_finite = std::abs(after_.y(0, 2)) < fastest && std::abs(after_.y(0, 3)) < fastest;
    if (is_finite && links_.has_coulomb)
        for (std::size_t joint = 0; joint < 2; ++joint) find_event(joint);
    return is_finite;
}

template <int N>
void Flow<N>::find_event(std::size_t joint) {
    const auto margin_at = [&](double t) {
        const double at = begin() + t;
        return margin(values_, joint,
                      values_.is_held(joint) ? values_at(at) : LinkState(0, 0, rate(0, at), rate(1, at)));
    };
    double last = length_;
    if (!(margin_at(last) < 0)) {
        const double slope = values_.modes[joint] * relative(before_.slope, joint)[0];
        const double slope_then = values_.modes[joint] * relative(after_.slope, joint)[0];
        if (!(slope < 0 && slope_then > 0)) return;
        last = std::min(last, step_ * slope / (slope - slope_then));
        if (!(margin_at(last) < 0)) return;
    }
    length_ = bisect_event(0.0, last, step_, margin_at);
    joint_ = joint;
}

template <int N>
bool Flow<N>::pass_event() {
    constexpr double at_once = 100, a_step = 4;  // limits of events: at one time; per step
    origin_ = begin() + length_;
    done_ = 0;
    auto& [y, slope] = before_ = advanced(before_, length_);
    const bool was_held = values_.is_held(*joint_);
    y(0, 2 + *joint_) =
        *joint_ == 0 ? 0 : y(0, 2);  // rounded to the limit; a value below 0 would be an event again, without end
    if (values_.is_held(1)) y(0, 3) = y(0, 2);
    links_.modes = values_.modes = modes_after_event(values_, *joint_, y.row(0));
    const Column rate = relative(y, *joint_), acceleration = relative(slope, *joint_);
    if (!was_held && acceleration[0] != 0)
        y.template bottomRows<N>() -= rate.template tail<N>() * ((slope - slope_of(y)).row(0) / acceleration[0]);
    if (links_.is_held(0)) y.col(2).setZero();
    if (links_.is_held(1)) y.col(3) = y.col(2);
    slope = slope_of(y);
    ++events_;
    return events_ < at_once + a_step * origin_ / step_;
}

template class Flow<start_directions>;
template class Flow<all_directions>;

}  // namespace doppel
