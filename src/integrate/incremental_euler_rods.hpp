#pragma once

#include "integrate/incremental_euler.hpp"
#include "physics/rod_chain.hpp"
#include "physics/rod_multipliers.hpp"

#include <array>
#include <cstddef>

namespace doppel {

/// Two or three particles on rods, in terms of the rods r_k = q_k − q_{k−1} and u_k = h r_k′. In each step u_k changes
/// by h² times the accelerations of its ends by the rods (physics/rod_multipliers.hpp), and r_k by u_k.
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
        for (Eigen::Index i = 0; i < y.size(); ++i) y[i] = select(rests_, start_[i], y[i]);
        return y;
    }
    long evaluations() const { return taken_; }

private:
    [[gnu::always_inline]] void run(long steps) {
        Now now = now_;  // a local copy, which the compiler keeps in registers
        const Multipliers by = by_;
        for (long i = 0; i < steps; ++i) step(now, by);
        now_ = now;
        taken_ += steps;
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
    decltype(Scalar() <= Scalar()) rests_ = Scalar(0) <= Scalar(0);
    long taken_ = 0;  // steps
};

}  // namespace doppel
