#pragma once

#include "fit/pendulum.hpp"

#include <optional>

namespace doppel {

/// Numbers of derivatives: by the start alone, and also by all parameters that affect the motion; only these are
/// compiled.
constexpr int start_directions = 4, all_directions = 4 + static_cast<int>(dynamic_count);

/// The motion from one start, computed step by step, for angles at ascending times. The method is Dormand & Prince's of
/// order 5 at fixed steps, so that derivatives are those of the computed motion. It carries N derivatives: by the start
/// (0 to 3), or also by the fitted parameters that affect the motion (4 + their number).
///
/// With Coulomb friction each step uses one law of friction and ends where that law ends, when a joint stops or starts.
/// There the slope f jumps, and so do the derivatives of the state, by the derivative of the time t* of the event:
///     ∂y after = ∂y before + (f before − f after) ∂t*,   ∂t* = −∂ω/ω′ with the rate ω of the joint
template <int N = start_directions>
class Flow {
public:
    Flow(const ModelSpec& model, const Parameters& parameters, const LinkState& start, double step);

    /// Steps until `t` (s from the start) is in the last step. Returns false if the motion did not stay finite.
    bool reach(double t);

    // For a time in the last step, or slightly outside:

    using Column = Eigen::Matrix<double, 1 + N, 1>;  // a number and its derivatives
    Column angle(std::size_t link, double t) const;
    double rate(std::size_t link, double t) const;
    LinkState values_at(double t) const { return {angle(0, t)[0], angle(1, t)[0], rate(0, t), rate(1, t)}; }

private:
    using State = Eigen::Matrix<double, 1 + N, 4>;  // the state in the first row, its derivatives below
    struct Moment {
        State y, slope;
    };

    /// The joint's rate for a state, or its acceleration for a slope.
    static Column relative(const State& y, std::size_t joint) {
        return joint == 0 ? Column(y.col(2)) : Column(y.col(3) - y.col(2));
    }
    double begin() const { return origin_ + static_cast<double>(done_) * step_; }
    /// The weighted sum of a link's angle, rate and acceleration at both ends of the step.
    auto weighted(const std::array<double, 6>& w, std::size_t link) const {
        return w[0] * before_.y.col(link) + w[1] * before_.y.col(link + 2) + w[2] * before_.slope.col(link + 2) +
               w[3] * after_.y.col(link) + w[4] * after_.y.col(link + 2) + w[5] * after_.slope.col(link + 2);
    }
    State slope_of(const State& y) const;
    Moment advanced(const Moment& from, double h) const;
    bool take_step();
    /// Finds an event of this joint before those found: at the end, or before where its rate is closest to zero.
    void find_event(std::size_t joint);
    /// Moves to the event, and continues with the law that applies after it. Returns false if there are too many
    /// events.
    bool pass_event();

    LinkPair<Dual<double, N>> links_;
    LinkPair<double> values_;           // values without derivatives
    double step_, origin_ = 0;          // s, time of the last event, or of the start
    long done_ = 0;                     // steps since then
    double events_ = 0;                 // number of events
    double length_ = 0;                 // s, of the last step, which may end at an event
    std::optional<std::size_t> joint_;  // joint of the event
    Moment before_, after_;
};

}  // namespace doppel
