#pragma once

#include "scene/scene.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace doppel {

/// How numbers spread: from 0, and of the positive ones over powers of ten.
struct Spread {
    double low = 0, high = 0;
    double least = std::numeric_limits<double>::infinity(), most = 0;  // of what is positive and finite
    double log_sum = 0;                                                // of their natural logarithms
    long count = 0;

    void add(double value);
    double geometric_mean() const { return std::exp(log_sum / static_cast<double>(count)); }
};

/// How far a pair gets: what a picture needs to know that no formula gives.
struct MotionBounds {
    static constexpr double far = std::numeric_limits<double>::infinity();
    double left = far, right = -far, bottom = far, top = -far;  // m, of all bobs of both sides at all samples
    double fastest = 0;                                         // rad/s, of the link that a phase panel shows
    std::array<Spread, strip_kinds> strips{};                   // of those that the film has

    /// The next sample.
    void add(const Scene& scene, const PairState& state, double start_distance);
};

/// Whether the picture needs to know the bounds of the whole motion.
bool depends_on_motion(const Scene& scene);

/// The part of the plane that the pendulums' panels show, m.
struct View {
    double x = 0, y = 0;   // its centre
    double width, height;  // of a chain the circle that it reaches
    bool is_circle = true;
};

/// The circle that the outstretched chain reaches; of a mechanism, the places that it visits.
View fitted_view(const Scene& scene, const MotionBounds& seen);

/// The axis of a strip where the preset names none.
Range fitted_range(StripKind kind, const MotionBounds& seen);

}  // namespace doppel
