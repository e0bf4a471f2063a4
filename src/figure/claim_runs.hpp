#pragma once

#include "analysis/twins.hpp"
#include "scene/preset.hpp"

#include <atomic>
#include <utility>
#include <vector>

namespace doppel::study {

// The study's releases, in its units, and what is measured of them (figure/claims.hpp).

using SideTwins = std::pair<SideSpec, SideSpec>;

/// Unit masses and lengths, from rest, by the study's Euler steps.
SideSpec side(std::vector<Quad> angle_deg, ModelChoice model = ModelChoice::angles);
/// The same by Taylor series in quad.
SideSpec exactly(SideSpec spec);
/// The same on the general mechanism, with the study's droplet or without.
SideSpec with_droplet(SideSpec spec, bool droplet);

/// Twins 0.003° apart in the upper link.
SideTwins angle_twins(int theta1_deg, int theta2_deg = 0);
/// Twins of mass ratio `ratio` and 0.01 more.
SideTwins mass_twins(int theta1_deg, int theta2_deg, double ratio);

/// The distances of a pair at samples 0 … count.
std::vector<double> distances(const SideSpec& a, const SideSpec& b, long count, const std::atomic<bool>& stop);
/// The study's averages over 25 s.
std::vector<double> averages(const std::vector<SideTwins>& sides, const TwinSide& method,
                             const std::atomic<bool>& stop);

}  // namespace doppel::study
