#pragma once

#include "analysis/exponent.hpp"
#include "scene/scene.hpp"

#include <optional>

namespace doppel {

/// What can be known of a side's motion before it is run. Errors are those of angles, rad, the largest of all; of what
/// hangs in no chain, of places in units of its size.
struct Outlook {
    double error;                      // at `error_s`
    double error_s;                    // the end, or where the run is off by half a rad
    std::optional<Exponent> exponent;  // of a chain that is not too long
    std::optional<double> horizon_s;   // from when on no run of this precision can be right by half a rad; may lie
                                       // beyond the end
};

/// By a run beside one by Taylor series as fine as the precision allows, and one of that from a start some roundings
/// away. Errors  exit 130 soon after `stop` is set; exit 3 where the method breaks down at once.
Outlook outlook(const Scene& scene, const Side& side, const std::atomic<bool>& stop);

}  // namespace doppel
