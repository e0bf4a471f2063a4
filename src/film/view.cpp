#include "film/view.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// With a tenth of air; zero is on it.
Range airy(const Range& seen) {
    const double low = std::min(seen.low, 0.0), high = std::max(seen.high, 0.0), width = high - low;
    if (!(width > 0) || !std::isfinite(width)) return {0, 1};
    return {low < 0 ? low - width / 10 : 0, high > 0 ? high + width / 10 : 0};
}

/// The distance axis where the preset names none: from the decade of the start to beyond two strangers of the same
/// energy.
Range fitted_distance(const Scene& scene, const std::optional<Survey>& seen) {
    const auto start = PairRun(scene).next(std::atomic<bool>(false));
    const auto& side = scene.a;
    const double available = start.a.energy + side.energy_unit / 2;  // J, above hanging at rest
    const double speed2 = 2 * available / *std::min_element(side.mass.begin(), side.mass.end());
    const double apart2 =
        std::min(2 * side.reach * side.reach, 2 * available / (side.mass[0] * side.gravity) * side.reach);
    constexpr double decades = 1e60;  // the most an axis spans, whatever the masses and lengths
    const bool is_mechanism = scene.a.motion.model == Model::mechanism || scene.b.motion.model == Model::mechanism;
    const double most = is_mechanism && seen ? seen->largest_distance : std::sqrt(speed2 + apart2),
                 high = std::isfinite(most) ? std::clamp(most, 1e-12, decades) : decades;
    const double low = start.distance > 0 ? start.distance / 2 : high * 1e-8;
    const double top = std::pow(10, std::ceil(2 * std::log10(1.5 * high)) / 2);  // half a decade of air
    return {std::clamp(std::pow(10, std::floor(std::log10(low))), top / decades, top / 10), top};
}

/// From the least error that shows to all there is.
Range fitted_error(const Scene& scene) {
    const bool low_order = scene.a.method.order == 1 || scene.b.method.order == 1;
    return low_order ? Range{1e-8, 1} : Range{1e-16, 1};
}

}  // namespace

/// The circle that the outstretched chain reaches; of a mechanism, the places that it visits.
View fitted_view(const Scene& scene, const std::optional<Survey>& seen) {
    if (scene.a.motion.model != Model::mechanism && scene.b.motion.model != Model::mechanism) {
        const double across = 2 * std::max(scene.a.reach, scene.b.reach);
        return {.width = across, .height = across};
    }
    double left = seen->left, right = seen->right, bottom = seen->bottom, top = seen->top;
    for (const auto* side : {&scene.a, &scene.b})
        for (const auto& line : side->lines)
            for (const auto* end : {&line.from, &line.to})
                if (const auto* place = std::get_if<Place<double>>(end)) {
                    left = std::min(left, (*place)[0] - line.radius);
                    right = std::max(right, (*place)[0] + line.radius);
                    bottom = std::min(bottom, (*place)[1] - line.radius);
                    top = std::max(top, (*place)[1] + line.radius);
                }
    const double least = 1e-3 * std::max({right - left, top - bottom, 1e-6});
    const View view{(left + right) / 2, (bottom + top) / 2, std::max(right - left, least),
                    std::max(top - bottom, least), false};
    return std::isfinite(view.width + view.height) ? view : View{.width = 2, .height = 2, .is_circle = false};
}

Range fitted_range(StripKind kind, const Scene& scene, const std::optional<Survey>& seen) {
    switch (kind) {
        case StripKind::distance:
            return fitted_distance(scene, seen);
        case StripKind::exponent:
            return airy(seen ? seen->exponent : Range{});
        case StripKind::rod_force:
            return airy(seen ? seen->rod_force : Range{});
        case StripKind::energy:
        case StripKind::rod_error:
            break;
    }
    return fitted_error(scene);
}

}  // namespace doppel
