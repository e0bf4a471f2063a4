#pragma once

#include "integrate/incremental_euler_rods.hpp"
#include "integrate/runge_kutta.hpp"

#include <type_traits>

namespace doppel {

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
class SemiImplicitEulerStepper {
public:
    using Scalar = typename Model::Scalar;
    using State = typename Model::State;

    SemiImplicitEulerStepper(Model& model, const State& start, const Scalar& step)
        : model_(model), y_(start), dydt_(start), h_(step) {
        take_modes(model_, y_);
    }

    void advance(long steps) {
        if constexpr (is_flattened<Model>)
            repeat_flattened(steps);
        else
            repeat(steps);
    }

    const State& state() const { return y_; }
    long evaluations() const { return evaluations_; }

private:
    [[gnu::flatten]] void repeat_flattened(long steps) { repeat(steps); }
    void repeat(long steps) {
        for (long i = 0; i < steps; ++i) {
            if constexpr (HasEvents<Model>)
                if (model_.switches()) {
                    step_through_events(model_, y_, h_, [&](State& y, const Scalar& h) { step(y, h); });
                    continue;
                }
            step(y_, h_);
        }
    }
    void step(State& y, const Scalar& h) {
        const auto n = y.size() / 2;
        model_.rate(y, dydt_);
        for (Eigen::Index j = n; j < 2 * n; ++j) y[j] += h * dydt_[j];
        for (Eigen::Index j = 0; j < n; ++j) y[j] += h * y[n + j];
        project(model_, y);
        ++evaluations_;
    }

    Model& model_;
    State y_, dydt_;
    Scalar h_;
    long evaluations_ = 0;
};

struct SemiImplicitEuler {
    static constexpr Method method{"semi-implicit-euler", "semi-implicit Euler", 1, false,
                                   "explicit; symplectic where forces depend on positions alone"};
    template <System Model>
    using Stepper = SemiImplicitEulerStepper<Model>;
};

}  // namespace doppel
