#pragma once

#include "integrate/motion.hpp"

namespace doppel {

/// How a motion ends, to more digits than double has.
struct Reference {
    Bobs<Quad> end;       // angles up to whole turns
    double disagreement;  // of the two computations: of angles, rad, or of places, m, where there are none
};

/// The end after `seconds`, by Taylor series in quad, twice: a chain in angles and as particles on rods, which have no
/// equation in common; a mechanism at two tolerances, and so orders. Of `spec` only what moves, and whether it is a
/// mechanism, matters.
///
/// Throws Error: exit 3 where the two differ by more than `allowed`, or a step cannot be made; exit 130 soon after
/// `stop` is set.
Reference reference_end(MotionSpec spec, const Rational& seconds, double allowed, const std::atomic<bool>& stop);

}  // namespace doppel
