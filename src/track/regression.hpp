#pragma once

#include "track/track.hpp"

#include <vector>

namespace doppel {

/// Angle, rate and acceleration of a link at one moment, from a polynomial through the samples around it.
struct LinkEstimate {
    double angle = 0, rate = 0, acceleration = 0;
    double rms = 0;  // of how far the samples are from it, rad
};
using Glimpse = std::array<LinkEstimate, 2>;

/// At a time on the piece's clock: by the longest window whose polynomial leaves noise alone; the longest of all is as long
/// as the noise asks for, or `longer` times that.
Glimpse estimate_at(const Track& track, const TrackPiece& piece, double time_s, double longer = 1);

/// At moments half a window apart.
std::vector<Glimpse> estimates_of(const Track& track, const std::atomic<bool>& stop, double longer = 1);

/// The equations of motion, which are linear in the parameters, fitted to glimpses: no start needed, but accelerations
/// are noisy and so the result is biased. What is unexplained says how well angles taken this way obey any double
/// pendulum at all.
struct Regression {
    std::array<double, 4> ratios{};  // A/B, C/B; D1/B, D2/B, 1/s²
    double unexplained = 1;          // share of the squared forces, of both equations: 0 for noiseless angles
    bool is_physical = false;
};
Regression regress(const std::vector<Glimpse>& glimpses);

}  // namespace doppel
