#pragma once

#include "base/error.hpp"
#include "integrate/methods.hpp"
#include "integrate/motion.hpp"
#include "integrate/registry.hpp"
#include "integrate/stabilise.hpp"
#include "integrate/turns.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {

template <class Scalar>
Scalar scalar_of(const Rational& value) {
    return Scalar(value.numerator) / Scalar(value.denominator);
}

/// A whirl is watched every so many rad, so that an interruption is noticed within a sample of it; some 0.1 s of work.
inline constexpr double most_unwatched = 1e4;

/// A model with the method that steps it, behind the door.
template <class State, class View>
class Simulation final : public Motion {
public:
    using Scalar = typename State::Scalar;

    Simulation(std::unique_ptr<Stepper<State>> stepper, const State& start, View view, const MotionSpec& spec)
        : view_(std::move(view)),
          stepper_(std::move(stepper)),
          adaptive_(find_method(spec.method)->adaptive),
          wants_tension_(spec.wants_tension) {
        const auto bobs = view_.bobs(start);
        if (adaptive_) {
            const double interval = spec.sample_interval.value();
            const double whole = std::max(follows_turns(spec) ? interval / Turns::longest_unwatched : 1,
                                          interval * fastest(bobs) / most_unwatched);
            portions_ = static_cast<long>(std::ceil(std::min(whole, 1e12)));
            portion_ = scalar_of<Scalar>(spec.sample_interval) / Scalar(portions_);
        } else {
            steps_per_sample_ = spec.steps_per_sample;
            portion_steps_ = steps_in_one_go(start.size());
            step_ = spec.sample_interval.value() / static_cast<double>(steps_per_sample_);
        }
        if constexpr (View::follows_turns)
            if (spec.follows_turns) turns_ = Turns(view_.pendulum.template cast<double>().angle);
        turns_.update(start, 0);
        start_energy_ = view_.energy(start, bobs);
    }

    void advance(const std::atomic<bool>& stop) override {
        const auto check = [&] {
            if (stop) throw Error(ExitCode::interrupted, "interrupted");
        };
        if (adaptive_) {
            for (long i = 0; i < portions_; ++i) {
                check();
                advance_by(portion_);
            }
        } else {
            for (long left = steps_per_sample_, steps; left > 0; left -= steps) {
                check();
                steps = std::min(left, portion_steps_);
                if (turns_.followed()) steps = std::min(steps, steps_within(turns_.patience(), step_));
                stepper_->advance(steps);
                follow_turns(static_cast<double>(steps) * step_);
            }
            steps_ += steps_per_sample_;
        }
    }

    Observation observe() const override {
        const State y = stepper_->state();
        auto bobs = view_.bobs(y);
        turns_.add_to(bobs);
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
        }
        if constexpr (std::is_same_v<Scalar, Quad>) seen.exact = bobs;
        if (wants_tension_) seen.tension = view_.tension(seen.bobs);
        return seen;
    }

    Effort effort() const override {
        if (!adaptive_) return {steps_, stepper_->evaluations(), step_};
        return {stepper_->steps(), stepper_->evaluations(), static_cast<double>(stepper_->smallest_step())};
    }

private:
    /// The fastest rate of any bob, rad/s.
    static double fastest(const Bobs<Scalar>& bobs) {
        double rate = 0;
        for (const auto& bob : bobs) rate = std::max(rate, std::abs(static_cast<double>(bob.omega)));
        return rate;
    }

    static bool follows_turns(const MotionSpec& spec) { return View::follows_turns && spec.follows_turns; }

    /// An adaptive method, in as many pieces as turns want to be looked at.
    void advance_by(const Scalar& seconds) {
        constexpr double most = 1e6;
        const double pieces =
            turns_.followed() ? std::clamp(std::ceil(static_cast<double>(seconds) / turns_.patience()), 1.0, most) : 1;
        const Scalar piece = seconds / Scalar(pieces);
        for (double i = 0; i < pieces; ++i) {
            stepper_->advance_by(piece);
            follow_turns(static_cast<double>(piece));
        }
    }

    void follow_turns(double seconds) {
        if constexpr (View::follows_turns)
            if (turns_.followed()) turns_.update(stepper_->state(), seconds);
    }

    View view_;
    std::unique_ptr<Stepper<State>> stepper_;
    bool adaptive_, wants_tension_;
    long portions_ = 1;                                          // of a sample, of an adaptive method
    Scalar portion_{0};                                          // s
    long steps_per_sample_ = 0, portion_steps_ = 1, steps_ = 0;  // of a fixed step
    double step_ = 0;                                            // s
    Scalar start_energy_{0};
    Turns turns_;
};

/// The step, s, or the tolerance.
template <class Scalar>
Scalar step_or_tolerance_of(const MotionSpec& spec) {
    if (find_method(spec.method)->adaptive) return static_cast<Scalar>(spec.tolerance);
    return scalar_of<Scalar>(spec.sample_interval) / Scalar(spec.steps_per_sample);
}

/// The method of `spec` at work on `model`. Throws Error (exit 2) where it cannot step it.
template <class Model, class View>
std::unique_ptr<Motion> simulation(const MotionSpec& spec, const Model& model, const typename Model::State& start,
                                   const View& view) {
    return std::make_unique<Simulation<typename Model::State, View>>(
        make_stepper(spec.method, model, start, step_or_tolerance_of<typename Model::Scalar>(spec)), start, view, spec);
}

/// The same on a constrained model of `system`, stabilised as asked.
template <Constrained Model, class System, class View>
std::unique_ptr<Motion> stabilised(const MotionSpec& spec, const System& system, const View& view) {
    const auto start = Model::start(system);
    switch (spec.stabilise) {
        case Stabilise::baumgarte:
            return simulation(spec, Baumgarte<Model>(system, static_cast<typename Model::Scalar>(spec.stabilise_rate)),
                              start, view);
        case Stabilise::projection:
            return simulation(spec, Projected<Model>(system), start, view);
        case Stabilise::none:
            break;
    }
    return simulation(spec, Model(system), start, view);
}

// Defined in integrate/motion_models.hpp; compiled in files of their own, side by side.
template <class Scalar>
std::unique_ptr<Motion> make_angles_motion(const MotionSpec& spec);
template <class Scalar>
std::unique_ptr<Motion> make_constraints_motion(const MotionSpec& spec);
template <class Scalar>
std::unique_ptr<Motion> make_mechanism_motion(const MotionSpec& spec);

}  // namespace doppel
