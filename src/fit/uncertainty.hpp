#pragma once

#include "fit/shooting.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {

/// Uncertainty of the fitted parameters, and properties of the residuals.
struct Uncertainty {
    ParameterMatrix covariance = ParameterMatrix::Zero();
    bool is_white = true;               // the residuals are white noise
    std::array<double, 2> neighbour{};  // correlation of successive residuals, for each link
    std::array<double, 2> memory_s{};   // time after which the correlation is below 1/e
    double inflation = 1;               // of standard errors, relative to white residuals; 1 if they are white

    /// Of a parameter; 0 if it is not fitted.
    double standard_error(std::size_t k) const { return std::sqrt(std::max(covariance(k, k), 0.0)); }
};

/// From the curvature of the loss if the residuals are white (Ljung & Box over ten lags, at 99.9 %). Otherwise from the
/// scatter of the slopes of stretches longer than the residuals' memory (sandwich estimate), but at least the former.
///
/// Throws Error (exit 130).
/// Source  Huber, Robust Statistics, §7.6; Newey & West 1987
Uncertainty uncertainty_of(const FitJob& job, Fit fit);

/// Mean energy loss by viscous friction relative to the kinetic energy, 1/s. Negative: the energy grows.
struct EnergyLoss {
    double share = 0, standard_error = 0;
    double rms = 0;  // rad, of the underlying fit
};

/// From a fit with viscous friction that may be negative, and with lag and scales, which could have a similar effect.
/// `start` is a fit of the track with viscous friction. The standard error includes correlated residuals. Nothing if no
/// motion stays finite. Throws Error (exit 130).
std::optional<EnergyLoss> energy_loss(const FitJob& job, Fit start);

}  // namespace doppel
