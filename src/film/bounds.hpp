#pragma once

#include "scene/scene.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace doppel {

/// The range of numbers: of all of them, and of the positive ones on a logarithmic scale.
struct Spread {
    double low = 0, high = 0;
    double minimum = std::numeric_limits<double>::infinity(), maximum = 0;  // of the positive finite numbers
    double log_sum = 0;                                                     // of their natural logarithms
    long count = 0;

    void add(double value);
    double geometric_mean() const { return std::exp(log_sum / static_cast<double>(count)); }
};

/// The ranges of a whole motion, which a picture needs and no formula gives.
struct MotionBounds {
    static constexpr double far = std::numeric_limits<double>::infinity();
    double left = far, right = -far, bottom = far, top = -far;  // m, over all bobs of both sides and all samples
    double fastest = 0;                                         // rad/s, of the link shown in a phase panel
    std::array<Spread, strip_kinds> strips{};                   // for the strips of the film

    /// Adds the next sample.
    void add(const Scene& scene, const PairState& state, double start_distance);
};

/// Whether the picture requires the bounds of the whole motion.
bool depends_on_motion(const Scene& scene);

/// The part of the plane shown in the pendulums' panels, m.
struct View {
    double x = 0, y = 0;   // centre
    double width, height;  // for a chain, those of the circle it can reach
    bool is_circle = true;
};

/// For a chain, the circle that it can reach when outstretched; for a mechanism, the area that it visits.
View fitted_view(const Scene& scene, const MotionBounds& seen);

/// The axis of a strip if the preset sets none.
Range fitted_range(StripKind kind, const MotionBounds& seen);

}  // namespace doppel
