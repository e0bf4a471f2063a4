#pragma once

#include "integrate/method.hpp"
#include "numeric/lanes.hpp"
#include "physics/double_pendulum.hpp"
#include "physics/rod_chain.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>

namespace doppel {

/// Explicit Euler for models whose next right-hand side can be had from this one, in place of from nothing: the same
/// method and the same rules (integrate/method.hpp) as RungeKutta<Model, Euler::table>, rounded differently, some times
/// faster. For double and lanes. What all have in common:
///
///     rates are kept as the way of one step, h y′, so that positions advance by a bare addition;
///     each step has one division, and its sums are ordered so that what comes last waits least.
///
/// However advance() is chopped, no bit of the result changes.
template <class Model>
class CarriedEuler;

/// Put before the loops of a lone pendulum: paired in vectors, its components wait for each other's shuffles.
#if defined(__GNUC__) && !defined(__clang__)
#define DOPPEL_COMPONENTS_APART [[gnu::optimize("no-tree-slp-vectorize")]]
#else
#define DOPPEL_COMPONENTS_APART
#endif

/// For which models there is one.
template <class Model>
inline constexpr bool has_carried_euler = false;
template <class Scalar>
inline constexpr bool is_machine_number = std::is_same_v<Scalar, double> || is_lanes<Scalar>;
template <class Scalar>
inline constexpr bool has_carried_euler<DoublePendulum<Scalar>> = is_machine_number<Scalar>;
template <class Scalar, int N>
inline constexpr bool has_carried_euler<RodChain<Scalar, N>> = is_machine_number<Scalar> && (N == 2 || N == 3);

/// Sine and cosine, times one factor, of an angle that advances by small steps. They turn with it,
///     sin(θ+δ) = sinθ + cosθ sinδ − sinθ (1 − cosδ),   cos(θ+δ) = cosθ − sinθ sinδ − cosθ (1 − cosδ),
/// by the series of sinδ and cosδ, which for |δ| ≤ 2⁻⁸ leave less than 2⁻⁵⁷ out; larger steps take them afresh.
template <class Scalar>
struct TurningAngle {
    Scalar sin, cos;

    void look(const Scalar& factor, const Scalar& angle) {
        if constexpr (is_lanes<Scalar>) {
            for (int lane = 0; lane < Scalar::width; ++lane) {
                const SinCos<double> turn(angle[lane]);  // both in one call
                sin.set(lane, turn.sin);
                cos.set(lane, turn.cos);
            }
        } else {
            const SinCos<Scalar> turn(angle);
            sin = turn.sin;
            cos = turn.cos;
        }
        sin *= factor;
        cos *= factor;
    }

    /// Turns by d, where square = d².
    [[gnu::always_inline]] void turn(const Scalar& d, const Scalar& square) {
        const Scalar third = (d * square) * (square * Scalar(1.0 / 120) - Scalar(1.0 / 6));  // sinδ − δ
        const Scalar second = square * (square * Scalar(1.0 / 24) - Scalar(0.5));            // cosδ − 1
        const Scalar s = sin, c = cos;
        sin = (s + c * d) + (c * third + s * second);
        cos = (c - s * d) + (c * second - s * third);
    }
};

/// The double pendulum needs sine and cosine of θ1 and of D = θ2 − θ1 alone. With the tensions of the rods T1, T2
/// (physics/angle_chain.hpp), the masses' ratio m1/m2 = ratio and q = ω1² + (g/l1) cosθ1:
///     θ1″ = (ω2² l2/l1 + q cosD) f − (g/l1) sinθ1
///     θ2″ = −((1 + ratio) q l1/l2 + ω2² cosD) f,      f = sinD / (ratio + sin²D)
template <class Scalar>
class CarriedEuler<DoublePendulum<Scalar>> {
public:
    using Model = DoublePendulum<Scalar>;
    using State = typename Model::State;

    CarriedEuler(const Model& model, const State& start, const Scalar& step) : start_(start), h_(step) {
        by_ = {model.m1 / model.m2, step * step * model.g / model.l1, model.l2 / model.l1,
               (Scalar(1) + model.m1 / model.m2) * model.l1 / model.l2};
        now_.theta1 = start[0];
        now_.theta2 = start[1];
        now_.way1 = step * start[2];
        now_.way2 = step * start[3];
        look(now_);
    }

