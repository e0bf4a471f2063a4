#pragma once

#include "integrate/runge_kutta.hpp"
#include "integrate/stepper.hpp"
#include "numeric/lanes.hpp"
#include "physics/angle_chain.hpp"
#include "physics/rod_chain.hpp"
#include "physics/rod_multipliers.hpp"

#include <algorithm>
#include <optional>
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

/// Two or three particles on rods, in terms of the rods r_k = q_k − q_{k−1} and u_k = h r_k′. In each step u_k changes
/// by h² times the accelerations of its ends by the rods (physics/rod_multipliers.hpp), and r_k by u_k. Where a mass is
/// below a thousandth of the next, these almost cancel: the model's own rate is used.
template <class Scalar, int N>
class IncrementalEuler<RodChain<Scalar, N>> {
public:
    using Model = RodChain<Scalar, N>;
    using State = typename Model::State;

    IncrementalEuler(const Model& model, const State& start, const Scalar& step)
        : start_(start), h_(step), by_(model.w, model.g) {
        by_.gravity *= step * step;
        if constexpr (N == 3) scale3_ = by_.rho2;
        for (Eigen::Index k = 0; k < N; ++k) {
            now_.r[k] = relative(start, k, 0);
            now_.u[k] = relative(start, k, 2 * N);
            now_.u[k].x *= step;
            now_.u[k].y *= step;
        }
        if constexpr (N == 3) {
            now_.r[2] = now_.r[2] * (Scalar(1) / scale3_);
            now_.u[2] = now_.u[2] * (Scalar(1) / scale3_);
        }
        State dydt = start;
        Model(model).rate(start, dydt);
        for (const Scalar& rate : dydt) rests_ = rests_ & (rate <= Scalar(0)) & (Scalar(0) <= rate);
        for (Eigen::Index k = 0; k + 1 < N; ++k) is_even_ = is_even_ & (model.w[k] <= model.w[k + 1] * Scalar(1000));
        if (!all_of(is_even_)) plain_.emplace(Plain{model, start, start});
    }

    DOPPEL_COMPONENTS_APART void advance(long steps) { run(steps); }
    void advance(long steps) requires is_lanes<Scalar> { run(steps); }

    State state() const {
        if (taken_ == 0) return start_;
        State y(4 * N);
        Pair q{Scalar(0), Scalar(0)}, v = q;
        for (Eigen::Index k = 0; k < N; ++k) {
            q = q + (k == 2 ? now_.r[k] * scale3_ : now_.r[k]);
            v = v + (k == 2 ? now_.u[k] * scale3_ : now_.u[k]);
            y[2 * k] = q.x;
            y[2 * k + 1] = q.y;
            y[2 * N + 2 * k] = v.x / h_;
            y[2 * N + 2 * k + 1] = v.y / h_;
        }
        for (Eigen::Index i = 0; plain_ && i < y.size(); ++i) y[i] = select(is_even_, y[i], plain_->y[i]);
        for (Eigen::Index i = 0; i < y.size(); ++i) y[i] = select(rests_, start_[i], y[i]);
        return y;
    }
    long evaluations() const { return taken_; }

private:
    struct Plain {
        Model model;
        State y, dydt;
    };
    using Condition = decltype(Scalar() <= Scalar());

    [[gnu::always_inline]] void run(long steps) {
        Now now = now_;  // a local copy, which the compiler keeps in registers
        const Multipliers by = by_;
        for (long i = 0; i < steps; ++i) step(now, by);
        now_ = now;
        taken_ += steps;
        for (long i = 0; plain_ && i < steps; ++i) {
            plain_->model.rate(plain_->y, plain_->dydt);
            plain_->y += plain_->dydt * h_;
        }
    }

    using Pair = Planar<Scalar>;
    using Multipliers = RodMultipliers<Scalar>;
    struct Now {
        Pair r[N], u[N];
    };
    static Pair relative(const State& y, Eigen::Index k, Eigen::Index first) {
        const Eigen::Index at = first + 2 * k;
        if (k == 0) return {y[at], y[at + 1]};
        return {y[at] - y[at - 2], y[at + 1] - y[at - 1]};
    }

    [[gnu::always_inline]] static void step(Now& now, const Multipliers& by) {
        Pair p[N];
        by.find(now.r, now.u, p);
        for (int k = 0; k < N; ++k) now.r[k] = now.r[k] + now.u[k];
        now.u[0] = {now.u[0].x + (p[0].x - p[1].x), now.u[0].y + ((p[0].y - p[1].y) - by.gravity)};
        if constexpr (N == 2) {
            now.u[1] = now.u[1] + (p[1] * by.kappa2 - p[0]);
        } else {
            now.u[1] = now.u[1] + (p[1] * by.kappa2 - (p[0] + p[2]));
            now.u[2] = now.u[2] + (p[2] * by.kappa3 - p[1]);
        }
    }

    State start_;
    Scalar h_;          // s
    Multipliers by_;    // gravity: h² g
    Scalar scale3_{1};  // ρ_2 (physics/rod_multipliers.hpp)
    Now now_;
    /// A system in equilibrium for the model remains there exactly; the reordered sums would make it move by rounding.
    Condition rests_ = Scalar(0) <= Scalar(0), is_even_ = rests_;
    std::optional<Plain> plain_;
    long taken_ = 0;  // steps
};

/// Euler 1768: positions advance with the old velocities, velocities with the old forces.
struct Euler {
    static constexpr Method method{"euler", "explicit Euler", 1, false, "explicit"};
    static constexpr Tableau<1> table{.a = {}, .b = {{{1, 1}}}};
    template <System Model>
    using Stepper = std::conditional_t<has_incremental_euler<Model>, IncrementalEuler<Model>, RungeKutta<Model, table>>;
};

/// Euler's method with the new velocities (symplectic Euler), at fixed step, for any system with state (q, v):
///     v ← v + h a(q, v),   q ← q + h v
/// Source  Hairer, Lubich & Wanner, Geometric Numerical Integration, §I.1.2 and theorem VI.3.3.
template <System Model>
class SemiImplicitEulerStepper : public FixedSteps<SemiImplicitEulerStepper<Model>, Model> {
public:
    using Base = FixedSteps<SemiImplicitEulerStepper, Model>;
    using typename Base::Scalar, typename Base::State;

    SemiImplicitEulerStepper(Model& model, const State& start, const Scalar& step)
        : Base(model, start, step), dydt_(start) {}

private:
    friend Base;
    static constexpr long stages = 1;

    void step(Model& model, State& y, const Scalar& h) {
        const auto n = y.size() / 2;
        model.rate(y, dydt_);
        for (Eigen::Index j = n; j < 2 * n; ++j) y[j] += h * dydt_[j];
        for (Eigen::Index j = 0; j < n; ++j) y[j] += h * y[n + j];
        project(model, y);
    }

    State dydt_;
};

struct SemiImplicitEuler {
    static constexpr Method method{"semi-implicit-euler", "semi-implicit Euler", 1, false,
                                   "explicit; symplectic where forces depend on positions alone"};
    template <System Model>
    using Stepper = SemiImplicitEulerStepper<Model>;
};

}  // namespace doppel
