#pragma once

#include "integrate/events.hpp"
#include "physics/constraint.hpp"

#include <concepts>
#include <limits>
#include <memory>
#include <string_view>
#include <type_traits>
#include <utility>

namespace doppel {

/// What every method's class template over the model offers, besides its constructor:
///
///     fixed step   (Model&, const State& start, const Scalar& step)
///     adaptive     (Model&, const State& start, const Scalar& tolerance)
///
/// Errors: Error (exit 3) where a step cannot be made: no convergence, a step size that vanishes, a tolerance that the
/// scalar cannot give. All memory is allocated by the constructor.
template <class S>
concept Steps = requires(S stepper) {
    stepper.state();                                         // now
    { stepper.evaluations() } -> std::convertible_to<long>;  // of the right-hand side so far
};
template <class S>
concept FixedStepper = Steps<S> && requires(S stepper) {
    stepper.advance(1L);
};  // so many steps
template <class S>
concept AdaptiveStepper = Steps<S> && requires(S stepper, const typename S::Scalar& seconds) {
    stepper.advance(seconds);
    stepper.look_ahead(seconds);
    { stepper.steps() } -> std::convertible_to<long>;                        // accepted
    { stepper.smallest_step() } -> std::convertible_to<typename S::Scalar>;  // s, of those that error control chose
};

/// After every step a model may project the state onto its constraints.
template <class Model>
concept Projects = requires(Model model, typename Model::State& y) {
    model.project(y);
};
template <class Model, class State>
void project(Model& model, State& y) {
    if constexpr (Projects<Model>) model.project(y);
}
template <class Model>
bool projects(const Model& model) {
    if constexpr (requires { model.projects(); })
        return model.projects();
    else
        return Projects<Model>;
}

/// Any system with states of one type, behind a virtual call: what steps it is compiled once for all of them.
template <class Y>
class AnySystem {
public:
    using State = Y;
    using Scalar = typename Y::Scalar;

    template <System Model>
    requires(!std::same_as<Model, AnySystem> &&
             std::same_as<typename Model::State, State>) explicit AnySystem(const Model& model)
        : AnySystem(std::make_unique<Held<Model>>(model), model) {}
    /// Of one that lives elsewhere, and as long.
    template <class Model>
    static AnySystem of(Model& model) {
        return AnySystem(std::make_unique<Held<Model&>>(model), model);
    }

    void rate(const State& y, State& dydt) { system_->rate(y, dydt); }
    void project(State& y) {
        if (projects_) system_->project(y);
    }
    bool projects() const { return projects_; }
    bool switches() const { return switches_; }
    void take_modes(State& y) { system_->take_modes(y); }
    void settle(State& y) { system_->settle(y); }
    Scalar margin(const State& y) { return system_->margin(y); }
    Scalar longest_step() const { return system_->longest_step(); }

private:
    struct Interface {
        virtual ~Interface() = default;
        virtual void rate(const State& y, State& dydt) = 0;
        virtual void project(State& y) = 0;
        virtual void take_modes(State& y) = 0;
        virtual void settle(State& y) = 0;
        virtual Scalar margin(const State& y) = 0;
        virtual Scalar longest_step() const = 0;
    };
    template <class As>
    struct Held final : Interface {
        using Model = std::remove_cvref_t<As>;
        As model;
        template <class From>
        explicit Held(From& held) : model(held) {}
        void rate(const State& y, State& dydt) override { model.rate(y, dydt); }
        void project(State& y) override { doppel::project(model, y); }
        void take_modes(State& y) override { doppel::take_modes(model, y); }
        void settle([[maybe_unused]] State& y) override {
            if constexpr (HasEvents<Model>) model.settle(y);
        }
        Scalar margin([[maybe_unused]] const State& y) override {
            if constexpr (HasEvents<Model>)
                return model.margin(y);
            else
                return Scalar(0);
        }
        Scalar longest_step() const override {
            if constexpr (HasEvents<Model>)
                return model.longest_step();
            else
                return Scalar(std::numeric_limits<double>::max());
        }
    };

    template <class Model>
    AnySystem(std::unique_ptr<Interface> system, const Model& model)
        : system_(std::move(system)), projects_(doppel::projects(model)), switches_(doppel::switches(model)) {}

    std::unique_ptr<Interface> system_;
    bool projects_, switches_;
};

/// The right-hand side, for methods of many stages: called, not copied into every one of them, which costs them two
/// nanoseconds a stage and saves minutes of compiling.
template <class Model, class State>
[[gnu::noinline]] void slope(Model& model, const State& y, State& dydt) {
    model.rate(y, dydt);
}
template <class State>
void slope(AnySystem<State>& model, const State& y, State& dydt) {
    model.rate(y, dydt);
}

/// A method at work on a system, as what samples it drives it.
template <class S>
class Stepper {
public:
    using Scalar = S;
    using State = doppel::State<Scalar, Eigen::Dynamic>;

    virtual ~Stepper() = default;
    virtual void advance(long steps) = 0;                // of a method with a fixed step
    virtual void advance_by(const Scalar& seconds) = 0;  // of an adaptive one
    /// Of an adaptive one: read() tells the state so long after the last advance_by(); later ones are the same to the bit
    /// as if it had not been asked for.
    virtual void look_ahead(const Scalar& seconds) = 0;
    virtual void read(State& y) const = 0;     // y ← the state now
    virtual long evaluations() const = 0;      // of the right-hand side
    virtual long steps() const = 0;            // of an adaptive method, accepted
    virtual Scalar smallest_step() const = 0;  // s, of those

    State state() const {
        State y;
        read(y);
        return y;
    }
};

/// The method of that name on any system; null where it wants to know more of one. Compiled for the states of Doppel's
/// models in stepper_any_double.cpp and stepper_quad.cpp.
template <class State>
std::unique_ptr<Stepper<typename State::Scalar>> make_any_stepper(std::string_view method, AnySystem<State> system,
                                                                  const State& start,
                                                                  const typename State::Scalar& step_or_tolerance);

}  // namespace doppel
