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

/// Sine and cosine, times one factor, of an angle that advances by small steps. They turn with it by three shears,
///     u = cosθ − t sinθ,   sin(θ+δ) = sinθ + sinδ u,   cos(θ+δ) = u − t sin(θ+δ),   t = tan(δ/2),
/// with the series of sinδ and t, which for |δ| ≤ largest leave less than 2⁻⁵⁶ out.
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

    static constexpr double largest = 1.0 / 1024;

    /// Turns by d, where square = d².
    [[gnu::always_inline]] void turn(const Scalar& d, const Scalar& square) {
        const Scalar t = d * (Scalar(0.5) + square * Scalar(1.0 / 24));
        const Scalar u = cos - t * sin;
        sin += (d * (Scalar(1) - square * Scalar(1.0 / 6))) * u;
        cos = u - t * sin;
    }
};

/// The double pendulum needs sine and cosine of θ1 and of D = θ2 − θ1 alone. With the tensions of the rods T1, T2
/// (physics/angle_chain.hpp), L = l2/l1, q = ω1² + (g/l1) cosθ1 and sine and cosine of D as S = sinD / L, C = cosD / L:
///     θ1″ = (ω2² + q C) f − (g/l1) sinθ1
///     θ2″ = −(q lever + ω2² C) f,      f = S / (ratio + S²),   ratio = (m1/m2) / L²,   lever = (1 + m1/m2) / L²
template <class Scalar>
class CarriedEuler<DoublePendulum<Scalar>> {
public:
    using Model = DoublePendulum<Scalar>;
    using State = typename Model::State;

    CarriedEuler(const Model& model, const State& start, const Scalar& step) : start_(start), h_(step) {
        using std::abs, std::sqrt;
        const Scalar longer = model.l2 / model.l1, masses = model.m1 / model.m2, square = longer * longer;
        inverse_longer_ = Scalar(1) / longer;
        gravity_ = step * step * model.g / model.l1;
        by_ = {masses / square, (Scalar(1) + masses) / square};
        now_.theta1 = start[0];
        now_.theta2 = start[1];
        now_.way1 = step * start[2];
        now_.way2 = step * start[3];
        look(now_);

        // While δ1 and δD stay within the largest turn, (h ω2)² ≤ 4 largest² and f ≤ L / (2 √(m1/m2)); so in one step
        // neither grows by more than
        const Scalar largest = Turning::largest * Turning::largest, q = largest + abs(gravity_);
        const Scalar growth =
            (Scalar(4) * largest + q * inverse_longer_ + q * by_.lever + Scalar(4) * largest * inverse_longer_) *
                longer / sqrt(masses) +
            abs(gravity_);
        slow_ = Scalar(Turning::largest) - Scalar(double(block)) * growth;
    }

    DOPPEL_COMPONENTS_APART void advance(long steps) { run(steps); }
    void advance(long steps) requires is_lanes<Scalar> { run(steps); }

    State state() const {
        return taken_ == 0 ? start_ : State(now_.theta1, now_.theta2, now_.way1 / h_, now_.way2 / h_);
    }
    long evaluations() const { return taken_; }

private:
    using Turning = TurningAngle<Scalar>;
    static constexpr long looks_every = 256;  // steps; turning errs by some 1e-16 each, and errors add up
    static constexpr long block = 16;         // steps between two looks at how fast all turns

