#pragma once

#include "physics/mechanism_assembly.hpp"

#include <vector>

namespace doppel {

/// One thing to draw. A rod and a spring go from end to end; an anchor is at `from`; a straight slot goes from `from`
/// to `to`; a circular one has its centre at `from`.
struct MechanismLine {
    enum class Kind { rod, spring, anchor, slot_line, slot_circle };
    Kind kind;
    End<double> from, to;
    double radius = 0;  // m, of a circular slot
};

/// What a picture needs besides the particles: the constraints in their order, then the springs in theirs.
std::vector<MechanismLine> lines_of(const Assembly<double>& assembly);

}  // namespace doppel
