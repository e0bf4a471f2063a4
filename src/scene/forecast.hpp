#pragma once

#include "analysis/exponent.hpp"
#include "scene/scene.hpp"

#include <optional>
#include <string>

namespace doppel {

/// What can be known of a side's motion before it is run. Errors are those of angles, rad, the largest of all; of what
/// hangs in no chain, of places in units of its size.
struct Forecast {
    /// For how long runs of this precision can be right, within half a rad, s. About: no bound.
    struct Limit {
        double from, to;  // of several runs; or what the exponent, and how it varies, makes of their errors at the end
    };

    enum class Kind {
        regular,
        chaotic,
        unstable
    };  // unstable: released at an equilibrium that errors grow from; no chaos

    double error;                      // at `error_s`
    double error_s;                    // the end, or where the run is off by half a rad
    std::optional<Exponent> exponent;  // of a chain that is not too long
    Kind kind = Kind::regular;         // where there is an exponent
    std::optional<Limit> limit;        // may lie beyond the end
};

/// By the run beside the reference (analysis/reference_trajectory.hpp), and runs by Taylor series as fine as the precision
/// allows, each of which rounds in its own way.
/// Errors  exit 130 soon after `stop` is set; exit 3 where the method fails at once.
Forecast forecast_of(const Scene& scene, const Side& side, const std::atomic<bool>& stop);

/// "error above half a rad from 11 s on".
std::string error_words(const Side& side, double from_s);

/// Such words of a side whose run is off at a sample up to `last`, or whose accuracy does not hold so far; nothing where
/// neither is. Errors as forecast_of().
std::optional<std::string> early_error(const Scene& scene, const Side& side, long last, const std::atomic<bool>& stop);

}  // namespace doppel
