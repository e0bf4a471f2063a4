#include "analysis/reference.hpp"

#include "analysis/watched_motion.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

Observation end_in_quad(MotionSpec spec, const char* tolerance, const Rational& seconds,
                        const std::atomic<bool>& stop) {
    constexpr long parts = 64;  // an interruption is noticed between parts
    spec.precision = Precision::in_quad;
    spec.tolerance = parse_quad(tolerance);
    spec.sample_interval = *quotient(seconds, {parts, 1});
    const auto motion = make_motion(spec);
    for (long i = 0; i < parts; ++i) motion->advance(stop);
    return motion->observe();
}

/// The number of roundings, half an ulp each, by which perturbed() changes a number. A number is wrong by at
/// most one; the rest allows for the errors of the steps.
constexpr double perturbation_ulps = 24;

/// Light masses amplify the rounding errors of steps more than those of the start: by up to 5.5 times in trials.
constexpr double safety_factor = 9;

/// The same system with each number changed by some roundings of its precision.
MotionSpec perturbed(MotionSpec spec) {
    Quad change = perturbation_ulps / 2 *
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
        // positions and velocities stay, because constraints hold for them
        for (auto& particle : spec.parts->particles) move(particle.mass);
        for (auto& force : spec.parts->forces) {
            if (auto* gravity = std::get_if<Gravity<Quad>>(&force)) move(gravity->g);
            if (auto* spring = std::get_if<Spring<Quad>>(&force)) move(spring->stiffness);
        }
    }
    return spec;
}

/// Follows a motion and a neighbouring one sample by sample. Beyond the point where `safety_factor` times their
/// distance exceeds `max_error`, it continues until `further` times that time. The uncertainty is the largest distance
/// up to then.
ReferenceTrajectory compared(Motion& motion, Motion& beside, const ErrorMeasure& measure, long samples,
                             double max_error, double further, const std::atomic<bool>& stop) {
    ReferenceTrajectory all{measure};
    const auto advance = [&](Motion& one) { return advanced(one, stop, &all.failure); };
    long last = samples, sample = -1;
    double worst = 0;
    do {
        ++sample;
        all.seen.push_back(measure.coordinates(motion.observe()));
        const double distance = safety_factor * all.error_at(all.seen.size() - 1, beside.observe());
        all.uncertainty.push_back(worst = distance <= worst ? worst : distance);
        if (last == samples && !(distance <= max_error))
            last = std::min(samples, std::lround(further * static_cast<double>(sample)));
    } while (sample < last && advance(motion) && advance(beside));
    return all;
}

}  // namespace

std::vector<Quad> ErrorMeasure::coordinates(const Observation& seen) const {
    std::vector<Quad> all;
    const auto take = [&](const auto& bobs) {
        for (const auto& bob : bobs) {
            all.emplace_back(in_angles ? bob.theta : bob.x);
            if (!in_angles) all.emplace_back(bob.y);
        }
    };
    seen.exact.empty() ? take(seen.bobs) : take(seen.exact);
    return all;
}

double ErrorMeasure::distance(std::span<const Quad> one, std::span<const Quad> other) const {
    static const Quad turn = 2 * pi_of<Quad>();
    double worst = 0;
    for (std::size_t i = 0; i < one.size(); i += in_angles ? 1 : 2) {
        const Quad first = one[i] - other[i];
        double distance = std::abs(static_cast<double>(Quad(remainder(first, turn))));
        if (!in_angles) {
            const auto x = static_cast<double>(first), y = static_cast<double>(Quad(one[i + 1] - other[i + 1]));
            distance = std::sqrt(x * x + y * y) / reach;
        }
        if (!std::isfinite(distance)) return distance;
        worst = std::max(worst, distance);
    }
    return worst;
}

MotionSpec by_taylor_series(MotionSpec spec, const Quad& tolerance) {
    if (spec.model == Model::constraints) spec.model = Model::angles;
    spec.method = "taylor";
    spec.tolerance = tolerance;
    spec.stabilise = Stabilise::none;
    spec.follows_turns = spec.wants_tension = false;
    return spec;
}

