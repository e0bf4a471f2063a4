#pragma once

#include "integrate/methods.hpp"
#include "integrate/series.hpp"
#include "integrate/stabilise.hpp"
#include "integrate/stepper.hpp"
#include "numeric/quad.hpp"
#include "numeric/roots.hpp"
#include "physics/angle_chain.hpp"
#include "physics/mechanism.hpp"
#include "physics/physical_chain.hpp"
#include "physics/rod_chain.hpp"

#include <memory>
#include <optional>

namespace doppel {

/// The Taylor method. Each step computes the series of the motion to a high order by recurrence, and goes as far as its
/// last coefficients allow; output times shorten no step, as the series holds anywhere inside one.
///
/// Order   p = 10 − ½ ln ε (taylor_order()).
/// Step    h = min (ε / |c_k|)^(1/k) over the last four coefficients of the rates, relative to the rates' amount.
///         Rates are the harder part: an angle errs by about h/p times as much. No step is more than twice the one
///         before.
/// Rounding of the state is carried over to the next step, and time is kept as a distance from the start of the step.
/// Source  Jorba & Zou 2005, A software package for the numerical integration of ODEs by means of high-order Taylor
///         methods, Experimental Mathematics 14:99.
template <class S>
class SeriesStepper {
public:
    using Scalar = S;
    using State = typename Series<Scalar>::State;

    /// `system` where it projects or has events.
    SeriesStepper(std::unique_ptr<Series<Scalar>> series, std::optional<AnySystem<State>> system, const State& start,
                  double tolerance, int order);

    void advance(const Scalar& seconds);
    const State& state() const { return out_; }

    /// In place of advance(), for what evaluates inside every step: on to the end of the last one, where the next is
    /// expanded. On it, at(t) holds for 0 ≤ t ≤ step(), s from where it starts; at(step()) is at(0) of the one after,
    /// to the bit.
    void take_step();
    const State& at(const Scalar& t);
    const Scalar& step() const { return step_; }
    /// A coordinate on the step, at whose ends it is what at() says.
    Bernstein on_step(Eigen::Index coordinate);

    int order() const { return order_; }
    long steps() const { return steps_; }
    Scalar smallest_step() const { return smallest_; }
    /// Orders computed: each costs about what a right-hand side would.
    long evaluations() const { return steps_ * order_; }

private:
    void next_step(double seconds);
    void expand(double seconds);
    bool ends_at_event();
    double chosen_step();
    bool has_events() const { return system_ && system_->switches(); }
    void project(State& y) {
        if (system_) system_->project(y);
    }

    double tolerance_;
    int order_;
    std::unique_ptr<Series<Scalar>> series_;
    std::optional<AnySystem<State>> system_;
    State base_, lost_;                                    // where the step starts, and what rounding took from it
    State change_, out_;                                   // the state at the output time
    Scalar step_ = Scalar(0), smallest_ = Scalar(0);       // s
    double free_step_ = 0;                                 // s, what the step would be but for events
    Scalar offset_ = Scalar(0), offset_lost_ = Scalar(0);  // s, from the start of the step to the output time
    long steps_ = 0;
    bool ends_at_event_ = false;  // the step
    Stall stall_;
};
extern template class SeriesStepper<double>;
extern template class SeriesStepper<Quad>;

/// The order that a tolerance takes: more than the usual 1 − ½ ln ε, since the work grows more like p than like p².
/// `asked`, from 5 to 64, where it is not 0. Errors  exit 2 where the tolerance is less than 4 `epsilon`.
int taylor_order(double tolerance, double epsilon, int digits, int asked = 0);

// The series of a model that has one. A chain of particles on rods is the mechanism of its parts; projected after every step
// it is the same motion, pulled back by Baumgarte's terms it is not.
template <class Scalar, int N>
std::unique_ptr<Series<Scalar>> series_of(const AngleChain<Scalar, N>& model, int order) {
    return series_of_chain(model.pendulum, order);
}
template <class Scalar>
std::unique_ptr<Series<Scalar>> series_of(const DoublePendulum<Scalar>& d, int order) {
    const Pendulum<Scalar> chain{{d.m1, d.m2}, {d.l1, d.l2}, {Scalar(0), Scalar(0)}, {Scalar(0), Scalar(0)}, d.g};
    return series_of_chain(chain, order);
}
template <class Scalar>
std::unique_ptr<Series<Scalar>> series_of(const PhysicalChain<Scalar>& model, int order) {
    return series_of_bodies(model, order);
}
template <class Scalar>
std::unique_ptr<Series<Scalar>> series_of(const Mechanism<Scalar>& model, int order) {
    return series_of_mechanism(model.parts, order);
}
template <class Scalar, int N>
std::unique_ptr<Series<Scalar>> series_of(const RodChain<Scalar, N>& model, int order) {
    return series_of_mechanism(parts_of(model.pendulum), order);
}
template <class Model>
std::unique_ptr<Series<typename Model::Scalar>> series_of(const Baumgarte<Model>&, int) = delete;

template <class Model>
concept HasSeries = requires(const Model& model) {
    series_of(model, 1);
};

/// The Taylor method on a model (integrate/stepper.hpp). Throws Error (exit 2) for a tolerance that the scalar cannot give.
template <HasSeries Model>
class TaylorStepper : public SeriesStepper<typename Model::Scalar> {
public:
    using Scalar = typename Model::Scalar;

    TaylorStepper(Model& model, const typename Model::State& start, const Scalar& tolerance, int order = 0)
        : TaylorStepper(Order{taylor_order(static_cast<double>(tolerance),
                                           static_cast<double>(std::numeric_limits<Scalar>::epsilon()),
                                           std::numeric_limits<Scalar>::digits10 + 1, order)},
                        model, start, static_cast<double>(tolerance)) {}

private:
    using State = typename SeriesStepper<Scalar>::State;
    struct Order {
        int value;
    };
    TaylorStepper(Order order, Model& model, const State& start, double tolerance)
        : SeriesStepper<Scalar>(series_of(model, order.value), system_of(model), start, tolerance, order.value) {}

    static std::optional<AnySystem<State>> system_of([[maybe_unused]] Model& model) {
        if constexpr (std::is_same_v<typename Model::State, State>) return AnySystem<State>::of(model);
        return std::nullopt;
    }
    static_assert(std::is_same_v<typename Model::State, State> || !(HasEvents<Model> || Projects<Model>),
                  "what projects or has events has a state of any size");
};

/// The Taylor method, for every model that has a series.
struct Taylor {
    static constexpr Method method{"taylor", "Taylor series", 0, true, "explicit, order from the tolerance"};
    template <HasSeries Model>
    using Stepper = TaylorStepper<Model>;
};

}  // namespace doppel
