#pragma once

#include "integrate/methods.hpp"
#include "integrate/stepper.hpp"
#include "numeric/lanes.hpp"

#include <array>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace doppel {

/// A decimal constant with 32 digits: the sum of two doubles that do not overlap. For published coefficients that are
/// used in both quad and double.
struct Decimal {
    double high = 0, low = 0;

    constexpr Decimal operator-() const { return {-high, -low}; }
};

namespace literals {

/// For example 0.0526001519587677318785587544488016_d; digits and one point, at most 36 of them.
consteval Decimal operator""_d(const char* text) {
    __extension__ using Whole = unsigned __int128;  // 38 digits

    Whole digits = 0, scale = 1;
    bool point = false;
    for (; *text != '\0'; ++text) {
        if (*text == '.') {
            point = true;
            continue;
        }
        if (*text < '0' || *text > '9' || digits > Whole(-1) / 20 || scale > Whole(-1) / 40)
            throw std::invalid_argument("a _d literal is made of no more than 36 digits and a point");
        digits = 10 * digits + static_cast<Whole>(*text - '0');
        if (point) scale *= 10;
    }
    if (digits == 0) return {};

    // the leading power of two of the quotient, then its bits by long division
    double bit = 1;
    while (digits / 2 >= scale) scale *= 2, bit *= 2;
    while (digits < scale) digits *= 2, bit /= 2;
    Decimal value;
    for (int i = 0; i < 106; ++i) {
        if (digits >= scale) {
            digits -= scale;
            (i < 53 ? value.high : value.low) += bit;
        }
        digits *= 2;
        bit /= 2;
    }
    return value;
}

}  // namespace literals

/// A fraction as published, exact in every scalar.
struct Fraction {
    long numerator = 0, denominator = 1;
};

/// An explicit Runge–Kutta method of S stages (Butcher tableau; the systems here are autonomous, so c is omitted).
///     k_i = f(y + h Σ_{j<i} a_ij k_j),   y ← y + h Σ b_i k_i
template <std::size_t S>
struct Tableau {
    std::array<std::array<Fraction, S>, S> a;
    std::array<Fraction, S> b;
};

/// How an adaptive method chooses the next step from the error ε of the last one, relative to the tolerance:
///     h ← h · safety · ε^(−exponent) · (ε of the previous step)^memory,   the factor being between `shrink` and `grow`
/// Source  Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, eq. IV.2.43 (PI control).
struct StepControl {
    double exponent, memory, safety, shrink, grow;
};

/// An explicit Runge–Kutta method of S stages with error estimate and interpolation, for autonomous systems:
///     k_i = f(y + h Σ_{j<i} a_ij k_j)
///     rows up to S − 1   the stages
///     row S              the weights of the step: k_S is the slope at its end, and k_0 of the next step
///     further rows       slopes for interpolation only
/// The error is h Σ error_i k_i. With two estimates e1 (low order) and e2 (lower), it is e1² / √(e1² + 0.01 e2²).
///
/// With s = t/h and s̄ = 1 − s the state inside the step is
///     y0 + s (Δ + s̄ (h k_0 − Δ + s (2 Δ − h k_0 − h k_S + s̄ (d_0 + s (d_1 + s̄ (d_2 + s d_3)))))),
/// where Δ = y1 − y0 and d_m = h Σ dense_mi k_i; the sum ends with the last row of `dense`.
template <class Coefficient, std::size_t S, std::size_t slopes, std::size_t estimates, std::size_t rows>
struct EmbeddedPair {
    static constexpr std::size_t stages = S;

    std::array<std::array<Coefficient, slopes>, slopes> a;
    std::array<std::array<Coefficient, S + 1>, estimates> error;
    std::array<std::array<Coefficient, slopes>, rows> dense;
    StepControl control;
};

template <class Scalar>
Scalar value(const Fraction& f) {
    return Scalar(f.numerator) / Scalar(f.denominator);
}
template <class Scalar>
Scalar value(const Decimal& d) {
    return Scalar(d.high) + Scalar(d.low);
}
constexpr bool is_zero(const Fraction& f) {
    return f.numerator == 0;
}
constexpr bool is_zero(const Decimal& d) {
    return d.high == 0;
}

