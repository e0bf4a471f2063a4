#pragma once

#include "integrate/events.hpp"
#include "integrate/methods.hpp"
#include "numeric/compensated.hpp"
#include "physics/constraint.hpp"

#include <limits>
#include <type_traits>
#include <vector>

namespace doppel {

/// Put before the loops of a single pendulum: if its components were paired in vectors, they would wait for shuffles.
#if defined(__GNUC__) && !defined(__clang__)
#define DOPPEL_COMPONENTS_APART [[gnu::optimize("no-tree-slp-vectorize")]]
#else
#define DOPPEL_COMPONENTS_APART
#endif

// The interface of every method, a class template over the model:
//
//     (Model&, const State& start, const Scalar& step or tolerance)   allocates all memory
//     state()                                                         at the current time
//     evaluations()                                                   of the right-hand side
//     fixed step   advance(long steps)
//     adaptive     advance(seconds), look_ahead(seconds), steps() accepted, smallest_step() chosen by error control, s
//
// Errors: exit 3 if a step cannot be made (no convergence, vanishing step size), exit 2 for a tolerance that the scalar
// cannot reach.

/// to ← to + factor · what, number by number as the models write: a wider load would wait for their stores.
template <class Vector>
void add(Vector& to, const typename Vector::Scalar& factor, const Vector& what) {
    for (Eigen::Index i = 0; i < to.size(); ++i) to[i] += factor * what[i];
}

/// Whether the model projects the state onto its constraints after every step.
template <class Model>
concept Projects = requires(Model& model, typename Model::State& y) {
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

/// Any system with states of one type, behind virtual calls, so that its steppers are compiled once for all systems.
template <class Y>
class AnySystem {
public:
    using State = Y;
    using Scalar = typename Y::Scalar;

    virtual ~AnySystem() = default;
    virtual void rate(const State& y, State& dydt) = 0;
    virtual void project(State& y) = 0;
    virtual bool projects() const = 0;
    virtual bool switches() const = 0;
    virtual void take_modes(State& y) = 0;
    virtual void settle(State& y) = 0;
    virtual Scalar margin(const State& y) = 0;
    virtual Scalar longest_step() const = 0;
};

template <class Y>
inline constexpr bool never_switches<AnySystem<Y>> = Y::RowsAtCompileTime != Eigen::Dynamic;

/// A model as such a system: owned, or by reference (`Model&`).
template <class Held>
class HeldSystem final : public AnySystem<typename std::remove_reference_t<Held>::State> {
public:
    using Model = std::remove_reference_t<Held>;
    using State = typename Model::State;
    using Scalar = typename Model::Scalar;
    static_assert(!HasEvents<Model> || HasEvents<AnySystem<State>>, "a model of fixed size has no events");

    template <class From>
    explicit HeldSystem(From& model) : model_(model) {}

    void rate(const State& y, State& dydt) override { model_.rate(y, dydt); }
    void project(State& y) override { doppel::project(model_, y); }
    bool projects() const override { return doppel::projects(model_); }
    bool switches() const override { return doppel::switches(model_); }
    void take_modes(State& y) override { doppel::take_modes(model_, y); }
    void settle([[maybe_unused]] State& y) override {
        if constexpr (HasEvents<Model>) model_.settle(y);
    }
    Scalar margin([[maybe_unused]] const State& y) override {
        if constexpr (HasEvents<Model>) return model_.margin(y);
        return Scalar(0);
    }
    Scalar longest_step() const override {
        if constexpr (HasEvents<Model>) return model_.longest_step();
        return Scalar(std::numeric_limits<double>::max());
    }

private:
    Held model_;
};

/// A method with its system, as used by Motion.
template <class S>
class Stepper {
public:
    using Scalar = S;
    using State = doppel::State<Scalar, Eigen::Dynamic>;

    virtual ~Stepper() = default;
    virtual void advance(long steps) = 0;                // for methods with a fixed step
    virtual void advance_by(const Scalar& seconds) = 0;  // for adaptive methods
    /// For adaptive methods: read() then gives the state `seconds` after the last advance_by(). Later states have the
    /// same bits as without this call.
    virtual void look_ahead(const Scalar& seconds) = 0;
    virtual void read(State& y) const = 0;  // y ← the current state
    virtual Effort effort() const = 0;      // steps of an adaptive method are accepted ones; of others they are 0
};

/// The output time of an adaptive method, s from the start of its last step. It is stored as a sum of two, so that it
/// neither drifts nor loses precision. Steps taken to look ahead are subtracted when the time reaches them, so that
/// looking ahead changes no bit.
template <class Scalar>
class OutputTime {
public:
    /// Advances by `seconds`: calls next() for the next step, whose length is `step`, until the time lies in the last
    /// one.
    template <class Next>
    Scalar advance(const Scalar& seconds, const Scalar& step, const Next& next) {
        add_compensated(offset_, lost_, seconds);
        for (const auto& ahead : steps_ahead_) pass(ahead);
        steps_ahead_.clear();
        while (offset_ > step) {
            pass(step);
            next();
        }
        return offset_;
    }
    /// The output time after `seconds` more.
    template <class Next>
    Scalar look_ahead(const Scalar& seconds, const Scalar& step, const Next& next) {
        auto ahead = *this;
        return ahead.advance(seconds, step, [&] {
            steps_ahead_.push_back(step);
            next();
        });
    }

private:
    void pass(const Scalar& step) { add_compensated(offset_, lost_, Scalar(-step)); }

    Scalar offset_ = Scalar(0), lost_ = Scalar(0);  // s
    std::vector<Scalar> steps_ahead_;  // s, lengths of steps before the last one that are not subtracted yet
};

}  // namespace doppel
