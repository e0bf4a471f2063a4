#include "film/layout.hpp"

#include "film/strips.hpp"
#include "image/color.hpp"
#include "numeric/state.hpp"
#include "render/typeface.hpp"
#include "scene/captions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace doppel {
namespace {

Theme themed(const VideoSpec& video) {
    auto theme = *std::find_if(themes.begin(), themes.end(), [&](const auto& t) { return t.name == video.theme; });
    if (video.transparent) {  // the page may be bright or dark
        theme.quiet_text = theme.text.with_alpha(0.7f);
        theme.cursor = theme.text.with_alpha(0.6f);
        theme.frame = theme.text.with_alpha(0.45f);
        theme.grid = theme.text.with_alpha(0.25f);
        theme.panel = theme.text.with_alpha(0.1f);
    }
    for (std::size_t i = 0; i < color_names.size(); ++i)
        if (video.colors[i]) theme.*color_names[i].member = *video.colors[i];
    if (video.side_colors) theme.sides = *video.side_colors;
    return theme;
}

bool is_dark(const Theme& theme) {
    const auto& color = theme.background;
    return 0.2126f * color.r + 0.7152f * color.g + 0.0722f * color.b < 0.5f;
}

/// From the bottom up: labels of the time axis, then the strips, each with its words above it.
void place_strips(Layout& layout, const Scene& scene, const Area& room, const MotionBounds& seen) {
    const auto& strips = scene.preset.video.strips;
    if (strips.empty()) return;
    const float t = layout.text;
    layout.time_labels = room.bottom - 4 * t;
    const float labels = std::round((room.width() < 0.5f * layout.page.width() ? 72 : 84) * t);
    const auto captions = plan_captions(layout, scene, room, labels);
    float shares = 0, words_sum = 0;
    for (std::size_t i = 0; i < strips.size(); ++i) {
        shares += share_of(strips[i]);
        words_sum += captions.height(i);
    }
    float bottom = room.bottom - time_labels_height * t;
    const float unit = (bottom - room.top - words_sum) / shares;
    for (std::size_t i = strips.size(); i-- > 0;) {
        const auto kind = strips[i];
        const float top = bottom - std::max(share_of(kind) * unit, 8 * t);
        const Area area{room.left + labels, std::round(top), room.right, std::round(bottom)};
        const auto& asked = scene.preset.video.ranges[static_cast<std::size_t>(kind)];
        const auto range = asked ? *asked : fitted_range(kind, seen);
        const float words = captions.height(i);
        const float left = captions.from_edge ? room.left : area.left;
        layout.strips.push_back({kind,
                                 area,
                                 {.low = 0, .high = scene.time(scene.samples), .from = area.left, .to = area.right},
                                 {.low = range.low,
                                  .high = range.high,
                                  .from = area.bottom,
                                  .to = area.top,
                                  .logarithmic = is_logarithmic(kind)},
                                 {left, area.top - words, area.right, area.top},
                                 area.top - captions.apart,
                                 captions.lines[i]});
        bottom = top - words;
    }
    std::reverse(layout.strips.begin(), layout.strips.end());
}

std::size_t panel_count(const VideoSpec& video) {
    if (!video.pendulums) return 0;
    return video.layout == Arrangement::overlay || video.layout == Arrangement::ensemble ? 1 : 2;
}

/// Which sides each panel shows, and the axes of phase space.
void place_panels(Layout& layout, const Scene& scene, const std::vector<Area>& areas, const MotionBounds& seen) {
    const auto kind = scene.preset.video.layout;
    if (kind == Arrangement::side_by_side || kind == Arrangement::portrait) {
        for (std::size_t side = 0; side < 2; ++side) layout.panels.push_back({.area = areas[side], .sides = {side}});
        return;
    }
    layout.panels.push_back({.area = areas[0], .sides = {0, 1}});
    if (kind != Arrangement::phase) return;
    const float t = layout.text;
    const Area& area = areas[1];
    const Area axes{area.left + std::round(96 * t), area.top + std::round(26 * t), area.right - std::round(40 * t),
                    area.bottom - std::round(54 * t)};
    const double fastest = 1.08 * std::max(seen.fastest, 1e-6) * 180 / pi;
    layout.phase = {area,
                    axes,
                    {.low = -180, .high = 180, .from = axes.left, .to = axes.right},
                    {.low = -fastest, .high = fastest, .from = axes.bottom, .to = axes.top}};
}

/// How large each of many pendulums in one panel is drawn, to one alone.
float member_scale(std::size_t members) {
    return members <= most_full_members
               ? 1
               : std::sqrt(static_cast<float>(most_full_members) / static_cast<float>(members));
}

/// In the middle of their panels, as large as these allow, all to one scale: of a chain the circle that it reaches, of
/// a mechanism the places that it visits.
void place_pendulums(Layout& layout, const Scene& scene, const MotionBounds& seen) {
    const auto& style = layout.style;
    const auto view = fitted_view(scene, seen);
    const auto across = static_cast<float>(view.width), up = static_cast<float>(view.height);
    for (auto& panel : layout.panels) {
        const Area& area = panel.area;
        panel.center = {(area.left + area.right) / 2, (area.top + area.bottom) / 2};
        panel.center_x = view.x;
        panel.center_y = view.y;
        const float edges = 80 * layout.unit;
        panel.px_per_m = view.is_circle ? std::min(area.width(), area.height()) / around_circle / across
                                        : std::min((area.width() - edges) / across, (area.height() - edges) / up);
    }
    const float radius = layout.panels.front().px_per_m * std::max(across, up) / 2;
    layout.reach = view.is_circle ? radius : 0;
    // the bobs of a long chain do not hide its rods
    const float link =
        view.is_circle ? radius / static_cast<float>(std::max(scene.a.mass.size(), scene.b.mass.size())) : radius;
    // a mechanism has more to show; many members share the room of a few
    const float size = view.is_circle ? member_scale(scene.members.size()) : 0.6f;
    // many fine rods stay apart where a few are as wide as lines
    const float thinnest = scene.members.size() > most_full_members ? 0.5f : 0.8f;
    layout.rod_radius = std::max(std::min(0.0115f * size * radius, 0.2f * link), thinnest);
    layout.bob_radius = std::max(std::min(0.068f * size * radius, 0.3f * link), 1.6f * layout.rod_radius);
    if (link < 0.1f * radius) layout.last_bob_radius = std::max(layout.bob_radius, 0.02f * radius);
    if (style.width.rod > 0) layout.rod_radius = static_cast<float>(style.width.rod / 2);
    if (style.width.bob > 0) layout.bob_radius = px(style.width.bob);
}

/// px of a tile's panels to one of a film's.
float tile_unit(const VideoSpec& video, float width) {
    const auto panels = static_cast<float>(panel_count(video));
    return width / panels / 888;
}

/// px of its words to those of a film.
float tile_text(float unit) {
    return std::max(2 * unit, 0.5f);
}

constexpr float tile_clock = 44;  // height of the time above a tile's panels, px of its text

Layout make_tile(const Scene& scene, const MotionBounds& seen) {
    const auto& video = scene.preset.video;
    const auto width = static_cast<float>(video.size.width), height = static_cast<float>(video.size.height);
    Layout layout;
    layout.unit = tile_unit(video, width);
    layout.text = tile_text(layout.unit);
    layout.style = make_style(video, layout.unit, layout.text);
    layout.page = {0, 0, width, height};
    layout.clock =
        label("", {4 * layout.text, 33 * layout.text}, 0.8f * px(layout.style.font.clock), layout.style.theme.text);
    const auto rooms = split_regions({0, std::round(tile_clock * layout.text), width, height},
                                     {.panels = panel_count(video), .gap = std::round(24 * layout.unit), .strips = {}});
    place_panels(layout, scene, rooms.panels, seen);
    place_pendulums(layout, scene, seen);
    return layout;
}

}  // namespace