    DOPPEL_COMPONENTS_APART void advance(long steps) { run(steps); }
    void advance(long steps) requires is_lanes<Scalar> { run(steps); }

    State state() const {
        return taken_ == 0 ? start_ : State(now_.theta1, now_.theta2, now_.way1 / h_, now_.way2 / h_);
    }
    long evaluations() const { return taken_; }

private:
    [[gnu::always_inline]] void run(long steps) {
        while (steps > 0) {
            const long some = std::min(steps, looks_every - taken_ % looks_every);
            Now now = now_;  // here, so that the compiler keeps it in registers
            const Constants by = by_;
            for (long i = 0; i < some; ++i) step(now, by);
            taken_ += some;
            steps -= some;
            if (taken_ % looks_every == 0) look(now);
            now_ = now;
        }
    }

    static constexpr long looks_every = 256;  // steps; turning errs by some 1e-16 each, and errors add up

    struct Constants {
        Scalar ratio;    // m1/m2
        Scalar gravity;  // h² g/l1
        Scalar longer;   // l2/l1
        Scalar lever;    // (1 + m1/m2) l1/l2
    };
    struct Now {
        Scalar theta1, theta2;
        Scalar way1, way2;              // h ω
        TurningAngle<Scalar> one, two;  // of θ1, times h² g/l1; of D
    };

    void look(Now& now) const {
        now.one.look(by_.gravity, now.theta1);
        now.two.look(Scalar(1), now.theta2 - now.theta1);
    }

    [[gnu::always_inline]] static void step(Now& now, const Constants& by) {
        const Scalar d1 = now.way1, d = now.way2 - now.way1;
        const Scalar square1 = d1 * d1, square2 = now.way2 * now.way2, square = d * d;
        const auto [sin, cos] = now.two;

        // h² times the accelerations
        const Scalar f = sin / (by.ratio + sin * sin);
        const Scalar q = square1 + now.one.cos;
        const Scalar a1 = (square2 * by.longer + q * cos) * f - now.one.sin;
        const Scalar a2 = (q * by.lever + square2 * cos) * f;

        now.theta1 += now.way1;
        now.theta2 += now.way2;
        now.way1 += a1;
        now.way2 -= a2;
        now.one.turn(d1, square1);
        now.two.turn(d, square);
        const Scalar largest(1.0 / (256 * 256));
        const auto slow = (square1 <= largest) & (square <= largest);  // false where it is no number
        if (!all_of(slow)) [[unlikely]] {
            Now copy = now;  // so that `now` itself may stay in registers
            look_where_fast(copy, by, square1 <= largest, square <= largest);
            now = copy;
        }
    }

    /// Takes afresh, in the lanes that turn too fast, what turning would get wrong.
    template <class Mask>
    [[gnu::noinline]] static void look_where_fast(Now& now, const Constants& by, const Mask& slow1, const Mask& slow2) {
        TurningAngle<Scalar> one, two;
        one.look(by.gravity, now.theta1);
        two.look(Scalar(1), now.theta2 - now.theta1);
        now.one = {select(slow1, now.one.sin, one.sin), select(slow1, now.one.cos, one.cos)};
        now.two = {select(slow2, now.two.sin, two.sin), select(slow2, now.two.cos, two.cos)};
    }

