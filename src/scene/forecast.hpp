#pragma once

#include "analysis/exponent.hpp"
#include "scene/scene.hpp"

#include <optional>
#include <string>

namespace doppel {

/// The expected accuracy of a side, without running the scene. Errors are the largest of all angles, rad; for
/// mechanisms, of positions in units of the system's size.
struct Forecast {
    /// The predictability limit of this precision: the time at which any run has an error of half a radian, s. An
    /// estimate, not a bound.
    struct Limit {
        double from,
            to;  // from several runs; or extrapolated from their final errors with the exponent and its variation
    };

    enum class Kind { regular, chaotic, unstable };  // unstable: released at an unstable equilibrium; not chaotic

    double error;                           // the largest up to `error_s`
    double error_s;                         // the end; or where the error exceeds half a radian, or is not known beyond
    std::optional<Exponent> exponent = {};  // for chains that are not too long
    Kind kind = Kind::regular;              // if there is an exponent
    std::optional<Limit> limit = {};        // may be after the end

    bool is_off() const;  // the error exceeds half a radian at `error_s`
};

/// From a run compared with the reference (analysis/reference_trajectory.hpp), and from runs by Taylor series at the
/// finest settings of the precision, each with different rounding. Throws Error: exit 130 soon after `stop` is set;
/// exit 3 if the method fails in the first step.
Forecast forecast_of(const Scene& scene, const Side& side, const std::atomic<bool>& stop);

/// For example "error above half a rad from 11 s on".
std::string error_words(const Side& side, double from_s);

/// Such words if the side's run diverges before sample `last`, or its accuracy is not kept up to there; otherwise
/// nothing. Throws as forecast_of().
std::optional<std::string> early_error(const Scene& scene, const Side& side, long last, const std::atomic<bool>& stop);

}  // namespace doppel
