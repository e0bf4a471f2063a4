#include "film/layout.hpp"

#include "film/bounds.hpp"
#include "image/color.hpp"
#include "numeric/state.hpp"
#include "render/font.hpp"
#include "scene/captions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

Theme themed(const VideoSpec& video) {
    auto theme = *std::find_if(themes.begin(), themes.end(), [&](const auto& t) { return t.name == video.theme; });
    for (std::size_t i = 0; i < color_names.size(); ++i)
        if (video.colors[i]) theme.*color_names[i].member = *video.colors[i];
    if (video.side_colors) theme.sides = *video.side_colors;
    return theme;
}

bool is_dark(const Theme& theme) {
    const auto& color = theme.background;
    return 0.2126f * color.r + 0.7152f * color.g + 0.0722f * color.b < 0.5f;
}

/// The places that a mechanism visits as large as the panel allows, below the captions.
void place_mechanism(PendulumPanel& panel, float captions_bottom, const View& view, float margin) {
    const Area& area = panel.area;
    const float width = area.width() - 2 * margin, height = area.bottom - captions_bottom - 2 * margin;
    panel.center = {(area.left + area.right) / 2, (captions_bottom + area.bottom) / 2};
    panel.px_per_m = std::min(width / static_cast<float>(view.width), height / static_cast<float>(view.height));
}

/// The circle of the outstretched chain as large as the panel allows, beside or below the captions in its top corners.
void place_pendulum(PendulumPanel& panel, const std::vector<Area>& captions, const View& view, float margin) {
    const Area& area = panel.area;
    float radius = std::min(area.width(), area.height()) / 2 - margin;
    float x = (area.left + area.right) / 2;
    float y = (area.top + area.bottom) / 2;
    const auto clear = [&] {
        return std::all_of(captions.begin(), captions.end(), [&](const Area& caption) {
            const float dx = std::max({0.0f, x - caption.right, caption.left - x}),
                        dy = std::max(0.0f, y - caption.bottom);
            return dx * dx + dy * dy >= radius * radius;
        });
    };
    if (captions.size() == 1)
        while (!clear() && x + radius + margin < area.right) x += 1;
    const float least = radius / 2;
    while (!clear() && radius > least) {
        radius -= 1;
        y = area.bottom - margin - radius;
    }
    panel.center = {x, y};
    panel.px_per_m = 2 * radius / static_cast<float>(view.width);
}

bool is_tall(const VideoSpec& video) {
    return video.size.height > video.size.width;
}

/// How much of the height below the header a strip takes beside pendulums.
float share_of(StripKind kind) {
    switch (kind) {
        case StripKind::distance:
            return 0.24f;
        case StripKind::exponent:
        case StripKind::rod_force:
        case StripKind::energies_a:
        case StripKind::energies_b:
        case StripKind::angles:
        case StripKind::rates:
            return 0.16f;
        case StripKind::energy:
        case StripKind::rod_error:
            break;
    }
    return 0.11f;
}

/// From the bottom up: labels of the time axis, then the strips, each with a heading above it. Returns where the
/// room for panels ends.
float place_strips(Layout& layout, const Scene& scene, float header, const std::optional<MotionBounds>& seen) {
    const auto& video = scene.preset.video;
    float bottom = layout.page.bottom;
    if (video.strips.empty()) return bottom;
    const float t = layout.text;
    layout.time_labels = bottom - 4 * t;
    bottom -= 38 * t;
    const float caption = std::round(19 * t + px(layout.style.font.strip));
    const float room = bottom - header, captions = caption * static_cast<float>(video.strips.size());
    float shares = 0;
    for (const auto kind : video.strips) shares += share_of(kind);
    // beside pendulums about half of it; more where there are many
    const float most = 0.42f + 0.06f * static_cast<float>(video.strips.size());
    const float unit = video.pendulums ? std::min(room, (most * room - captions) / shares) : (room - captions) / shares;
    for (auto kind = video.strips.rbegin(); kind != video.strips.rend(); ++kind) {
        const float top = bottom - std::max(share_of(*kind) * unit, 8 * t);
        const Area area{layout.page.left + std::round(84 * t), std::round(top), layout.page.right, std::round(bottom)};
        const auto& asked = video.ranges[static_cast<std::size_t>(*kind)];
        const auto range = asked ? *asked : fitted_range(*kind, scene, seen);
        layout.strips.push_back({*kind,
                                 area,
                                 {.low = 0, .high = scene.time(scene.samples), .from = area.left, .to = area.right},
                                 {.low = range.low,
                                  .high = range.high,
                                  .from = area.bottom,
                                  .to = area.top,
                                  .logarithmic = is_logarithmic(*kind)}});
        bottom = top - caption;
    }
    std::reverse(layout.strips.begin(), layout.strips.end());
    return bottom - 4 * layout.unit;
}

