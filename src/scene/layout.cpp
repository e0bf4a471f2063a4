#include "scene/layout.hpp"

#include "picture/font.hpp"
#include "scene/survey.hpp"
#include "scene/wording.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// What the panels show, m.
struct View {
    double x = 0, y = 0;   // its centre
    double width, height;  // of a chain the circle that it reaches
    bool is_circle = true;
};

/// The circle that the outstretched chain reaches; of a mechanism, the places that it visits.
View fitted_view(const Scene& scene, const std::optional<Survey>& seen) {
    if (!seen) {
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
    const double most = seen ? seen->largest_distance : std::sqrt(speed2 + apart2),
                 high = std::isfinite(most) ? std::clamp(most, 1e-12, decades) : decades;
    const double low = start.distance > 0 ? start.distance / 2 : high * 1e-8;
    const double top = std::pow(10, std::ceil(2 * std::log10(1.5 * high)) / 2);  // half a decade of air
    return {std::clamp(std::pow(10, std::floor(std::log10(low))), top / decades, top / 10), top};
}

Range fitted_energy(const Scene& scene) {
    const bool low_order = scene.a.method.order == 1 || scene.b.method.order == 1;
    return low_order ? Range{1e-8, 1} : Range{1e-16, 1};
}

/// The places that a mechanism visits as large as the panel allows, below the words.
void place_mechanism(PanelLayout& panel, float words_bottom, const View& view, float margin) {
    const Area& area = panel.area;
    const float width = area.width() - 2 * margin, height = area.bottom - words_bottom - 2 * margin;
    panel.center = {(area.left + area.right) / 2, (words_bottom + area.bottom) / 2};
    panel.center_x = view.x;
    panel.center_y = view.y;
    panel.px_per_m = std::min(width / static_cast<float>(view.width), height / static_cast<float>(view.height));
}

/// The circle of the outstretched chain as large as the panel allows, beside or below the words in its top left corner.
void place_pendulum(PanelLayout& panel, float words_right, float words_bottom, const View& view, float margin) {
    const Area& area = panel.area;
    float radius = std::min(area.width(), area.height()) / 2 - margin;
    float x = (area.left + area.right) / 2;
    float y = (area.top + area.bottom) / 2;
    const auto clear = [&] {
        const float dx = std::max(0.0f, x - words_right), dy = std::max(0.0f, y - words_bottom);
        return dx * dx + dy * dy >= radius * radius;
    };
    while (!clear() && x + radius + margin < area.right) x += 1;
    const float least = radius / 2;
    while (!clear() && radius > least) {
        radius -= 1;
        y = area.bottom - margin - radius;
    }
    panel.center = {x, y};
    panel.center_x = view.x;
    panel.center_y = view.y;
    panel.px_per_m = 2 * radius / static_cast<float>(view.width);
}

StripLayout strip(const Layout& layout, const Scene& scene, float top, float bottom, const Range& range) {
    const Area area{layout.page.left + std::round(84 * layout.text), std::round(top), layout.page.right,
                    std::round(bottom)};
    return {area,
            {.low = 0, .high = scene.time(scene.samples), .from = area.left, .to = area.right},
            {.low = range.low, .high = range.high, .from = area.bottom, .to = area.top, .logarithmic = true}};
}

}  // namespace

Point PanelLayout::at(double x_m, double y_m) const {
    const auto px = [&](double m) { return static_cast<float>(std::clamp(px_per_m * m, -1e6, 1e6)); };
    return {center.x + px(x_m - center_x), center.y - px(y_m - center_y)};
}

Layout make_layout(const Scene& scene) {
    const auto& video = scene.preset.video;
    const auto width = static_cast<float>(video.size.width), height = static_cast<float>(video.size.height);
    Layout layout;
    layout.unit = std::min(width / 1920, height / 1080);
    layout.text = std::max(layout.unit, 0.45f);
    const float u = layout.unit, t = layout.text;
    layout.page = {std::round(60 * u), std::round(28 * u), width - std::round(60 * u), height - std::round(26 * u)};
    layout.title = scene.preset.title;
    layout.subtitle = scene_words(scene);
    std::optional<Survey> seen;
    if (scene.a.motion.model == Model::mechanism || scene.b.motion.model == Model::mechanism) seen = survey(scene);

    // from the bottom up: words of the time axis, strips, panels; the header has what is left
    const float header = layout.page.top + 96 * t;
    float bottom = layout.page.bottom;
    const bool strips = video.distance || video.energy;
    if (strips) {
        layout.time_labels = bottom - 4 * t;
        bottom -= 38 * t;
        const float room = bottom - header;
        const float energy = video.energy ? (video.pendulums ? 0.11f : 0.3f) * room : 0;
        const float distance = video.distance ? (video.pendulums ? 0.24f : 0.7f) * room : 0;
        const float caption = 40 * t;  // a line of words above each strip
        const float gap = video.energy && video.distance ? caption : 0;
        const float all = video.pendulums ? energy + distance + gap : room - caption;
        const float energy_top = video.distance ? bottom - energy : bottom - all;
        if (video.energy)
            layout.energy = strip(layout, scene, energy_top, bottom, video.energy_range.value_or(fitted_energy(scene)));
        if (video.distance)
            layout.distance = strip(layout, scene, bottom - all, bottom - energy - gap,
                                    video.distance_range.value_or(fitted_distance(scene, seen)));
        bottom -= all + caption + 4 * u;
    }
    if (!video.pendulums) return layout;

    const auto words = side_words(scene);
    const auto view = fitted_view(scene, seen);
    const float gap = std::round(24 * u), panel_width = std::floor((layout.page.width() - gap) / 2);
    layout.panels.emplace();
    for (std::size_t side = 0; side < 2; ++side) {
        auto& panel = (*layout.panels)[side];
        const float left = layout.page.left + static_cast<float>(side) * (panel_width + gap);
        panel.area = {left, std::round(header), left + panel_width, std::round(bottom)};
        panel.heading = words[side].heading;
        panel.note = words[side].note;
    }
    // both alike, so that the pendulums are drawn to one scale
    float words_width = 0;
    for (const auto& panel : *layout.panels)
        words_width =
            std::max({words_width, text_width(panel.heading, 31 * t, Weight::bold), text_width(panel.note, 21 * t)});
    for (auto& panel : *layout.panels) {
        const float words_bottom = panel.area.top + (panel.note.empty() ? 60 : 92) * t;
        if (view.is_circle)
            place_pendulum(panel, panel.area.left + 28 * u + words_width + 8 * u, words_bottom, view, 30 * u);
        else
            place_mechanism(panel, words_bottom, view, 40 * u);
    }
    const float px_per_m = layout.panels->front().px_per_m;
    const float radius = px_per_m * static_cast<float>(std::max(view.width, view.height)) / 2;
    layout.reach = view.is_circle ? radius : 0;
    // the bobs of a long chain do not hide its rods
    const float link = view.is_circle ? radius / static_cast<float>(scene.a.mass.size()) : radius;
    const float size = view.is_circle ? 1 : 0.6f;  // a mechanism has more to show
    layout.rod_radius = std::max(std::min(0.0115f * size * radius, 0.2f * link), 0.8f);
    layout.bob_radius = std::max(std::min(0.068f * size * radius, 0.3f * link), 1.6f * layout.rod_radius);
    if (link < 0.1f * radius) layout.last_bob_radius = std::max(layout.bob_radius, 0.02f * radius);
    return layout;
}

}  // namespace doppel