/// A model with a fixed number of angles, whose rates at the stages of a step can use sines and cosines of its start.
template <class Model>
concept HasStageAngles =
    is_machine_number<typename Model::Scalar> && Model::State::RowsAtCompileTime != Eigen::Dynamic&& requires {
    typename Model::Angles;
};
template <class Model>
struct StageAnglesOf {};
template <HasStageAngles Model>
struct StageAnglesOf<Model> : Model::Angles {};

/// The slopes k_i of one step of `pair`: any system, any scalar; no allocation after construction.
template <System Model, const auto& pair>
class Slopes {
public:
    using Scalar = typename Model::Scalar;
    using State = typename Model::State;

    static constexpr std::size_t stages = pair.stages, all = pair.a.size();

    explicit Slopes(const State& start) : at_(start) { k_.fill(start); }

    State& operator[](std::size_t i) { return k_[i]; }

    /// Evaluates k_first … k_{last−1} from the slopes before them.
    template <std::size_t first, std::size_t last>
    void evaluate(Model& model, const State& y, const Scalar& h) {
        const auto slope = [&]<std::size_t i>() {
            static constexpr auto row = pair.a[i];
            sum<row>(at_);
            at_ = y + h * at_;
            model.rate(at_, k_[i]);
        };
        [&]<std::size_t... i>(std::index_sequence<i...>) {
            (slope.template operator()<first + i>(), ...);
        }
        (std::make_index_sequence<last - first>());
    }

    /// Evaluates the slopes for interpolation from all others.
    void evaluate_dense(Model& model, const State& y, const Scalar& h) {
        for (std::size_t i = stages + 1; i < all; ++i) {
            sum_with(pair.a[i], at_);
            at_ = y + h * at_;
            model.rate(at_, k_[i]);
        }
    }

    /// y1 ← y + h Σ b_j k_j, after the stages are evaluated.
    void finish(const State& y, const Scalar& h, State& y1) {
        static constexpr auto b = pair.a[stages];
        sum<b>(at_);
        y1 = y + h * at_;
    }

    /// out ← Σ weight_j k_j over the nonzero weights, which are known at compile time.
    template <const auto& weights>
    void sum(State& out) const {
        [&]<std::size_t... j>(std::index_sequence<j...>) {
            for (Eigen::Index i = 0; i < out.size(); ++i) {
                Scalar total(-0.0);  // unlike +0, −0 changes no sum, so that the addition can be removed
                const auto add = [&]<std::size_t slope>() {
                    if constexpr (!is_zero(weights[slope])) total += value<Scalar>(weights[slope]) * k_[slope][i];
                };
                (add.template operator()<j>(), ...);
                out[i] = total;
            }
        }
        (std::make_index_sequence<weights.size()>());
    }

    /// The same as a loop at run time, which compiles faster, for work that is not done in every step.
    template <class Weights>
    void sum_with(const Weights& weights, State& out) const {
        out.fill(Scalar(-0.0));
        for (std::size_t j = 0; j < weights.size(); ++j)
            if (!is_zero(weights[j])) out += value<Scalar>(weights[j]) * k_[j];
    }

private:
    std::array<State, all> k_;
    State at_;
};

/// A chain of rigid bodies.
template <class Model>
concept OfBodies = requires(const Model& model) {
    model.pendulum.friction;
};

/// Short states of doubles, of up to two bodies, for which inlining is forced: otherwise the compiler's choice depends on
/// the rest of the file. Other states gain nothing from it. Not with sanitizers, where two test files took more than six
/// minutes each.
#ifdef __SANITIZE_ADDRESS__
template <class Model>
inline constexpr bool is_flattened = false;
#else
template <class Model, int size = Model::State::RowsAtCompileTime>
inline constexpr bool is_flattened = is_machine_number<typename Model::Scalar>&& size != Eigen::Dynamic&& size <= 8;
#endif

/// A method at fixed step (integrate/stepper.hpp), `Method`, which has step(model, y, h) and a number of stages.
template <class Method, System Model>
class FixedSteps {
public:
    using Scalar = typename Model::Scalar;
    using State = typename Model::State;