/// `count` panels side by side, or one above the other.
std::vector<Area> panel_areas(const Area& room, std::size_t count, bool stacked, float gap) {
    const auto n = static_cast<float>(count);
    const float width = stacked ? room.width() : std::floor((room.width() - (n - 1) * gap) / n);
    const float height = stacked ? std::floor((room.height() - (n - 1) * gap) / n) : room.height();
    std::vector<Area> areas;
    for (std::size_t k = 0; k < count; ++k) {
        const auto i = static_cast<float>(k);
        const float left = room.left + (stacked ? 0 : i * (width + gap)),
                    top = room.top + (stacked ? i * (height + gap) : 0);
        areas.push_back({left, top, left + width, top + height});
    }
    return areas;
}

/// The panels' areas, and which sides each shows with which captions.
void place_panels(Layout& layout, const Scene& scene, const Area& room) {
    const auto& video = scene.preset.video;
    const bool apart = video.layout == Arrangement::side_by_side || video.layout == Arrangement::portrait;
    const bool has_phase = video.layout == Arrangement::phase;
    const auto areas = panel_areas(room, apart || has_phase ? 2 : 1, is_tall(video), std::round(24 * layout.unit));
    auto said = side_captions(scene);
    if (!video.shows("labels")) said = {};
    using Caption = PendulumPanel::Caption;
    if (apart) {
        for (std::size_t side = 0; side < 2; ++side)
            layout.panels.push_back({.area = areas[side],
                                     .sides = {side},
                                     .captions = {Caption{side, said[side].heading, said[side].note}}});
        return;
    }
    layout.panels.push_back({.area = areas[0],
                             .sides = {0, 1},
                             .captions = {Caption{0, said[0].heading, said[0].note},
                                          Caption{1, said[1].heading, said[1].note, Align::right}}});
    if (!has_phase) return;
    const float t = layout.text;
    const Area& area = areas[1];
    const Area axes{area.left + std::round(96 * t), area.top + std::round(66 * t), area.right - std::round(34 * t),
                    area.bottom - std::round(54 * t)};
    layout.phase = {
        axes, {.low = -180, .high = 180, .from = axes.left, .to = axes.right}, {.from = axes.bottom, .to = axes.top}};
}

/// The areas of the captions in a panel's corners.
std::vector<Area> caption_areas(const PendulumPanel& panel, const Layout& layout, float widest) {
    std::vector<Area> areas;
    for (const auto& caption : panel.captions) {
        if (caption.heading.empty() && caption.note.empty()) continue;
        const float bottom = panel.area.top + (caption.note.empty() ? 60 : 92) * layout.text;
        const float width = 36 * layout.unit + widest;
        if (caption.align == Align::right)
            areas.push_back({panel.area.right - width, panel.area.top, panel.area.right, bottom});
        else
            areas.push_back({panel.area.left, panel.area.top, panel.area.left + width, bottom});
    }
    return areas;
}

/// All alike, so that the pendulums are drawn to one scale.
void place_pendulums(Layout& layout, const Scene& scene, const std::optional<MotionBounds>& seen) {
    const float u = layout.unit;
    const auto& style = layout.style;
    const auto view = fitted_view(scene, seen);
    float widest = 0;
    for (const auto& panel : layout.panels)
        for (const auto& caption : panel.captions)
            widest = std::max({widest, text_width(caption.heading, px(style.font.heading), Weight::bold),
                               text_width(caption.note, px(style.font.note))});
    for (auto& panel : layout.panels) {
        const auto captions = caption_areas(panel, layout, widest);
        panel.center_x = view.x;
        panel.center_y = view.y;
        if (view.is_circle)
            place_pendulum(panel, captions, view, 30 * u);
        else
            place_mechanism(panel, captions.empty() ? panel.area.top : captions.front().bottom, view, 40 * u);
    }
    const float px_per_m = layout.panels.front().px_per_m;
    const float radius = px_per_m * static_cast<float>(std::max(view.width, view.height)) / 2;
    layout.reach = view.is_circle ? radius : 0;
    // the bobs of a long chain do not hide its rods; nor do those of an ensemble each other
    const float link =
        view.is_circle ? radius / static_cast<float>(std::max(scene.a.mass.size(), scene.b.mass.size())) : radius;
    const float size = !view.is_circle || !scene.members.empty() ? 0.6f : 1;  // a mechanism has more to show
    layout.rod_radius = std::max(std::min(0.0115f * size * radius, 0.2f * link), 0.8f);
    layout.bob_radius = std::max(std::min(0.068f * size * radius, 0.3f * link), 1.6f * layout.rod_radius);
    if (link < 0.1f * radius) layout.last_bob_radius = std::max(layout.bob_radius, 0.02f * radius);
    if (style.width.rod > 0) layout.rod_radius = static_cast<float>(style.width.rod / 2);
    if (style.width.bob > 0) layout.bob_radius = px(style.width.bob);
}

}  // namespace

