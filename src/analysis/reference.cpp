#include "analysis/reference.hpp"

#include "analysis/difference.hpp"
#include "base/error.hpp"

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
    const bool mechanism = spec.model == Model::mechanism;
    Reference reference{end_of(spec, mechanism ? Model::mechanism : Model::angles, finer, seconds, stop), 0};
    const auto other = mechanism ? end_of(spec, Model::mechanism, fine, seconds, stop)
                                 : end_of(spec, Model::constraints, finer, seconds, stop);
    reference.disagreement = spec.chain ? angle_error(reference.end, other) : place_error(reference.end, other);
    if (!(reference.disagreement <= allowed))
        throw method_failed(
            "no reference: two computations in quad differ by {:.2g} {} after {} s, where {:.2g} is allowed; the "
            "motion "
            "is too chaotic for so long a time",
            reference.disagreement, spec.chain ? "rad" : "m", seconds.value(), allowed);
    return reference;
}

}  // namespace doppel
