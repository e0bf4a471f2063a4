#pragma once

#include "integrate/method.hpp"
#include "integrate/tableau.hpp"

#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace doppel {

/// An explicit Runge–Kutta method with `table`, at fixed step: any system, any scalar (integrate/method.hpp).
template <System Model, const auto& table>
class RungeKutta {
public:
    using Scalar = typename Model::Scalar;
    using State = typename Model::State;

    RungeKutta(Model& model, const State& start, const Scalar& step) : model_(model), y_(start), h_(step), sum_(start) {
        slopes_.fill(start);
        at_ = start;
    }

    void advance(long steps) {
        if constexpr (flattened)
            repeat_flattened(steps);
        else
            repeat(steps);
        evaluations_ += steps * static_cast<long>(stages);
    }

    const State& state() const { return y_; }
    long evaluations() const { return evaluations_; }

private:
    static constexpr std::size_t stages = table.b.size();

    void repeat(long steps) {
        for (long i = 0; i < steps; ++i) step(y_);
    }

    /// Short states of doubles: whether the compiler inlines a right-hand side of its own accord depends on what else is
    /// in the file. Others gain nothing by it. With sanitizers, two test files took more than six minutes each.
#ifdef __SANITIZE_ADDRESS__
    static constexpr bool flattened = false;
#else
    static constexpr bool flattened = std::is_same_v<Scalar, double> && State::RowsAtCompileTime != Eigen::Dynamic;
#endif

    [[gnu::flatten]] void repeat_flattened(long steps) {
        repeat(steps);
    }

    void step(State& y) {
        // slopes k_i = f(y + h Σ_{j<i} a_ij k_j)
        const auto slope = [&]<std::size_t i>() {
            if constexpr (i == 0) {
                model_.rate(y, slopes_[0]);
            } else {
                static constexpr auto row = table.a[i];
                at_ = y;
                move<row>(at_, std::make_index_sequence<i>());
                model_.rate(at_, slopes_[i]);
            }
        };
        [&]<std::size_t... I>(std::index_sequence<I...>) {
            (slope.template operator()<I>(), ...);
        }
        (std::make_index_sequence<stages>());

        // y + h Σ b_i k_i
        static constexpr auto b = table.b;
        move<b>(y, std::make_index_sequence<stages>());
        project(model_, y);
    }

    /// y ← y + h Σ_j weight_j k_j over the weights that are not zero; which those are is known to the compiler.
    template <const auto& weights, std::size_t... J>
    void move(State& y, std::index_sequence<J...>) {
        sum_.fill(Scalar(-0.0));  // unlike +0, it changes no sum and costs no addition
        [[maybe_unused]] const auto add = [&]<std::size_t j>() {
            constexpr Fraction w = weights[j];
            if constexpr (w.numerator != 0) sum_ += (Scalar(w.numerator) / Scalar(w.denominator)) * slopes_[j];
        };
        (add.template operator()<J>(), ...);
        y += h_ * sum_;
    }

    Model& model_;
    State y_;
    Scalar h_;
    long evaluations_ = 0;
    std::array<State, stages> slopes_;
    State at_, sum_;
};

/// Runge 1895; Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, eq. II.1.4.
struct Midpoint {
    static constexpr Method method{"midpoint", "explicit midpoint", 2, false, "explicit"};
    static constexpr Tableau<2> table{.a = {{{}, {{{1, 2}}}}}, .b = {{{0, 1}, {1, 1}}}};
    template <System Model>
    using Stepper = RungeKutta<Model, table>;
};

/// Kutta 1901; Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, table II.1.2.
struct Rk4 {
    static constexpr Method method{"rk4", "Runge–Kutta 4", 4, false, "explicit"};
    static constexpr Tableau<4> table{.a = {{{}, {{{1, 2}}}, {{{0, 1}, {1, 2}}}, {{{0, 1}, {0, 1}, {1, 1}}}}},
                                      .b = {{{1, 6}, {1, 3}, {1, 3}, {1, 6}}}};
    template <System Model>
    using Stepper = RungeKutta<Model, table>;
};

}  // namespace doppel
