#pragma once

#include "track/track.hpp"

#include <vector>

namespace doppel {

/// Angle, rate and acceleration of a link at one time, from a polynomial through the samples around it.
struct LinkEstimate {
    double angle = 0, rate = 0, acceleration = 0;
    double rms = 0;  // deviation of the samples from it, rad
};
using LinkEstimates = std::array<LinkEstimate, 2>;

/// The estimates at a time on the piece's clock, from the longest window whose polynomial leaves only noise. The
/// longest window tried depends on the noise, times `longer`.
LinkEstimates estimate_at(const Track& track, const TrackPiece& piece, double time_s, double longer = 1);

/// Estimates at times half a window apart.
std::vector<LinkEstimates> estimates_of(const Track& track, const std::atomic<bool>& stop, double longer = 1);

/// The equations of motion, which are linear in the parameters, fitted to local estimates. No initial values are
/// needed, but accelerations are noisy, so the result is biased. The unexplained part shows how well the angles agree
/// with the equations of any double pendulum.
struct Regression {
    std::array<double, 4> ratios{};  // A/B, C/B; D1/B, D2/B, 1/s²
    double unexplained = 1;  // unexplained share of the squared forces of both equations: 0 for noiseless angles
    bool is_physical = false;
};
Regression regress(const std::vector<LinkEstimates>& estimates);

}  // namespace doppel
