#include "integrate/motion.hpp"

#include "base/error.hpp"
#include "integrate/methods.hpp"
#include "integrate/stepper.hpp"
#include "integrate/turns.hpp"
#include "physics/mechanism.hpp"
#include "physics/physical_forces.hpp"
#include "physics/rod_chain.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

namespace doppel {

// Defined in integrate/motion_steppers.hpp.
template <class Scalar>
std::unique_ptr<Stepper<Scalar>> make_angles_stepper(const MotionSpec& spec);
template <class Scalar>
std::unique_ptr<Stepper<Scalar>> make_constraints_stepper(const MotionSpec& spec);
template <class Scalar>
std::unique_ptr<Stepper<Scalar>> make_mechanism_stepper(const MotionSpec& spec);

namespace {

/// The angle in rad after which a fast rotation or drive is checked for interruption; some 0.1 s of work.
template <class Scalar>
constexpr double max_unwatched = std::is_same_v<Scalar, double> ? 2e3 : 100;

/// A model with its stepper, advanced from sample to sample.
template <class Scalar>
class Simulation final : public Motion {
public:
    explicit Simulation(const MotionSpec& spec)
        : stepper_(make_stepper(spec)),
          model_(spec.model),
          adaptive_(find_method(spec.method)->adaptive),
          wants_tension_(spec.wants_tension) {
        if (spec.chain) pendulum_ = spec.chain->cast<Scalar>();
        if (spec.physical) physical_ = spec.physical->cast<Scalar>();
        if (model_ == Model::mechanism) mechanism_.emplace(spec.parts->cast<Scalar>());
        stepper_->read(y_);
        if (const auto links = static_cast<Eigen::Index>(spec.chain ? spec.chain->links() : 0); physical_)
            layout_.emplace(*physical_, links, true, y_.size() == 2 * (links + 2));
        const auto released = configuration(y_);
        start_energy_ = released.energy;
        const double interval = spec.sample_interval.value();
        const bool follows_turns = model_ != Model::angles && pendulum_ && spec.follows_turns;
        if (adaptive_) {
            double fastest = 0;  // rad/s, the fastest bob or drive
            for (const auto& bob : released.bobs) fastest = std::max(fastest, std::abs(static_cast<double>(bob.omega)));
            if (physical_) {
                fastest = std::max(fastest, static_cast<double>(physical_->pivot.frequency));
                for (const auto& motor : physical_->torques)
                    fastest = std::max(fastest, static_cast<double>(motor.frequency));
            }
            const double pieces =
                std::max(follows_turns ? interval / Turns::longest : 1, interval * fastest / max_unwatched<Scalar>);
            whole_ = static_cast<long>(std::ceil(std::min(pieces, 1e12)));
            portion_ = spec.sample_interval.as<Scalar>() / Scalar(whole_);
        } else {
            whole_ = spec.steps_per_sample;
            portion_steps_ = steps_in_one_go(y_.size());
            step_ = interval / static_cast<double>(whole_);
        }
        if (follows_turns) turns_ = Turns(pendulum_->template cast<double>().angle);
        follow_turns(0);
    }

    void advance(const std::atomic<bool>& stop) override {
        ahead_.reset();
        go_to(whole_, stop);
        taken_ = 0;
        ++samples_;
    }

    void advance_within(double share, const std::atomic<bool>& stop) override {
        const double part = share * static_cast<double>(whole_), last = std::floor(part);
        if (!adaptive_) return go_to(std::lround(part), stop);
        go_to(static_cast<long>(last), stop);
        const Scalar rest = Scalar(part - last) * portion_;
        stepper_->look_ahead(rest);
        if (!turns_.followed()) return;
        ahead_ = turns_;
        stepper_->read(y_);
        ahead_->update(y_, static_cast<double>(rest));
    }

    Observation observe() const override {
        State y;
        stepper_->read(y);
        auto [bobs, pivot, energy, kinetic_energy] = configuration(y);
        (ahead_ ? *ahead_ : turns_).add_to(bobs);
        const Scalar work = layout_ ? layout_->work_of(y) : Scalar(0);
        const Scalar of_rods = model_ == Model::angles ? Scalar(0)
                               : mechanism_            ? mechanism_->length_error(y)
                                                       : length_error(*pendulum_, bobs);
        Observation seen{.bobs = Cast<double>()(bobs),
                         .exact = {},
                         .pivot = Cast<double>()(pivot),
                         .energy = static_cast<double>(energy),
                         .kinetic_energy = static_cast<double>(kinetic_energy),
                         .work = static_cast<double>(work),
                         .energy_change = static_cast<double>(Scalar(energy - start_energy_ - work)),
                         .length_error = static_cast<double>(of_rods)};
        if constexpr (std::is_same_v<Scalar, Quad>) seen.exact = bobs;
        if (wants_tension_)
            seen.tension = mechanism_ ? tensions<Mechanism<double>>(mechanism_->parts, seen.bobs)
                                      : tensions<RodChain<double, Eigen::Dynamic>>(*pendulum_, seen.bobs);
        return seen;
    }

