#pragma once

#include "integrate/incremental_euler.hpp"
#include "physics/rod_chain.hpp"

#include <array>
#include <cstddef>

namespace doppel {

/// Two or three particles on rods, in the rods r_k = q_k − q_{k−1} and u_k = h r_k′. With α_k = |r_k|²,
/// β_k = r_k·r_{k+1}, ρ_k = m_1/m_k and the unknowns x_k = h² λ_k ρ_{k−1} / m_1 (ρ_0 = 1), the rows of the system for λ
/// (physics/rod_chain.hpp), divided by ρ_{k−1}, are those of a symmetric matrix with 1 before each β,
///     | α1      −β1            |                     κ_2 = 1 + ρ_2
///     | −β1   κ_2 α2    −β2    | x = s,              κ_3 = (ρ_2 + ρ_3) / ρ_2²
///     |         −β2    κ_3 α3  |                     s = (h² g r_1y − |u_1|², −|u_2|², −|u_3|² / ρ_2),
/// solved by its adjugate. Then u_k grows by the pull p_k = r_k x_k of each rod on the masses at its ends, and r_k by
/// u_k.
template <class Scalar, int N>
class IncrementalEuler<RodChain<Scalar, N>> {
public:
    using Model = RodChain<Scalar, N>;
    using State = typename Model::State;

    IncrementalEuler(const Model& model, const State& start, const Scalar& step) : start_(start), h_(step) {
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

}  // namespace doppel