    FixedSteps(Model& model, const State& start, const Scalar& step) : model_(model), y_(start), h_(step) {
        take_modes(model_, y_);
    }

    void advance(long steps) {
        if constexpr (HasEvents<Model>)
            if (model_.switches()) {
                for (; steps > 0; --steps)
                    step_through_events(model_, y_, h_, [&](State& y, const Scalar& h) {
                        method().step(model_, y, h);
                        evaluations_ += Method::stages;
                    });
                return;
            }
        if constexpr (is_flattened<Model>)
            repeat_flattened(steps);
        else
            repeat(steps);
        evaluations_ += steps * Method::stages;
    }

    const State& state() const { return y_; }
    long evaluations() const { return evaluations_; }

private:
    Method& method() { return static_cast<Method&>(*this); }
    void repeat(long steps) {
        for (long i = 0; i < steps; ++i) method().step(model_, y_, h_);
    }
    [[gnu::flatten]] void repeat_flattened(long steps) { repeat(steps); }
    DOPPEL_COMPONENTS_APART [[gnu::flatten]] void repeat_flattened(long steps) requires OfBodies<Model> {
        repeat(steps);
    }

    Model& model_;
    State y_;
    Scalar h_;
    long evaluations_ = 0;
};

/// An explicit Runge–Kutta method with `table`: any system, any scalar.
template <System Model, const auto& table>
class RungeKutta : public FixedSteps<RungeKutta<Model, table>, Model> {
public:
    using Base = FixedSteps<RungeKutta, Model>;
    using typename Base::Scalar, typename Base::State;

    RungeKutta(Model& model, const State& start, const Scalar& step) : Base(model, start, step), at_(start) {
        slopes_.fill(start);
    }

private:
    friend Base;
    static constexpr long stages = table.b.size();
    static constexpr bool reuses_angles = stages > 1 && HasStageAngles<Model>;

    void stage_slope(Model& model, const State& y, State& slope) { model.rate(y, slope, angles_.stage()); }
    // one copy for all stages, of 9 kB
    DOPPEL_COMPONENTS_APART [[gnu::flatten, gnu::noinline]] void stage_slope(
        Model& model, const State& y, State& slope) requires OfBodies<Model> && is_flattened<Model> {
        model.rate(y, slope, angles_.stage());
    }

    void step(Model& model, State& y, const Scalar& h) {
        // slopes k_i = f(y + h Σ_{j<i} a_ij k_j)
        const auto slope = [&]<std::size_t i>() {
            if constexpr (i == 0) {
                if constexpr (reuses_angles)
                    model.rate(y, slopes_[0], angles_.start());
                else
                    model.rate(y, slopes_[0]);
            } else {
                static constexpr auto row = table.a[i];
                at_ = y;
                move<row>(at_, h, std::make_index_sequence<i>());
                if constexpr (reuses_angles)
                    stage_slope(model, at_, slopes_[i]);
                else
                    model.rate(at_, slopes_[i]);
            }
        };
        [&]<std::size_t... I>(std::index_sequence<I...>) {
            (slope.template operator()<I>(), ...);
        }
        (std::make_index_sequence<stages>());

        // y + h Σ b_i k_i
        static constexpr auto b = table.b;
        move<b>(y, h, std::make_index_sequence<stages>());
        project(model, y);
    }

    /// y ← y + h Σ_j weight_j k_j over the nonzero weights, which are known at compile time.
    template <const auto& weights, std::size_t... J>
    void move(State& y, const Scalar& h, std::index_sequence<J...>) {
        [[maybe_unused]] const std::array<Scalar, sizeof...(J)> share{Scalar(h * value<Scalar>(weights[J]))...};  // s
        for (Eigen::Index i = 0; i < y.size(); ++i) {
            Scalar change(-0.0);  // unlike +0, −0 changes no sum, so that the addition can be removed
            [[maybe_unused]] const auto add = [&]<std::size_t j>() {
                if constexpr (!is_zero(weights[j])) change += share[j] * slopes_[j][i];
            };
            (add.template operator()<J>(), ...);
            y[i] += change;
        }
    }

    std::array<State, stages> slopes_;
    State at_;
    [[no_unique_address]] StageAnglesOf<Model> angles_;
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