Style make_style(const VideoSpec& video, float unit, float text) {
    Style style{themed(video), video.widths, video.fonts, 0};
    for (const auto& width : width_names) style.width.*width.member *= unit;
    for (const auto& size : font_size_names) style.font.*size.member *= text;
    // small pictures keep lines that can be seen
    style.width.trail = std::max(style.width.trail, video.widths.trail > 0 ? 1.2 : 0);
    style.width.trace = std::max(style.width.trace, video.widths.trace > 0 ? 1.2 : 0);
    style.width.grid = std::max(style.width.grid, video.widths.grid > 0 ? 1.0 : 0);
    style.width.mark = std::max(style.width.mark, video.widths.mark > 0 ? 1.0 : 0);
    style.glow = unit * static_cast<float>(video.glow_px.value_or(style.theme.glow));
    return style;
}

Color member_color(const Style& style, double share) {
    // the end of the scale that would drown in the background is left out
    return is_dark(style.theme) ? map_color(0.4 + 0.6 * share) : map_color(0.75 * share);
}

Point PendulumPanel::at(double x_m, double y_m) const {
    const auto px = [&](double m) { return static_cast<float>(std::clamp(px_per_m * m, -1e6, 1e6)); };
    return {center.x + px(x_m - center_x), center.y - px(y_m - center_y)};
}

std::vector<Tick> axis_ticks(const Axis& axis, float size, float spacing, bool across) {
    const TickLabels labels{.size = size, .gap = 0, .spacing = spacing, .across = across};
    if (axis.logarithmic) {
        const float decade = std::abs(axis.to - axis.from) / static_cast<float>(std::log10(axis.high / axis.low));
        return chart_ticks(axis, labels, std::max(1.0f, std::ceil(spacing / decade)));
    }
    auto ticks = chart_ticks(axis, labels);
    for (auto& tick : ticks) tick.text = fmt::format("{:.6g}", tick.value);
    return ticks;
}

Layout make_layout(const Scene& scene, const std::atomic<bool>& stop) {
    const auto& video = scene.preset.video;
    const auto width = static_cast<float>(video.size.width), height = static_cast<float>(video.size.height);
    Layout layout;
    layout.unit = is_tall(video) ? std::min(width / 1080, height / 1920) : std::min(width / 1920, height / 1080);
    layout.text = std::max(layout.unit, 0.45f);
    layout.style = make_style(video, layout.unit, layout.text);
    const float u = layout.unit, t = layout.text;
    layout.page = {std::round(60 * u), std::round(28 * u), width - std::round(60 * u), height - std::round(26 * u)};
    if (video.shows("title")) layout.title = scene.preset.title;
    if (video.shows("subtitle")) layout.subtitle = scene_caption(scene);
    const auto seen = motion_bounds(scene, stop);

    const bool has_header = !layout.title.empty() || !layout.subtitle.empty() || video.shows("clock");
    const float header = layout.page.top + (has_header ? 96 * t : 0);
    const float bottom = place_strips(layout, scene, header, seen);
    if (!video.pendulums) return layout;
    place_panels(layout, scene, {layout.page.left, std::round(header), layout.page.right, std::round(bottom)});
    if (layout.phase) {
        const double fastest = 1.08 * std::max(seen->fastest, 1e-6) * 180 / pi;
        layout.phase->rate.low = -fastest;
        layout.phase->rate.high = fastest;
    }
    place_pendulums(layout, scene, seen);
    return layout;
}

}  // namespace doppel
