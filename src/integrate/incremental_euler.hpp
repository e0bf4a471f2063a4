#pragma once

#include "integrate/stepper.hpp"
#include "numeric/lanes.hpp"
#include "physics/angle_chain.hpp"
#include "physics/rod_chain.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>

namespace doppel {

/// Explicit Euler for models whose right-hand side can be updated from the previous step's, instead of being computed
/// again. It has the same interface (integrate/stepper.hpp) as RungeKutta<Model, Euler::table>, different rounding, and
/// is several times faster. For double and lanes. Common to all models:
///
///     rates are stored as the change per step, h y′, so that positions advance by an addition;
///     each step has one division, and sums are ordered so that the latest operand is added last.
///
/// The result does not depend on how advance() calls divide the steps, to the last bit.
template <class Model>
class IncrementalEuler;

/// Whether there is one for this model.
template <class Model>
inline constexpr bool has_incremental_euler = false;
template <class Scalar>
inline constexpr bool has_incremental_euler<DoublePendulum<Scalar>> = is_machine_number<Scalar>;
template <class Scalar, int N>
inline constexpr bool has_incremental_euler<RodChain<Scalar, N>> = is_machine_number<Scalar> && (N == 2 || N == 3);

/// For the double pendulum, sine and cosine of θ1 and D = θ2 − θ1 are enough. With the rod tensions T1, T2
/// (physics/angle_chain.hpp) eliminated, L = l2/l1, q = ω1² + (g/l1) cosθ1, S = sinD / L and C = cosD / L:
///     θ1″ = (ω2² + q C) f − (g/l1) sinθ1
///     θ2″ = −(q lever + ω2² C) f,      f = S / (ratio + S²),   ratio = (m1/m2) / L²,   lever = (1 + m1/m2) / L²
template <class Scalar>
class IncrementalEuler<DoublePendulum<Scalar>> {
public:
    using Model = DoublePendulum<Scalar>;
    using State = typename Model::State;

    IncrementalEuler(const Model& model, const State& start, const Scalar& step) : start_(start), h_(step) {
        using std::abs, std::sqrt;
        const Scalar longer = model.l2 / model.l1, masses = model.m1 / model.m2, square = longer * longer;
        inverse_longer_ = Scalar(1) / longer;
        gravity_ = step * step * model.g / model.l1;
        by_ = {masses / square, (Scalar(1) + masses) / square};
        now_.theta1 = start[0];
        now_.theta2 = start[1];
        now_.dtheta1 = step * start[2];
        now_.dtheta2 = step * start[3];
        update(now_);

        // As long as δ1 and δD are within the largest turn, (h ω2)² ≤ 4 largest² and f ≤ L / (2 √(m1/m2)). So in one
        // step neither grows by more than
        const Scalar largest = largest_turn * largest_turn, q = largest + abs(gravity_);
        const Scalar growth =
            (Scalar(4) * largest + q * inverse_longer_ + q * by_.lever + Scalar(4) * largest * inverse_longer_) *
                longer / sqrt(masses) +
            abs(gravity_);
        slow_ = Scalar(largest_turn) - Scalar(double(block)) * growth;
    }

    DOPPEL_COMPONENTS_APART void advance(long steps) { run(steps); }
    void advance(long steps) requires is_lanes<Scalar> { run(steps); }

    State state() const {
        return taken_ == 0 ? start_ : State(now_.theta1, now_.theta2, now_.dtheta1 / h_, now_.dtheta2 / h_);
    }
    long evaluations() const { return taken_; }

private:
    using Turning = TurningAngle<Scalar>;
    static constexpr long refreshed_every = 256;  // steps; each rotation has an error of some 1e-16, and errors add up
    static constexpr long block = 16;             // steps between two checks of the rotation rates

    [[gnu::always_inline]] void run(long steps) {
        using std::abs;
        Now now = now_;  // a local copy, which the compiler keeps in registers
        const Constants by = by_;
        while (steps > 0) {
            const long some = std::min({steps, block, refreshed_every - taken_ % refreshed_every});
            if (all_of((abs(now.dtheta1) <= slow_) & (abs(now.dtheta2 - now.dtheta1) <= slow_))) [[likely]] {
                for (long i = 0; i < some; ++i) step(now, by);
            } else {
                now_ = now;
                for (long i = 0; i < some; ++i) step_fast();
                now = now_;
            }
            taken_ += some;
            steps -= some;
            if (taken_ % refreshed_every == 0) {
                now_ = now;
                update(now_);
                now = now_;
            }
        }
        now_ = now;
    }

    struct Constants {
        Scalar ratio, lever;  // as above
    };
    struct Now {
        Scalar theta1, theta2;
        Scalar dtheta1, dtheta2;  // h ω
        Turning one, two;         // of θ1, times h² g/l1; of D, times 1/L
    };

    [[gnu::noinline]] void update(Now& now) const {
        const SinCos<Scalar> one(now.theta1), two(now.theta2 - now.theta1);
        now.one = {one.sin * gravity_, one.cos * gravity_};
        now.two = {two.sin * inverse_longer_, two.cos * inverse_longer_};
    }

    [[gnu::always_inline]] static void step(Now& now, const Constants& by) {
        const Scalar d1 = now.dtheta1, d = now.dtheta2 - now.dtheta1;
        const Scalar square1 = d1 * d1, square2 = now.dtheta2 * now.dtheta2;
        const auto [sin, cos] = now.two;

        // h² times the accelerations
        const Scalar f = sin / (by.ratio + sin * sin);
        const Scalar q = square1 + now.one.cos;
        const Scalar a1 = (square2 + q * cos) * f;
        const Scalar a2 = (q * by.lever + square2 * cos) * f;

        now.theta1 += now.dtheta1;
        now.theta2 += now.dtheta2;
        now.dtheta1 = (now.dtheta1 - now.one.sin) + a1;
        now.dtheta2 -= a2;
        now.one.turn(d1, square1);
        now.two.turn(d, d * d);
    }

    /// A step that computes sine and cosine directly in the lanes that rotate too fast for the series.
    [[gnu::noinline]] void step_fast() {
        using std::abs;
        const Scalar d1 = now_.dtheta1, d = now_.dtheta2 - now_.dtheta1;
        const auto slow1 = abs(d1) <= Scalar(largest_turn), slow = abs(d) <= Scalar(largest_turn);
        Now turned = now_;
        step(turned, by_);
        now_ = turned;
        if (all_of(slow1 & slow)) return;
        update(now_);
        now_.one = {select(slow1, turned.one.sin, now_.one.sin), select(slow1, turned.one.cos, now_.one.cos)};
        now_.two = {select(slow, turned.two.sin, now_.two.sin), select(slow, turned.two.cos, now_.two.cos)};
    }

    State start_;
    Scalar h_;                         // s
    Scalar gravity_, inverse_longer_;  // h² g/l1, 1/L
    Scalar slow_;  // limit of h ω1, h (ω2 − ω1) for which rotations in the next block suit the series
    Constants by_;
    Now now_;
    long taken_ = 0;  // steps
};

}  // namespace doppel