Size tile_size(const Scene& scene, int width) {
    const auto& video = scene.preset.video;
    const float unit = tile_unit(video, static_cast<float>(width)), text = tile_text(unit);
    const auto across = static_cast<float>(width);
    const float panel = (across - (panel_count(video) > 1 ? 24 * unit : 0)) / static_cast<float>(panel_count(video));
    return {width, static_cast<int>(std::ceil(panel + tile_clock * text))};
}

Style make_style(const VideoSpec& video, float unit, float text) {
    Style style{themed(video), video.widths, video.fonts, 0, video.typeface};
    for (const auto& width : width_names) style.width.*width.member *= unit;
    for (const auto& size : font_size_names) style.font.*size.member *= text;
    // small pictures keep lines that can be seen
    style.width.trail = std::max(style.width.trail, video.widths.trail > 0 ? 1.6 : 0);
    style.width.trace = std::max(style.width.trace, video.widths.trace > 0 ? 1.2 : 0);
    style.width.grid = std::max(style.width.grid, video.widths.grid > 0 ? 1.0 : 0);
    style.width.mark = std::max(style.width.mark, video.widths.mark > 0 ? 1.0 : 0);
    style.glow = unit * static_cast<float>(video.glow_px.value_or(style.theme.glow));
    if (video.layout == Arrangement::ensemble) style.glow = 0;
    return style;
}