    State start_;
    Scalar h_;  // s
    Constants by_;
    Now now_;
    long taken_ = 0;  // steps
};

/// Two or three particles on rods, in the rods r_k = q_k − q_{k−1} and the ways u_k = h r_k′. With α_k = |r_k|²,
/// β_k = r_k·r_{k+1}, ρ_k = m_1/m_k and the unknowns x_k = h² λ_k ρ_{k−1} / m_1 (ρ_0 = 1), the rows of the system for λ
/// (physics/rod_chain.hpp), divided by ρ_{k−1}, are those of a symmetric matrix with 1 before each β,
///     | α1      −β1            |                     κ_2 = 1 + ρ_2
///     | −β1   κ_2 α2    −β2    | x = s,              κ_3 = (ρ_2 + ρ_3) / ρ_2²
///     |         −β2    κ_3 α3  |                     s = (h² g r_1y − |u_1|², −|u_2|², −|u_3|² / ρ_2),
/// solved by its adjugate. Then u_k grows by the pull p_k = r_k x_k of each rod on the masses at its ends, and r_k by
/// u_k.
template <class Scalar, int N>
class CarriedEuler<RodChain<Scalar, N>> {
public:
    using Model = RodChain<Scalar, N>;
    using State = typename Model::State;

    CarriedEuler(const Model& model, const State& start, const Scalar& step) : start_(start), h_(step) {
        by_.gravity = step * step * model.g;
        by_.rho2 = model.w[1] / model.w[0];
        by_.kappa2 = Scalar(1) + by_.rho2;
        if constexpr (N == 3) {
            const Scalar rho3 = model.w[2] / model.w[0];
            by_.kappa3 = (by_.rho2 + rho3) / (by_.rho2 * by_.rho2);
            by_.inverse2 = Scalar(1) / by_.rho2;
            by_.ratio3 = rho3 / by_.rho2;
        }
        for (Eigen::Index k = 0; k < N; ++k) {
            now_.r[k] = relative(start, k, 0);
            now_.u[k] = relative(start, k, 2 * N);
            now_.u[k].x *= step;
            now_.u[k].y *= step;
        }
        mark_resting(model);
    }

    DOPPEL_COMPONENTS_APART void advance(long steps) { run(steps); }
    void advance(long steps) requires is_lanes<Scalar> { run(steps); }

    State state() const {
        if (taken_ == 0) return start_;
        State y;
        Pair q{Scalar(0), Scalar(0)}, v = q;
        for (Eigen::Index k = 0; k < N; ++k) {
            q = {q.x + now_.r[k].x, q.y + now_.r[k].y};
            v = {v.x + now_.u[k].x, v.y + now_.u[k].y};
            y[2 * k] = q.x;
            y[2 * k + 1] = q.y;
            y[2 * N + 2 * k] = v.x / h_;
            y[2 * N + 2 * k + 1] = v.y / h_;
        }
        for (int lane = 0; lane < width; ++lane)
            if (rests_[static_cast<std::size_t>(lane)]) copy_lane(lane, start_, y);
        return y;
    }
    long evaluations() const { return taken_; }

private:
    [[gnu::always_inline]] void run(long steps) {
        Now now = now_;  // here, so that the compiler keeps it in registers
        const Constants by = by_;
        for (long i = 0; i < steps; ++i) {
            if constexpr (N == 2)
                step_two(now, by);
            else
                step_three(now, by);
        }
        now_ = now;
        taken_ += steps;
    }

    struct Pair {
        Scalar x, y;

        [[gnu::always_inline]] friend Scalar dot(const Pair& a, const Pair& b) { return a.x * b.x + a.y * b.y; }
        [[gnu::always_inline]] friend Pair operator*(const Pair& a, const Scalar& b) { return {a.x * b, a.y * b}; }
        [[gnu::always_inline]] friend Pair operator+(const Pair& a, const Pair& b) { return {a.x + b.x, a.y + b.y}; }
        [[gnu::always_inline]] friend Pair operator-(const Pair& a, const Pair& b) { return {a.x - b.x, a.y - b.y}; }
    };
    struct Now {
        Pair r[N], u[N];
    };
    struct Constants {
        Scalar gravity;                   // h² g
        Scalar rho2, kappa2;              // as above
        Scalar kappa3, inverse2, ratio3;  // κ_3, 1/ρ_2, ρ_3/ρ_2
    };

    static constexpr int width = [] {
        if constexpr (is_lanes<Scalar>)
            return Scalar::width;
        else
            return 1;
    }();

    static void copy_lane(int lane, const State& from, State& to) {
        for (Eigen::Index i = 0; i < to.size(); ++i)
            if constexpr (is_lanes<Scalar>)
                to[i].set(lane, from[i][lane]);
            else
                to[i] = from[i];
    }

