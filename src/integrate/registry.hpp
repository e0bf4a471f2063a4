#pragma once

#include "base/error.hpp"
#include "integrate/adams.hpp"
#include "integrate/dormand_prince.hpp"
#include "integrate/euler.hpp"
#include "integrate/gauss.hpp"
#include "integrate/rattle.hpp"
#include "integrate/runge_kutta.hpp"
#include "integrate/stepper.hpp"
#include "integrate/taylor.hpp"

#include <memory>
#include <string_view>
#include <tuple>
#include <type_traits>

namespace doppel {

/// All methods, in the order in which they are listed. This is the only list.
using Methods =
    std::tuple<Euler, SemiImplicitEuler, Midpoint, Rk4, Dopri5, Dop853, Adams, Gauss4, Gauss6, Taylor, Rattle, Rattle6>;

/// Whether a method supports a model: its class states the requirements.
template <class Which, class Model>
inline constexpr bool supports = requires {
    typename Which::template Stepper<Model>;
};

/// Calls visit.operator()<Which>() for every method.
template <class Visit>
constexpr void for_each_method(Visit&& visit) {
    [&]<class... Which>(std::type_identity<std::tuple<Which...>>) {
        (visit.template operator()<Which>(), ...);
    }(std::type_identity<Methods>());
}

/// A stepper with its method and the system that it owns; `step_or_tolerance` is the step, s, or the tolerance.
template <class Which, class Model>
class MethodStepper final : public Stepper<typename Model::Scalar> {
public:
    using Scalar = typename Model::Scalar;
    using State = typename Stepper<Scalar>::State;

    MethodStepper(std::unique_ptr<Model> model, const typename Model::State& start, const Scalar& step_or_tolerance)
        : model_(std::move(model)), method_(*model_, start, step_or_tolerance) {}

    void advance([[maybe_unused]] long steps) override {
        if constexpr (!adaptive) method_.advance(steps);
    }
    void advance_by([[maybe_unused]] const Scalar& seconds) override {
        if constexpr (adaptive) method_.advance(seconds);
    }
    void look_ahead([[maybe_unused]] const Scalar& seconds) override {
        if constexpr (adaptive) method_.look_ahead(seconds);
    }
    void read(State& y) const override { y = method_.state(); }
    Effort effort() const override {
        if constexpr (adaptive)
            return {method_.steps(), method_.evaluations(), static_cast<double>(method_.smallest_step())};
        return {.evaluations = method_.evaluations()};
    }

private:
    static constexpr bool adaptive = Which::method.adaptive;

    std::unique_ptr<Model> model_;
    typename Which::template Stepper<Model> method_;
};

/// Whether the number of links is known only at run time.
template <class Model>
consteval bool has_any_length() {
    if constexpr (Constrained<Model>) return Model::Half::RowsAtCompileTime == Eigen::Dynamic;
    return Model::State::RowsAtCompileTime == Eigen::Dynamic;
}

/// Whether a method is compiled for this model. It is if it needs more than the right-hand side, or if a virtual call
/// would be too slow: for a few stages of a few dozen operations. (With calls, midpoint takes 1.45 times as long as
/// inlined, rk4 of three links 1.2 times.) Chains with a fixed number of links are only used for right-hand sides.
/// Other requirements, of Gauss collocation and RATTLE, are compiled for chains of any length; RATTLE also for two
/// rods, in 0.57 of the time.
template <class Which, class Model>
consteval bool is_compiled_for() {
    using Any = AnySystem<typename Model::State>;
    constexpr bool has_few_stages =
        std::is_same_v<Which, SemiImplicitEuler> || std::is_same_v<Which, Midpoint> || std::is_same_v<Which, Rk4>;
    if (!supports<Which, Model>) return false;
    if (std::is_same_v<Model, Any>) return has_any_length<Model>() || !has_few_stages;
    if (!supports<Which, Any>)
        return has_any_length<Model>() || std::is_same_v<Which, Taylor> ||
               std::is_same_v<Model, DoublePendulum<typename Model::Scalar>> ||
               std::is_same_v<Model, RodChain<typename Model::Scalar, 2>>;
    if (std::is_same_v<Which, Euler>) return has_incremental_euler<Model>;
    return has_few_stages && Hamiltonian<Model> && std::is_same_v<typename Model::Scalar, double> &&
           !has_any_length<Model>();
}

/// The method of that name compiled for that model; null if it is not.
template <System Model>
std::unique_ptr<Stepper<typename Model::Scalar>> compiled_stepper(std::string_view method, std::unique_ptr<Model> model,
                                                                  const typename Model::State& start,
                                                                  const typename Model::Scalar& step_or_tolerance) {
    std::unique_ptr<Stepper<typename Model::Scalar>> stepper;
    for_each_method([&]<class Which>() {
        if constexpr (is_compiled_for<Which, Model>())
            if (Which::method.name == method)
                stepper = std::make_unique<MethodStepper<Which, Model>>(std::move(model), start, step_or_tolerance);
    });
    return stepper;
}

// For any system, in stepper_any_double.cpp and stepper_quad.cpp.
template <class State, class S = typename State::Scalar>
using CompiledStepper = std::unique_ptr<Stepper<S>>(std::string_view, std::unique_ptr<AnySystem<State>>, const State&,
                                                    const S&);
extern template CompiledStepper<State<double, 4>> compiled_stepper;
extern template CompiledStepper<State<double, 6>> compiled_stepper;
extern template CompiledStepper<State<double, Eigen::Dynamic>> compiled_stepper;
extern template CompiledStepper<State<Quad, Eigen::Dynamic>> compiled_stepper;

/// A stepper with the method of that name on `model`; on any system if the method only needs the right-hand side.
/// Throws Error (exit 2) if it does not support the model.
template <System Model>
std::unique_ptr<Stepper<typename Model::Scalar>> make_stepper(std::string_view method, const Model& model,
                                                              const typename Model::State& start,
                                                              const typename Model::Scalar& step_or_tolerance) {
    auto stepper = compiled_stepper(method, std::make_unique<Model>(model), start, step_or_tolerance);
    if (!stepper) {
        std::unique_ptr<AnySystem<typename Model::State>> any = std::make_unique<HeldSystem<Model>>(model);
        stepper = compiled_stepper(method, std::move(any), start, step_or_tolerance);
    }
    if (!stepper) throw bad_input("the method \"{}\" does not support this model", method);
    return stepper;
}

}  // namespace doppel
