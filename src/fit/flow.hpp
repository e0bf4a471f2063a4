#pragma once

#include "fit/pendulum.hpp"

#include <optional>

namespace doppel {

/// How many directions there are for a start alone, and with all that moves the links; no others are compiled.
constexpr int start_directions = 4, all_directions = 4 + static_cast<int>(dynamic_count);

/// The motion from one start, step after step, to be asked for angles at ascending times: Dormand and Prince's method of order
/// 5 at fixed steps, so that derivatives are those of what is computed. N derivatives are carried along: those by the start
/// (0 to 3), or by the fitted parameters that move the links, too (4 + their number).
///
/// With Coulomb friction each step keeps to one law and counts as far as that holds, until a joint comes to rest or is let
/// go. Then the slope f jumps, and with it how the state changes with what fixes the time t* of the event:
///     ∂y after = ∂y before + (f before − f after) ∂t*,   ∂t* = −∂ω/ω′ of the joint's rate ω
template <int N = start_directions>
class Flow {
public:
    Flow(const ModelSpec& model, const Parameters& parameters, const ArmState& start, double step);

    /// Steps on until `t` (s from the start) is in the last step. False where the motion left what is finite.
    bool reach(double t);

    // For a time in the last step, or a little outside:

    using Column = Eigen::Matrix<double, 1 + N, 1>;  // a number and its derivatives
    Column angle(std::size_t arm, double t) const;
    double rate(std::size_t arm, double t) const;
    ArmState values_at(double t) const { return {angle(0, t)[0], angle(1, t)[0], rate(0, t), rate(1, t)}; }

private:
    using State = Eigen::Matrix<double, 1 + N, 4>;  // the state in the first row, its derivatives below
    struct Moment {
        State y, slope;
    };

    /// The joint's own rate of a state, or its acceleration of a slope.
    static Column relative(const State& y, std::size_t joint) {
        return joint == 0 ? Column(y.col(2)) : Column(y.col(3) - y.col(2));
    }
    double begin() const { return origin_ + static_cast<double>(done_) * step_; }
    /// The sum, by these weights, of a link's angle, rate and acceleration where the step begins, and where it ends.
    auto weighted(const std::array<double, 6>& w, std::size_t arm) const {
        return w[0] * before_.y.col(arm) + w[1] * before_.y.col(arm + 2) + w[2] * before_.slope.col(arm + 2) +
               w[3] * after_.y.col(arm) + w[4] * after_.y.col(arm + 2) + w[5] * after_.slope.col(arm + 2);
    }
    State slope_of(const State& y) const;
    Moment later(const Moment& from, double h) const;
    bool go_on();
    /// An event of this joint before those already found: at the end, or where its rate is nearest to rest before.
    void find_event(std::size_t joint);
    /// Goes to the event and on by the law that holds from there. False where they are too many to end.
    bool pass_event();

    Arms<Dual<double, N>> arms_;
    Arms<double> values_;               // theirs alone
    double step_, origin_ = 0;          // s, of the last event or the start
    long done_ = 0;                     // steps since
    double events_ = 0;                 // so far
    double length_ = 0;                 // s, of the last step, which an event may cut
    std::optional<std::size_t> joint_;  // that of the event
    Moment before_, after_;
};

}  // namespace doppel
