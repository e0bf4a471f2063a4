#pragma once

#include "integrate/motion.hpp"
#include "integrate/registry.hpp"
#include "numeric/error.hpp"
#include "physics/stabilise.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {

template <class Scalar>
Scalar scalar_of(const Rational& value) {
    return Scalar(value.numerator) / Scalar(value.denominator);
}

/// The angle that is `theta` up to whole turns and nearest to `near`.
inline double unwrapped(double theta, double near) {
    const double turns = std::round((near - theta) / (2 * pi));
    return turns == 0 ? theta : theta + 2 * pi * turns;
}

/// The bobs of a chain in angles.
template <class Scalar>
struct AnglesView {
    static constexpr bool follows_turns = false;
    Pendulum<Scalar> pendulum;

    template <class State>
    Bobs<Scalar> bobs(const State& y) const {
        return bobs_of_angles(pendulum, y);
    }
    template <class State>
    Scalar energy(const State&, const Bobs<Scalar>& seen) const {
        return doppel::energy(seen, pendulum.gravity);
    }
    template <class State>
    Scalar length_error(const State&, const Bobs<Scalar>&) const {
        return Scalar(0);
    }
};

/// The bobs of a chain of particles.
template <class Scalar>
struct ParticlesView {
    static constexpr bool follows_turns = true;
    Pendulum<Scalar> pendulum;

    template <class State>
    Bobs<Scalar> bobs(const State& y) const {
        return bobs_of_particles(pendulum, y);
    }
    template <class State>
    Scalar energy(const State&, const Bobs<Scalar>& seen) const {
        return doppel::energy(seen, pendulum.gravity);
    }
    template <class State>
    Scalar length_error(const State&, const Bobs<Scalar>& seen) const {
        return doppel::length_error(pendulum, seen);
    }
};

/// A model knows its angles only up to whole turns if it is built of particles: they are followed from one look to the
/// next, which may be no further apart than half a turn.
inline constexpr double longest_unwatched = 1.0 / 500;  // s; half a turn in it would be 1570 rad/s

/// A method at work on a model behind the door.
template <class Model, class Which, class View>
class Stepped final : public Motion {
public:
    using Scalar = typename Model::Scalar;
    using State = typename Model::State;

    Stepped(Model model, const State& start, View view, const MotionSpec& spec)
        : model_(std::move(model)), view_(std::move(view)), stepper_(model_, start, pace(spec)) {
        if constexpr (Which::method.adaptive) {
            const double interval = spec.sample_interval.value();
            portions_ = follows_turns(spec) ? static_cast<long>(std::ceil(interval / longest_unwatched)) : 1;
            portion_ = scalar_of<Scalar>(spec.sample_interval) / Scalar(portions_);
        } else {
            // short enough that an interruption is noticed, and the turns are not lost
            steps_per_sample_ = spec.steps_per_sample;
            const double step = spec.sample_interval.value() / static_cast<double>(steps_per_sample_);
            constexpr long most = 200'000;
            portion_steps_ = std::max(1L, most / static_cast<long>(start.size()));
            if (follows_turns(spec))
                portion_steps_ = std::min(portion_steps_, std::max(1L, static_cast<long>(longest_unwatched / step)));
            smallest_step_ = step;
        }
        if constexpr (View::follows_turns)
            if (spec.follows_turns)
                for (const auto& angle : view_.pendulum.angle) turns_.push_back(static_cast<double>(angle));
        start_energy_ = view_.energy(start, view_.bobs(start));
    }

    void advance(const std::atomic<bool>& stop) override {
        const auto check = [&] {
            if (stop) throw Error(ExitCode::interrupted, "interrupted");
        };
        if constexpr (Which::method.adaptive) {
            for (long i = 0; i < portions_; ++i) {
                check();
                stepper_.advance(portion_);
                follow_turns();
            }
        } else {
            for (long left = steps_per_sample_; left > 0; left -= portion_steps_) {
                check();
                stepper_.advance(std::min(left, portion_steps_));
                follow_turns();
            }
            steps_ += steps_per_sample_;
        }
    }

