#pragma once

#include "film/survey.hpp"

#include <optional>

namespace doppel {

/// The part of the plane that the pendulums' panels show, m.
struct View {
    double x = 0, y = 0;   // its centre
    double width, height;  // of a chain the circle that it reaches
    bool is_circle = true;
};

/// The circle that the outstretched chain reaches; of a mechanism, the places that it visits.
View fitted_view(const Scene& scene, const std::optional<Survey>& seen);

/// The axis of a strip where the preset names none.
Range fitted_range(StripKind kind, const Scene& scene, const std::optional<Survey>& seen);

}  // namespace doppel