    Effort effort() const override {
        auto effort = stepper_->effort();
        if (!adaptive_) effort.steps = samples_ * whole_, effort.smallest_step = step_;
        return effort;
    }

private:
    using State = doppel::State<Scalar, Eigen::Dynamic>;

    static std::unique_ptr<Stepper<Scalar>> make_stepper(const MotionSpec& spec) {
        switch (spec.model) {
            case Model::angles:
                return make_angles_stepper<Scalar>(spec);
            case Model::constraints:
                return make_constraints_stepper<Scalar>(spec);
            case Model::mechanism:
                break;
        }
        doppel::check(spec.parts->cast<double>());
        return make_mechanism_stepper<Scalar>(spec);
    }

    /// Bobs of a chain have their angles, which are within (−π, π] except in the model of angles.
    Configuration<Scalar> configuration(const State& y) const {
        if (physical_) return configuration_of(*physical_, layout_->of_links(y), Scalar(layout_->time_of(y)));
        Configuration<Scalar> seen{model_ == Model::angles ? bobs_of_angles(*pendulum_, y)
                                   : pendulum_             ? bobs_of_particles(*pendulum_, y)
                                                           : mechanism_->bobs(y)};
        seen.energy = mechanism_ ? mechanism_->energy(y) : energy(seen.bobs, pendulum_->gravity);
        seen.kinetic_energy = kinetic_energy(seen.bobs);
        return seen;
    }
    template <class Rods, class System>
    static std::vector<double> tensions(const System& system, const Bobs<double>& bobs) {
        return Rods(system.template cast<double>()).tensions(particles_of(bobs));
    }
    /// Advances to that portion of the sample interval, or to that step.
    void go_to(long last, const std::atomic<bool>& stop) {
        for (long some = 1; taken_ < last; taken_ += some) {
            throw_if_set(stop);
            if (adaptive_) {
                advance_by(portion_);
                continue;
            }
            some = std::min(last - taken_, portion_steps_);
            if (turns_.followed()) some = std::min(some, steps_within(turns_.longest_interval(), step_));
            stepper_->advance(some);
            follow_turns(static_cast<double>(some) * step_);
        }
    }

    /// For adaptive methods, in as many parts as counting turns requires.
    void advance_by(const Scalar& seconds) {
        constexpr double maximum = 1e6;
        const double pieces =
            turns_.followed()
                ? std::clamp(std::ceil(static_cast<double>(seconds) / turns_.longest_interval()), 1.0, maximum)
                : 1;
        const Scalar piece = seconds / Scalar(pieces);
        for (double i = 0; i < pieces; ++i) {
            stepper_->advance_by(piece);
            follow_turns(static_cast<double>(piece));
        }
    }

    void follow_turns(double seconds) {
        if (!turns_.followed()) return;
        stepper_->read(y_);
        turns_.update(y_, seconds);
    }

    std::unique_ptr<Stepper<Scalar>> stepper_;
    Model model_;
    bool adaptive_, wants_tension_;
    std::optional<Pendulum<Scalar>> pendulum_;
    std::optional<PhysicalPendulum<Scalar>> physical_;
    std::optional<PhysicalLayout> layout_;  // of the state of a rigid-body chain
    std::optional<Mechanism<Scalar>> mechanism_;
    long whole_ = 1;                // portions per sample (adaptive methods), or steps
    Scalar portion_{0};             // s
    long portion_steps_ = 1;        // fixed steps taken at a time
    double step_ = 0;               // s
    long samples_ = 0, taken_ = 0;  // samples; portions or steps since the last sample
    Scalar start_energy_{0};
    State y_;  // at the last update of turns
    Turns turns_;
    std::optional<Turns> ahead_;  // at a state between samples
};

}  // namespace

std::unique_ptr<Motion> make_motion(const MotionSpec& spec) {
    const auto* method = find_method(spec.method);
    if (!method) throw bad_input("there is no method \"{}\"", spec.method);
    if (spec.stabilise != Stabilise::none && spec.model == Model::angles)
        throw bad_input("with angles as coordinates the rods have constant length; there is nothing to stabilise");
    if (spec.stabilise != Stabilise::none && !method->stabilised)
        throw bad_input("the method \"{}\" keeps the constraints itself; there is nothing to stabilise", spec.method);
    if (spec.physical && spec.model != Model::angles)
        throw bad_input("links with mass, friction or a drive need model = \"angles\"; it is \"constraints\"");
    if (spec.physical && spec.wants_tension)
        throw bad_input(
            "rod tensions are defined for point masses on massless rods; these links have mass, friction or a drive");
    if (spec.precision == Precision::in_quad) return std::make_unique<Simulation<Quad>>(spec);
    return std::make_unique<Simulation<double>>(spec);
}

}  // namespace doppel