Reference reference_end(MotionSpec spec, const Rational& seconds, const std::atomic<bool>& stop) {
    spec = by_taylor_series(spec, 0);
    const bool is_plain = spec.model == Model::angles && !spec.physical;
    const ErrorMeasure measure{spec.chain.has_value()};
    Reference reference{end_in_quad(spec, "1e-32", seconds, stop), 0, NAN};
    for (std::size_t i = 0; is_plain && i < spec.chain->links(); ++i) {
        constexpr double perturbation = 1e-14;  // rad: far above the tolerance, yet its growth remains small
        auto beside = spec;
        beside.chain->angle[i] += Quad(perturbation);
        const double grown = measure.distance(end_in_quad(beside, "1e-24", seconds, stop), reference.end);
        reference.sensitivity = std::fmax(reference.sensitivity, grown / perturbation);
    }
    if (is_plain) spec.model = Model::constraints;
    reference.disagreement =
        measure.distance(reference.end, end_in_quad(spec, is_plain ? "1e-32" : "1e-30", seconds, stop));
    // quad at its tolerance reaches some 1e-30 of the sensitivity; the sensitivity of a mechanism is unknown
    const double allowed = is_plain ? 1e-26 * std::max(reference.sensitivity, 1.0) : 1e-15;
    if (!(reference.disagreement <= allowed))
        throw method_failed(
            "no reference: two runs in quad differ by {:.2g} {} after {} s; the limit is {:.2g}; the motion is too "
            "chaotic for this duration",
            reference.disagreement, measure.in_angles ? "rad" : "m", seconds.value(), allowed);
    return reference;
}

ReferenceTrajectory reference_trajectory(const MotionSpec& spec, long samples, double reach, double max_error,
                                         const std::atomic<bool>& stop, double max_work) {
    const ErrorMeasure measure{spec.chain.has_value(), reach};
    const auto made = [](const MotionSpec& of, const char* tolerance) {
        return make_motion(by_taylor_series(of, parse_quad(tolerance)));
    };
    const bool quad = spec.precision == Precision::in_quad;
    const auto fine = made(spec, quad ? "1e-33" : "1e-15");
    auto own = compared(*fine, *made(perturbed(spec), quad ? "3e-33" : "3e-15"), measure, samples, max_error, 1, stop);
    if (!std::isfinite(own.uncertainty.back())) own.seen.pop_back(), own.uncertainty.pop_back();
    const auto bodies = static_cast<double>(spec.parts ? spec.parts->particles.size() : spec.chain->links());
    // a taped series takes as long as one of so many ideal links; joints with Coulomb friction need tiny steps
    constexpr double of_tape = 30;
    const double work = static_cast<double>(fine->effort().evaluations) * bodies * (spec.physical ? of_tape : 1);
    if (quad || work > max_work || (spec.physical && !spec.physical->friction.coulomb.empty())) return own;
    auto in_quad = spec;
    in_quad.precision = Precision::in_quad;
    constexpr double further =
        1.25;  // times as long as a run in double is useful; quad at that tolerance reaches further by this factor
    auto wide = compared(*made(in_quad, "1e-20"), *made(spec, "1e-15"), measure, samples, safety_factor * max_error,
                         further, stop);
    wide.is_wider = true;
    // a run in double starts from rounded numbers; a smaller error may be coincidence
    wide.uncertainty.assign(wide.seen.size(), 0);
    for (std::size_t sample = 0; sample < wide.seen.size() && !own.uncertainty.empty(); ++sample)
        wide.uncertainty[sample] =
            own.uncertainty[std::min(sample, own.uncertainty.size() - 1)] / (safety_factor * perturbation_ulps);
    return wide;
}

ErrorHistory error_history(const MotionSpec& spec, const ReferenceTrajectory& reference, double max_error,
                           const std::atomic<bool>& stop) {
    auto watched = spec;
    watched.follows_turns = watched.wants_tension = false;
    const auto run = make_motion(watched);
    ErrorHistory history;
    std::string why;
    double worst = 0;
    for (std::size_t sample = 0; sample < reference.seen.size(); ++sample) {
        if (sample > 0 && !advanced(*run, stop, &why)) {
            if (worst <= max_error) history.failure = why;
            return history;
        }
        history.effort = run->effort();
        history.effort_samples = static_cast<long>(sample);
        if (worst > max_error) continue;
        const double error = reference.error_at(sample, run->observe()) + reference.uncertainty[sample];
        if (!std::isfinite(error)) return history;
        worst = std::max(worst, error);
        history.error.push_back(worst);
    }
    if (worst <= max_error) history.failure = reference.failure;
    return history;
}

}  // namespace doppel
