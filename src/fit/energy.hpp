#pragma once

#include "fit/shooting.hpp"

namespace doppel {

/// What viscous friction takes from the swing in the mean, as a share of its energy of motion, 1/s. Less than 0: the
/// energy grows.
struct EnergyLoss {
    double share = 0, standard_error = 0;
    double rms = 0;  // rad, of the fit that says so
};

/// From a fit of viscous friction that may be negative, of a lag and scales, which could look like it. `start` is a fit
/// of the track with viscous friction. The standard error allows for residuals that are not noise. Throws Error: 130,
/// exit 3 where no motion stays finite.
EnergyLoss energy_loss(const FitJob& job, const Fit& start);

}  // namespace doppel