Color member_color(const Style& style, double share) {
    // the end of the scale that would drown in the background is left out
    return is_dark(style.theme) ? map_color(0.4 + 0.6 * share) : map_color(0.75 * share);
}

Color member_color(const Style& style, const Scene& scene, std::size_t k) {
    if (!scene.preset.video.members.angles_deg.empty()) return style.theme.palette[k % style.theme.palette.size()];
    const auto last = static_cast<double>(std::max<std::size_t>(scene.members.size(), 2) - 1);
    return member_color(style, static_cast<double>(k) / last);
}

Point PendulumPanel::at(double x_m, double y_m) const {
    const auto px = [&](double m) { return static_cast<float>(std::clamp(px_per_m * m, -1e6, 1e6)); };
    return {center.x + px(x_m - center_x), center.y - px(y_m - center_y)};
}

std::string axis_number(double value) {
    return fmt::format("{}{:.6g}", value < 0 ? "−" : "", std::abs(value));
}

std::vector<Tick> axis_ticks(const Axis& axis, float size, float spacing, bool across) {
    const TickLabels labels{.size = size, .gap = 0, .spacing = spacing, .across = across};
    if (axis.logarithmic) {
        const float decade = std::abs(axis.to - axis.from) / static_cast<float>(std::log10(axis.high / axis.low));
        return chart_ticks(axis, labels, std::max(1.0f, std::ceil(spacing / decade)));
    }
    auto ticks = chart_ticks(axis, labels);
    for (auto& tick : ticks) tick.text = axis_number(tick.value);
    return ticks;
}

Layout make_layout(const Scene& scene, const MotionBounds& seen, PictureKind dress) {
    if (dress == PictureKind::tile) return make_tile(scene, seen);
    const auto& video = scene.preset.video;
    const auto width = static_cast<float>(video.size.width), height = static_cast<float>(video.size.height);
    const bool tall = is_tall(video), is_portrait = video.layout == Arrangement::portrait;
    Layout layout;
    layout.unit = tall ? std::min(width / 1080, height / 1920) : std::min(width / 1920, height / 1080);
    // upright pictures are seen on telephones: larger words, and none where an app has its buttons
    layout.text = tall ? 1.6f * layout.unit : std::max(layout.unit, 0.45f);
    layout.style = make_style(video, layout.unit, layout.text);
    const float u = layout.unit;
    const float top = is_portrait ? 0.06f * height : 28 * u, bottom = is_portrait ? 0.14f * height : 26 * u;
    layout.page = {std::round(60 * u), std::round(top), width - std::round(60 * u), height - std::round(bottom)};

    const float header = std::round(place_header(layout, scene));
    const auto rooms = place_headings(layout, scene, {layout.page.left, header, layout.page.right, layout.page.bottom},
                                      {.panels = panel_count(video),
                                       .tall = tall,
                                       .gap = std::round(24 * u),
                                       .text = layout.text,
                                       .height = height,
                                       .strips = video.strips});
    place_strips(layout, scene, rooms.strips, seen);
    if (!video.pendulums) return layout;
    place_panels(layout, scene, rooms.panels, seen);
    place_pendulums(layout, scene, seen);
    return layout;
}

}  // namespace doppel
