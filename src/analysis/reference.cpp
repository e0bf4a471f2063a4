#include "analysis/reference.hpp"

#include "analysis/difference.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <limits>
#include <span>

namespace doppel {
namespace {

const Quad fine = parse_quad("1e-30"), finer = parse_quad("1e-32");

Bobs<Quad> end_of(MotionSpec spec, Model model, const Quad& tolerance, const Rational& seconds,
                  const std::atomic<bool>& stop) {
    constexpr long parts = 64;  // an interruption is noticed between them
    spec.model = model;
    spec.method = "taylor";
    spec.precision = Precision::in_quad;
    spec.tolerance = tolerance;
    spec.sample_interval = *quotient(seconds, {parts, 1});
    spec.follows_turns = false;
    const auto motion = make_motion(spec);
    for (long i = 0; i < parts; ++i) motion->advance(stop);
    return motion->observe().exact;
}

}  // namespace

Reference reference_end(MotionSpec spec, const Rational& seconds, double allowed, const std::atomic<bool>& stop) {
    spec.stabilise = Stabilise::none;
    const auto model = spec.model == Model::mechanism ? Model::mechanism : Model::angles;
    const bool has_rods = model == Model::angles && !spec.physical;
    Reference reference{end_of(spec, model, finer, seconds, stop), 0};
    const auto other =
        has_rods ? end_of(spec, Model::constraints, finer, seconds, stop) : end_of(spec, model, fine, seconds, stop);
    reference.disagreement = spec.chain ? angle_error(reference.end, other) : place_error(reference.end, other);
    if (!(reference.disagreement <= allowed))
        throw method_failed(
            "no reference: two computations in quad differ by {:.2g} {} after {} s, where {:.2g} is allowed; the "
            "motion "
            "is too chaotic for so long a time",
            reference.disagreement, spec.chain ? "rad" : "m", seconds.value(), allowed);
    return reference;
}

namespace {

std::vector<Quad> coordinates(const Observation& observed, bool in_angles) {
    std::vector<Quad> all;
    const auto take = [&](const auto& bobs) {
        for (const auto& bob : bobs) {
            if (in_angles) {
                all.emplace_back(bob.theta);
            } else {
                all.emplace_back(bob.x);
                all.emplace_back(bob.y);
            }
        }
    };
    observed.exact.empty() ? take(observed.bobs) : take(observed.exact);
    return all;
}

double largest_difference(std::span<const Quad> one, std::span<const Quad> other, bool in_angles, double reach) {
    double worst = 0;
    for (std::size_t i = 0; i < one.size(); i += in_angles ? 1 : 2) {
        const double off = in_angles ? angle_between(one[i], other[i])
                                     : std::hypot(static_cast<double>(Quad(one[i] - other[i])),
                                                  static_cast<double>(Quad(one[i + 1] - other[i + 1]))) /
                                           reach;
        if (!std::isfinite(off)) return off;
        worst = std::max(worst, off);
    }
    return worst;
}

/// Several motions, sample by sample. False, with the reason, where one of them cannot go on.
bool advanced(std::span<const std::unique_ptr<Motion>> motions, std::string& failure, const std::atomic<bool>& stop) {
    throw_if_set(stop);
    try {
        for (const auto& motion : motions) motion->advance(stop);
        return true;
    } catch (const Error& fault) {
        if (fault.code() != ExitCode::method_failed) throw;
        failure = fault.what();
        return false;
    }
}

/// How many roundings of a number, half an ulp each, some_roundings_away() moves it by.
constexpr double roundings_away = 24;

/// Light masses make more of the roundings of steps than of those of the start: 5.5 times that was seen.
constexpr double caution = 9;

/// In the motion's own precision, with its uncertainty; and what it cost.
ReferenceTrajectory own_trajectory(const MotionSpec& spec, long samples, double reach, double enough,
                                   const std::atomic<bool>& stop, Effort& effort) {
    ReferenceTrajectory trajectory{
        .in_angles = spec.chain.has_value(), .reach = reach, .seen = {}, .uncertainty = {}, .failure = {}};
    const bool quad = spec.precision == Precision::in_quad;
    const std::unique_ptr<Motion> motions[]{
        make_motion(by_taylor_series(spec, parse_quad(quad ? "1e-33" : "1e-15"))),
        make_motion(by_taylor_series(some_roundings_away(spec), parse_quad(quad ? "3e-33" : "3e-15")))};
    double uncertainty = 0;
    for (long sample = 0; sample <= samples && uncertainty <= enough; ++sample) {
        if (sample > 0 && !advanced(motions, trajectory.failure, stop)) break;
        auto seen = coordinates(motions[0]->observe(), trajectory.in_angles);
        const double off = largest_difference(seen, coordinates(motions[1]->observe(), trajectory.in_angles),
                                              trajectory.in_angles, reach);
        if (!std::isfinite(off)) break;
        uncertainty = std::max(uncertainty, caution * off);
        trajectory.seen.push_back(std::move(seen));
        trajectory.uncertainty.push_back(uncertainty);
    }
    effort = motions[0]->effort();
    return trajectory;
}

/// Of a motion in double, in quad.
ReferenceTrajectory wide_trajectory(const MotionSpec& spec, long samples, double reach, double enough,
                                    const std::atomic<bool>& stop) {
    constexpr double further = 1.25;  // than a run in double is of use; quad at that tolerance gets as much further
    ReferenceTrajectory trajectory{.in_angles = spec.chain.has_value(),
                                   .reach = reach,
                                   .seen = {},
                                   .uncertainty = {},
                                   .is_wider = true,
                                   .failure = {}};
    auto wide = by_taylor_series(spec, parse_quad("1e-20"));
    wide.precision = Precision::in_quad;
    const std::unique_ptr<Motion> motions[]{make_motion(wide),
                                            make_motion(by_taylor_series(spec, parse_quad("1e-15")))};
    long last = samples;
    for (long sample = 0; sample <= last; ++sample) {
        if (sample > 0 && !advanced(motions, trajectory.failure, stop)) break;
        trajectory.seen.push_back(coordinates(motions[0]->observe(), trajectory.in_angles));
        trajectory.uncertainty.push_back(0);
        const double off = trajectory.distance(static_cast<std::size_t>(sample), motions[1]->observe());
        if (last == samples && !(off <= enough))
            last = std::min(samples, std::lround(further * static_cast<double>(sample)));
    }
    return trajectory;
}

}  // namespace

double ReferenceTrajectory::distance(std::size_t sample, const Observation& observed) const {
    return largest_difference(seen[sample], coordinates(observed, in_angles), in_angles, reach);
}

std::string ReferenceTrajectory::description() const {
    return is_wider ? "Taylor series in quad" : "Taylor series as fine as the precision allows";
}

MotionSpec by_taylor_series(MotionSpec spec, const Quad& tolerance) {
    if (spec.model == Model::constraints) spec.model = Model::angles;
    spec.method = "taylor";
    spec.tolerance = tolerance;
    spec.stabilise = Stabilise::none;
    spec.follows_turns = spec.wants_tension = false;
    return spec;
}

MotionSpec some_roundings_away(MotionSpec spec) {
    // a number errs by half an ulp at most; more of them leave room for what the steps add
    Quad change = roundings_away / 2 *
                  (spec.precision == Precision::in_quad ? std::numeric_limits<Quad>::epsilon()
                                                        : Quad(std::numeric_limits<double>::epsilon()));
    const auto move = [&](Quad& number) {
        number *= 1 + change;
        change = -change;
    };
    if (spec.chain) {
        for (auto* numbers : {&spec.chain->angle, &spec.chain->rate, &spec.chain->length, &spec.chain->mass})
            for (auto& number : *numbers) move(number);
        move(spec.chain->gravity);
    }
    if (spec.physical) {
        spec.physical->chain = *spec.chain;
        for (auto* numbers : {&spec.physical->center, &spec.physical->inertia})
            for (auto& number : *numbers) move(number);
    }
    if (spec.parts) {
        // places and velocities stay: constraints hold them
        for (auto& particle : spec.parts->particles) move(particle.mass);
        for (auto& force : spec.parts->forces) {
            if (auto* gravity = std::get_if<Gravity<Quad>>(&force)) move(gravity->g);
            if (auto* spring = std::get_if<Spring<Quad>>(&force)) move(spring->stiffness);
        }
    }
    return spec;
}

ReferenceTrajectory reference_trajectory(const MotionSpec& spec, long samples, double reach, double enough,
                                         const std::atomic<bool>& stop, double most_work) {
    Effort effort;
    auto own = own_trajectory(spec, samples, reach, enough, stop, effort);
    const auto bodies = static_cast<double>(spec.parts ? spec.parts->particles.size() : spec.chain->links());
    // series by a tape take as long as those of so many ideal links; where joints stick, steps are tiny
    constexpr double of_tape = 30;
    const bool sticks = spec.physical && !spec.physical->friction.coulomb.empty();
    const bool affordable =
        !sticks && static_cast<double>(effort.evaluations) * bodies * (spec.physical ? of_tape : 1) <= most_work;
    if (spec.precision == Precision::in_quad || !affordable) return own;
    auto wide = wide_trajectory(spec, samples, reach, enough, stop);
    // a run in double begins at numbers that were rounded once; that it errs by less may be chance
    for (std::size_t sample = 0; sample < wide.seen.size() && !own.uncertainty.empty(); ++sample)
        wide.uncertainty[sample] =
            own.uncertainty[std::min(sample, own.uncertainty.size() - 1)] / (caution * roundings_away);
    return wide;
}

double ErrorHistory::at(std::size_t sample) const {
    return sample < error.size() ? error[sample] : std::numeric_limits<double>::infinity();
}

long ErrorHistory::last_within(double allowed) const {
    return std::upper_bound(error.begin(), error.end(), allowed) - error.begin() - 1;
}

ErrorHistory error_history(const MotionSpec& spec, const ReferenceTrajectory& reference, double enough,
                           const std::atomic<bool>& stop) {
    auto watched = spec;
    watched.follows_turns = watched.wants_tension = false;
    const auto run = make_motion(watched);
    ErrorHistory history;
    double worst = 0;
    for (std::size_t sample = 0; sample < reference.seen.size(); ++sample) {
        throw_if_set(stop);
        try {
            if (sample > 0) run->advance(stop);
        } catch (const Error& fault) {
            if (fault.code() != ExitCode::method_failed) throw;
            if (worst <= enough) history.failure = fault.what();
            return history;
        }
        history.effort = run->effort();
        history.effort_samples = static_cast<long>(sample);
        if (worst > enough) continue;
        const double off = reference.distance(sample, run->observe()) + reference.uncertainty[sample];
        if (!std::isfinite(off)) return history;
        worst = std::max(worst, off);
        history.error.push_back(worst);
    }
    if (worst <= enough) history.failure = reference.failure;
    return history;
}

}  // namespace doppel
