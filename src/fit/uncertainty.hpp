#pragma once

#include "fit/shooting.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {

/// How well the fitted parameters are told, and what its residuals look like.
struct Uncertainty {
    ParameterMatrix covariance = ParameterMatrix::Zero();
    bool is_white = true;               // residuals like noise: each independent of those before
    std::array<double, 2> neighbour{};  // correlation of successive residuals, by link
    std::array<double, 2> memory_s{};   // after which the correlation has fallen below 1/e
    double inflation = 1;               // of standard errors against white residuals; 1 where they are

    /// Of a parameter; 0 where it is not fitted.
    double standard_error(std::size_t k) const { return std::sqrt(std::max(covariance(k, k), 0.0)); }
};

/// From the curvature of the loss where the residuals are white (Ljung & Box over ten lags, at 99.9 %); else from how
/// much the slopes of stretches longer than the residuals' memory scatter (a sandwich), and no less than that.
///
/// Throws Error (exit 130).
/// Source  Huber, Robust Statistics, §7.6; Newey & West 1987
Uncertainty uncertainty_of(const FitJob& job, Fit fit);

/// What viscous friction takes from the swing in the mean, as a share of its energy of motion, 1/s. Less than 0: the
/// energy grows.
struct EnergyLoss {
    double share = 0, standard_error = 0;
    double rms = 0;  // rad, of the fit that says so
};

/// From a fit of viscous friction that may be negative, of a lag and scales, which could look like it. `start` is a fit
/// of the track with viscous friction. The standard error allows for residuals that are not noise. Nothing where no motion
/// stays finite. Throws Error (exit 130).
std::optional<EnergyLoss> energy_loss(const FitJob& job, Fit start);

}  // namespace doppel