    /// What the model finds in equilibrium stays there exactly: sums that are ordered for speed would let it tremble.
    void mark_resting(Model model) {
        State dydt = start_;
        model.rate(start_, dydt);
        for (int lane = 0; lane < width; ++lane) {
            bool rests = true;
            for (Eigen::Index i = 0; i < dydt.size(); ++i)
                if constexpr (is_lanes<Scalar>)
                    rests = rests && dydt[i][lane] == 0;
                else
                    rests = rests && dydt[i] == 0;
            rests_[static_cast<std::size_t>(lane)] = rests;
        }
    }

    static Pair relative(const State& y, Eigen::Index k, Eigen::Index first) {
        const Eigen::Index at = first + 2 * k;
        if (k == 0) return {y[at], y[at + 1]};
        return {y[at] - y[at - 2], y[at + 1] - y[at - 1]};
    }

    [[gnu::always_inline]] static void step_two(Now& now, const Constants& by) {
        const Pair r1 = now.r[0], r2 = now.r[1], u1 = now.u[0], u2 = now.u[1];
        const Scalar a1 = dot(r1, r1), b1 = dot(r1, r2), a2 = dot(r2, r2) * by.kappa2;
        const Scalar inverse = Scalar(1) / (a1 * a2 - b1 * b1);
        const Scalar s1 = (by.gravity * r1.y - u1.x * u1.x) - u1.y * u1.y, s2 = dot(u2, u2);  // −s_2
        const Pair p1 = (r1 * inverse) * (a2 * s1 - b1 * s2), p2 = (r2 * inverse) * (b1 * s1 - a1 * s2);
        const Pair on1 = p1 - p2;
        now.r[0] = r1 + u1;
        now.r[1] = r2 + u2;
        now.u[0] = {u1.x + on1.x, u1.y + (on1.y - by.gravity)};
        now.u[1] = u2 + (p2 * by.rho2 - on1);
    }

    [[gnu::always_inline]] static void step_three(Now& now, const Constants& by) {
        const Pair r1 = now.r[0], r2 = now.r[1], r3 = now.r[2], u1 = now.u[0], u2 = now.u[1], u3 = now.u[2];
        const Scalar a1 = dot(r1, r1), a2 = dot(r2, r2) * by.kappa2, a3 = dot(r3, r3) * by.kappa3;
        const Scalar b1 = dot(r1, r2), b2 = dot(r2, r3);
        const Scalar m23 = a2 * a3 - b2 * b2, square1 = b1 * b1, m12 = a1 * a2 - square1;
        const Scalar inverse = Scalar(1) / (a1 * m23 - square1 * a3);
        const Scalar s1 = (by.gravity * r1.y - u1.x * u1.x) - u1.y * u1.y;
        const Scalar s2 = dot(u2, u2), s3 = dot(u3, u3) * by.inverse2;  // −s_2, −s_3
        const Scalar below = a3 * s2 + b2 * s3;
        const Scalar x1 = m23 * s1 - b1 * below;
        const Scalar x2 = (a3 * b1) * s1 - a1 * below;
        const Scalar x3 = (b1 * b2) * s1 - ((a1 * b2) * s2 + m12 * s3);
        const Pair p1 = (r1 * inverse) * x1;
        const Pair p2 = (r2 * inverse) * x2;
        const Pair p3 = (r3 * inverse) * x3;
        const Pair on1 = p1 - p2, on2 = p2 * by.rho2 - p3;
        now.r[0] = r1 + u1;
        now.r[1] = r2 + u2;
        now.r[2] = r3 + u3;
        now.u[0] = {u1.x + on1.x, u1.y + (on1.y - by.gravity)};
        now.u[1] = u2 + (on2 - on1);
        now.u[2] = u3 + (p3 * by.ratio3 - on2);
    }

    State start_;
    Scalar h_;  // s
    Constants by_{};
    Now now_;
    std::array<bool, width> rests_{};
    long taken_ = 0;  // steps
};

#undef DOPPEL_COMPONENTS_APART

}  // namespace doppel
