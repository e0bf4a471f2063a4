#pragma once

#include "scene/scene.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace doppel {

/// How positive numbers spread over powers of ten.
struct Spread {
    double least = std::numeric_limits<double>::infinity(), most = 0;
    double log_sum = 0;  // of natural logarithms
    long count = 0;

    /// Leaves out what is 0, or not finite.
    void add(double value);
    double geometric_mean() const { return std::exp(log_sum / static_cast<double>(count)); }
};

/// How far a pair gets, from a run without pictures: what a picture needs to know that no formula gives.
struct MotionBounds {
    double left, right, bottom, top;  // m, of all bobs of both sides at all samples
    Spread distance;                  // state space; of twins that start alike, after a fiftieth of the scene
    Spread energy_error, rod_error;   // of both sides; of the potential range; m
    double fastest = 0;               // rad/s, of the link that a phase panel shows
    Range exponent{0, 0};             // 1/s, so far
    Range rod_force{0, 0};            // N, where it was asked for
    std::array<Range, 2> energies{{{0, 0}, {0, 0}}};  // J, kinetic, potential and total of each side
    Range total_energy{0, 0};                         // J, of both
    Range angles{0, 0}, rates{0, 0};                  // degrees, degrees/s, of all links that strips show
};

/// Of the whole motion, whichever frames are drawn: they are the same pixels alone as in the film. Nothing where the
/// picture needs none of it. Ends without an error where a side breaks down; throws Error (exit 130) soon after `stop` is set.
std::optional<MotionBounds> motion_bounds(const Scene& scene, const std::atomic<bool>& stop);

/// ln(d/d0) / t, 1/s: nothing in the first twentieth of the scene, when it says nothing yet, or where a distance is 0.
std::optional<double> exponent_so_far(const Scene& scene, const PairState& state, double start_distance);

/// Of `count` links or rods in a strip: all of few, the first and the last of many.
std::vector<std::size_t> shown_links(std::size_t count);

/// The part of the plane that the pendulums' panels show, m.
struct View {
    double x = 0, y = 0;   // its centre
    double width, height;  // of a chain the circle that it reaches
    bool is_circle = true;
};

/// The circle that the outstretched chain reaches; of a mechanism, the places that it visits.
View fitted_view(const Scene& scene, const std::optional<MotionBounds>& seen);

/// The axis of a strip where the preset names none.
Range fitted_range(StripKind kind, const std::optional<MotionBounds>& seen);

}  // namespace doppel