    [[gnu::always_inline]] void run(long steps) {
        using std::abs;
        Now now = now_;  // here, so that the compiler keeps it in registers
        const Constants by = by_;
        while (steps > 0) {
            const long some = std::min({steps, block, looks_every - taken_ % looks_every});
            if (all_of((abs(now.way1) <= slow_) & (abs(now.way2 - now.way1) <= slow_))) [[likely]] {
                for (long i = 0; i < some; ++i) step(now, by);
            } else {
                now_ = now;
                for (long i = 0; i < some; ++i) step_fast();
                now = now_;
            }
            taken_ += some;
            steps -= some;
            if (taken_ % looks_every == 0) {
                now_ = now;
                look(now_);
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
        Scalar way1, way2;  // h ω
        Turning one, two;   // of θ1, times h² g/l1; of D, times 1/L
    };

    [[gnu::noinline]] void look(Now& now) const {
        now.one.look(gravity_, now.theta1);
        now.two.look(inverse_longer_, now.theta2 - now.theta1);
    }

    [[gnu::always_inline]] static void step(Now& now, const Constants& by) {
        const Scalar d1 = now.way1, d = now.way2 - now.way1;
        const Scalar square1 = d1 * d1, square2 = now.way2 * now.way2;
        const auto [sin, cos] = now.two;

        // h² times the accelerations
        const Scalar f = sin / (by.ratio + sin * sin);
        const Scalar q = square1 + now.one.cos;
        const Scalar a1 = (square2 + q * cos) * f;
        const Scalar a2 = (q * by.lever + square2 * cos) * f;

        now.theta1 += now.way1;
        now.theta2 += now.way2;
        now.way1 = (now.way1 - now.one.sin) + a1;
        now.way2 -= a2;
        now.one.turn(d1, square1);
        now.two.turn(d, d * d);
    }

    /// A step that takes afresh, in the lanes that turn too fast, what turning would get wrong.
    [[gnu::noinline]] void step_fast() {
        using std::abs;
        const Scalar d1 = now_.way1, d = now_.way2 - now_.way1;
        const auto slow1 = abs(d1) <= Scalar(Turning::largest), slow = abs(d) <= Scalar(Turning::largest);
        Now turned = now_;
        step(turned, by_);
        now_ = turned;
        if (all_of(slow1 & slow)) return;
        look(now_);
        now_.one = {select(slow1, turned.one.sin, now_.one.sin), select(slow1, turned.one.cos, now_.one.cos)};
        now_.two = {select(slow, turned.two.sin, now_.two.sin), select(slow, turned.two.cos, now_.two.cos)};
    }

    State start_;
    Scalar h_;                         // s
    Scalar gravity_, inverse_longer_;  // h² g/l1, 1/L
    Scalar slow_;  // h ω1 and h (ω2 − ω1) up to which no turn of the next block is too large for the series
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
        const Scalar rho2 = model.w[1] / model.w[0];
        by_.kappa2 = Scalar(1) + rho2;
        if constexpr (N == 3) {
            by_.kappa3 = (rho2 + model.w[2] / model.w[0]) / (rho2 * rho2);
            scale3_ = rho2;
        }
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
        mark_resting(model);
    }

    DOPPEL_COMPONENTS_APART void advance(long steps) { run(steps); }
    void advance(long steps) requires is_lanes<Scalar> { run(steps); }

    State state() const {
        if (taken_ == 0) return start_;
        State y;
        Pair q{Scalar(0), Scalar(0)}, v = q;
        for (Eigen::Index k = 0; k < N; ++k) {
            q = q + (k == 2 ? now_.r[k] * scale3_ : now_.r[k]);
            v = v + (k == 2 ? now_.u[k] * scale3_ : now_.u[k]);
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
        Scalar gravity;         // h² g
        Scalar kappa2, kappa3;  // as above
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
        now.r[0] = r1 + u1;
        now.r[1] = r2 + u2;
        now.u[0] = {u1.x + (p1.x - p2.x), u1.y + ((p1.y - p2.y) - by.gravity)};
        now.u[1] = u2 + (p2 * by.kappa2 - p1);
    }

    [[gnu::always_inline]] static void step_three(Now& now, const Constants& by) {
        const Pair r1 = now.r[0], r2 = now.r[1], r3 = now.r[2], u1 = now.u[0], u2 = now.u[1], u3 = now.u[2];
        const Scalar a1 = dot(r1, r1), a2 = dot(r2, r2) * by.kappa2, a3 = dot(r3, r3) * by.kappa3;
        const Scalar b1 = dot(r1, r2), b2 = dot(r2, r3);
        const Scalar m23 = a2 * a3 - b2 * b2, square1 = b1 * b1, m12 = a1 * a2 - square1;
        const Scalar inverse = Scalar(1) / (a1 * m23 - square1 * a3);
        const Scalar s1 = (by.gravity * r1.y - u1.x * u1.x) - u1.y * u1.y;
        const Scalar s2 = dot(u2, u2), s3 = dot(u3, u3);  // −s_2, −s_3
        const Scalar below = a3 * s2 + b2 * s3, above = b1 * s1;
        const Pair p1 = (r1 * inverse) * (m23 * s1 - b1 * below);
        const Pair p2 = (r2 * inverse) * (a3 * above - a1 * below);
        const Pair p3 = (r3 * inverse) * (b2 * (above - a1 * s2) - m12 * s3);
        now.r[0] = r1 + u1;
        now.r[1] = r2 + u2;
        now.r[2] = r3 + u3;
        now.u[0] = {u1.x + (p1.x - p2.x), u1.y + ((p1.y - p2.y) - by.gravity)};
        now.u[1] = u2 + (p2 * by.kappa2 - (p1 + p3));
        now.u[2] = u3 + (p3 * by.kappa3 - p2);
    }

    State start_;
    Scalar h_;          // s
    Scalar scale3_{1};  // ρ_2
    Constants by_{};
    Now now_;
    std::array<bool, width> rests_{};
    long taken_ = 0;  // steps
};

#undef DOPPEL_COMPONENTS_APART

}  // namespace doppel
