#include "film/bounds.hpp"

#include "film/strips.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

namespace doppel {
namespace {

/// Whether the circle of the outstretched chains contains all that is drawn. Droplets are far away and not drawn.
bool has_circle(const Scene& scene) {
    const auto is_droplet = [](const PartSpec& force) { return force.kind == PartKind::droplet; };
    for (const auto* side : {&scene.preset.a, &scene.preset.b})
        if (!side->particles.empty() || !side->constraints.empty() || !std::ranges::all_of(side->forces, is_droplet))
            return false;
    return true;
}

/// The range with a margin of a tenth; includes zero.
Range padded(const Spread& seen) {
    const double low = seen.low, high = seen.high, width = high - low;
    if (!(width > 0) || !std::isfinite(width)) return {0, 1};
    return {low < 0 ? low - width / 10 : 0, high > 0 ? high + width / 10 : 0};
}

/// The nearest 1, 2 or 5 times a power of ten, rounded up or down.
double round_number(double value, bool up) {
    const double unit = std::pow(10, std::floor(std::log10(value)));
    double best = up ? 10 * unit : unit;
    for (const double step : {5.0, 2.0, 1.0})
        if (up ? step * unit >= value : step * unit <= value) {
            best = step * unit;
            if (!up) break;
        }
    return best;
}

/// The default axis of the distance: all values of the pair, at least one power of ten.
Range fitted_distance(const Spread& seen) {
    constexpr double decades = 1e60;  // the largest ratio of an axis's ends, whatever the masses and lengths
    if (seen.count == 0) return {1e-8, 1};
    const double maximum = std::clamp(seen.maximum, 1e-290, decades);
    const double high = round_number(1.02 * maximum, true);
    const double minimum = std::clamp(seen.minimum, high / decades, maximum);
    const double low =
        maximum / minimum < 100 ? round_number(0.98 * minimum, false) : std::pow(10, std::floor(std::log10(minimum)));
    return {std::clamp(low, high / decades, high / 10), high};
}

/// The default axis of an error, two to six powers of ten: from a tenth of its geometric mean to its largest value.
Range fitted_error(const Spread& seen) {
    if (seen.count == 0) return {1e-16, 1};
    const double high = std::pow(10, std::ceil(std::log10(1.02 * seen.maximum)));
    const double low = std::pow(10, std::floor(std::log10(seen.geometric_mean() / 10)));
    return {std::clamp(low, high * 1e-6, high * 1e-2), high};
}

}  // namespace

void Spread::add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
    if (!(value > 0) || !std::isfinite(value)) return;
    minimum = std::min(minimum, value);
    maximum = std::max(maximum, value);
    log_sum += std::log(value);
    ++count;
}

bool depends_on_motion(const Scene& scene) {
    const auto& video = scene.preset.video;
    const bool view = video.pendulums && (!has_circle(scene) || video.layout == Arrangement::phase);
    return view || std::any_of(video.strips.begin(), video.strips.end(),
                               [&](StripKind kind) { return !video.ranges[static_cast<std::size_t>(kind)]; });
}

void MotionBounds::add(const Scene& scene, const PairState& state, double start_distance) {
    const auto& video = scene.preset.video;
    const auto link = static_cast<std::size_t>(video.phase_link - 1);
    for (const auto* side : {&state.a, &state.b}) {
        for (const auto& bob : side->bobs) {
            left = std::min(left, bob.x);
            right = std::max(right, bob.x);
            bottom = std::min(bottom, bob.y);
            top = std::max(top, bob.y);
        }
        if (link < side->bobs.size()) fastest = std::max(fastest, std::abs(side->bobs[link].omega));
    }
    for (const auto kind : video.strips) {
        // a pair that starts equal has distances near zero at first; they are left out
        if (kind == StripKind::distance && !(start_distance > 0) && 50 * state.sample < scene.samples) continue;
        for (const auto& curve : strip_curves(kind, scene, state, start_distance))
            if (curve.value) strips[static_cast<std::size_t>(kind)].add(*curve.value);
    }
}

View fitted_view(const Scene& scene, const MotionBounds& seen) {
    if (has_circle(scene)) {
        double reach = std::max(scene.a.reach + scene.a.pivot_reach, scene.b.reach + scene.b.pivot_reach);
        for (const auto& member : scene.members)
            reach = std::max(reach, static_cast<double>(member.chain->reach()) + scene.a.pivot_reach);
        return {.width = 2 * reach, .height = 2 * reach};
    }
    double left = seen.left, right = seen.right, bottom = seen.bottom, top = seen.top;
    for (const auto* side : {&scene.a, &scene.b})
        for (const auto& line : side->lines)
            for (const auto* end : {&line.from, &line.to})
                if (const auto* place = std::get_if<Place<double>>(end)) {
                    left = std::min(left, (*place)[0] - line.radius);
                    right = std::max(right, (*place)[0] + line.radius);
                    bottom = std::min(bottom, (*place)[1] - line.radius);
                    top = std::max(top, (*place)[1] + line.radius);
                }
    const double minimum = 1e-3 * std::max({right - left, top - bottom, 1e-6});
    const View view{(left + right) / 2, (bottom + top) / 2, std::max(right - left, minimum),
                    std::max(top - bottom, minimum), false};
    return std::isfinite(view.width + view.height) ? view : View{.width = 2, .height = 2, .is_circle = false};
}

Range fitted_range(StripKind kind, const MotionBounds& seen) {
    const auto& spread = seen.strips[static_cast<std::size_t>(kind)];
    if (kind == StripKind::distance) return fitted_distance(spread);
    return is_logarithmic(kind) ? fitted_error(spread) : padded(spread);
}

}  // namespace doppel