    Observation observe() const override {
        const State y = stepper_.state();
        const auto bobs = view_.bobs(y);
        const Scalar energy = view_.energy(y, bobs);
        Observation seen{.bobs = {},
                         .exact = {},
                         .energy = static_cast<double>(energy),
                         .energy_change = static_cast<double>(Scalar(energy - start_energy_)),
                         .length_error = static_cast<double>(view_.length_error(y, bobs))};
        for (std::size_t i = 0; i < bobs.size(); ++i) {
            const auto& bob = bobs[i];
            const auto in_double = [](const Scalar& x) { return static_cast<double>(x); };
            seen.bobs.push_back({in_double(bob.mass), in_double(bob.x), in_double(bob.y), in_double(bob.vx),
                                 in_double(bob.vy), in_double(bob.theta), in_double(bob.omega)});
            if (!turns_.empty()) seen.bobs[i].theta = unwrapped(seen.bobs[i].theta, turns_[i]);
        }
        if constexpr (std::is_same_v<Scalar, Quad>) seen.exact = bobs;
        return seen;
    }

    Effort effort() const override {
        Effort effort{steps_, stepper_.evaluations(), smallest_step_};
        if constexpr (Which::method.adaptive) {
            effort.steps = stepper_.steps();
            effort.smallest_step = static_cast<double>(stepper_.smallest_step());
        }
        return effort;
    }

private:
    static Scalar pace(const MotionSpec& spec) {
        if constexpr (Which::method.adaptive)
            return static_cast<Scalar>(spec.tolerance);
        else
            return scalar_of<Scalar>(spec.sample_interval) / Scalar(spec.steps_per_sample);
    }

    static bool follows_turns(const MotionSpec& spec) { return View::follows_turns && spec.follows_turns; }

    void follow_turns() {
        if constexpr (View::follows_turns) {
            if (turns_.empty()) return;
            const auto bobs = view_.bobs(stepper_.state());
            for (std::size_t i = 0; i < bobs.size(); ++i)
                turns_[i] = unwrapped(static_cast<double>(bobs[i].theta), turns_[i]);
        }
    }

    Model model_;
    View view_;
    typename Which::template Stepper<Model> stepper_;
    long portions_ = 1, steps_per_sample_ = 0, portion_steps_ = 1, steps_ = 0;
    Scalar portion_{0};  // s
    double smallest_step_ = 0;
    Scalar start_energy_{0};
    std::vector<double> turns_;  // the angles at the last look, unwrapped, rad
};

/// The method of that name at work on `model`. Throws Error (exit 2) where it cannot step it.
template <class Model, class View>
std::unique_ptr<Motion> stepped(const MotionSpec& spec, const Model& model, const typename Model::State& start,
                                const View& view) {
    std::unique_ptr<Motion> motion;
    for_each_method([&]<class Which>() {
        if constexpr (serves<Which, Model>)
            if (Which::method.name == spec.method)
                motion = std::make_unique<Stepped<Model, Which, View>>(model, start, view, spec);
    });
    if (!motion) throw bad_input("the method \"{}\" does not serve this model", spec.method);
    return motion;
}

/// The same on a constrained model of `system`, stabilised as asked.
template <Constrained Model, class System, class View>
std::unique_ptr<Motion> stabilised(const MotionSpec& spec, const System& system, const View& view) {
    const auto start = Model::start(system);
    switch (spec.stabilise) {
        case Stabilise::baumgarte:
            return stepped(spec, Baumgarte<Model>(system, static_cast<typename Model::Scalar>(spec.stabilise_rate)),
                           start, view);
        case Stabilise::projection:
            return stepped(spec, Projected<Model>(system), start, view);
        case Stabilise::none:
            break;
    }
    return stepped(spec, Model(system), start, view);
}

// One file each, so that they compile side by side.
template <class Scalar>
std::unique_ptr<Motion> make_angles_motion(const MotionSpec& spec);
template <class Scalar>
std::unique_ptr<Motion> make_constraints_motion(const MotionSpec& spec);
template <class Scalar>
std::unique_ptr<Motion> make_mechanism_motion(const MotionSpec& spec);

}  // namespace doppel
