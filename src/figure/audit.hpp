#pragma once

#include "analysis/difference.hpp"
#include "analysis/twins.hpp"
#include "figure/experiment.hpp"
#include "scene/preset.hpp"

#include <functional>

namespace doppel {

enum class Verdict { holds, fails, misprinted };
struct Judgement {
    Verdict verdict;
    std::string found;  // in words
};

/// A claim of the study (Kao 2022), its measurement, and what the numbers then say.
struct Claim {
    std::string_view key;    // for the manifest
    std::string_view words;  // the claim, in short
    std::size_t numbers;     // that it comes to
    std::function<TrialNumbers(const std::atomic<bool>& stop)> measure;
    std::function<Judgement(const TrialNumbers& numbers)> judge;
};

/// All of them, in the order of the study.
std::span<const Claim> claims();

// The study's releases, in its units, and what is measured of them.

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
std::vector<double> averages(const std::vector<SideTwins>& sides, const MotionSpec& method,
                             const std::atomic<bool>& stop);

}  // namespace doppel
