#include "film/layout.hpp"

#include "film/strips.hpp"
#include "numeric/state.hpp"
#include "plot/labels.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <variant>

namespace doppel {
namespace {

Theme themed(const VideoSpec& video) {
    auto theme = *std::find_if(themes.begin(), themes.end(), [&](const auto& t) { return t.name == video.theme; });
    if (video.transparent) {  // the background of the page may be bright or dark
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

/// The colour of a member: listed ones have distinct hues, others the colour scale.
Color color_of(const Members& members, std::size_t k, const Theme& theme) {
    if (members.releases.empty())
        return member_color(theme, static_cast<double>(k) / static_cast<double>(members.size() - 1));
    return members.releases[k].color.value_or(theme.palette[k % theme.palette.size()]);
}

/// The part of the plane shown in the pendulums' panels, m.
struct View {
    double x = 0, y = 0;   // centre
    double width, height;  // for a chain, those of the circle it can reach
    bool is_circle = true;
};

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
    for (const double step : {1.0, 2.0, 5.0})
        if (up && step * unit >= value) return step * unit;
    for (const double step : {5.0, 2.0})
        if (!up && step * unit <= value) return step * unit;
    return up ? 10 * unit : unit;
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

/// For a chain, the circle that it can reach when outstretched; for a mechanism, the area that it visits.
View fitted_view(const Scene& scene, const MotionBounds& seen) {
    if (has_circle(scene)) {
        double reach = std::max(scene.a.reach + scene.a.pivot_reach, scene.b.reach + scene.b.pivot_reach);
        for (const auto& member : scene.members)
            reach = std::max(reach, static_cast<double>(member.chain->reach()) + scene.a.pivot_reach);
        return {.width = 2 * reach, .height = 2 * reach};
    }
    auto all = seen;
    for (const auto* side : {&scene.a, &scene.b})
        for (const auto& line : side->lines)
            for (const auto* end : {&line.from, &line.to})
                if (const auto* place = std::get_if<Place<double>>(end)) all.add((*place)[0], (*place)[1], line.radius);
    const double width = all.right - all.left, height = all.top - all.bottom;
    const double minimum = 1e-3 * std::max({width, height, 1e-6});
    const View view{(all.left + all.right) / 2, (all.bottom + all.top) / 2, std::max(width, minimum),
                    std::max(height, minimum), false};
    return std::isfinite(view.width + view.height) ? view : View{.width = 2, .height = 2, .is_circle = false};
}

Range fitted_range(StripKind kind, const MotionBounds& seen) {
    const auto& spread = seen.strips[static_cast<std::size_t>(kind)];
    if (kind == StripKind::distance) return fitted_distance(spread);
    return is_logarithmic(kind) ? fitted_error(spread) : padded(spread);
}

/// Height of the captions of strips this wide, px.
float caption_height(const Layout& layout, const Scene& scene, float width) {
    int lines = 1;
    for (const auto kind : scene.preset.video.strips)
        lines = std::max(lines, caption_lines(kind, scene, layout, width));
    return static_cast<float>(lines) * caption_line(layout) + above_curves(layout);
}

float numbers_height(const Layout& layout) {
    return 1.75f * px(layout.style.font.axis);
}

/// Places captions and axes in the cells of one column or of rows. The axes begin right of the widest number, and end
/// so that the last number on the time axis fits.
void place_strips(Layout& layout, const Scene& scene, const std::vector<Area>& cells, const MotionBounds& seen) {
    const auto& video = scene.preset.video;
    const float em = px(layout.style.font.axis);
    float left = 0, right = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const auto kind = video.strips[i];
        const auto& cell = cells[i];
        const bool is_lowest = std::ranges::none_of(
            cells, [&](const Area& other) { return other.left == cell.left && other.top > cell.top; });
        // the lowest number of a strip extends below its curves
        const float below = is_lowest ? numbers_height(layout) : 0.35f * em;
        // captions have priority over curves, unless many strips share little space
        const float high = cell.height() - below - above_curves(layout);
        const bool is_low = high - caption_line(layout) < em;  // curves would be lower than their numbers
        const int maximum = is_low ? 0 : std::max(1, static_cast<int>(0.4f * high / caption_line(layout)));
        const int lines = std::min(caption_lines(kind, scene, layout, cell.width()), maximum);
        const float words =
            is_low ? 0.35f * em : static_cast<float>(lines) * caption_line(layout) + above_curves(layout);
        const Area area{cell.left, std::round(cell.top + words), cell.right, std::round(cell.bottom - below)};
        const auto& requested = video.ranges[static_cast<std::size_t>(kind)];
        const auto range = requested ? *requested : fitted_range(kind, seen);
        layout.strips.push_back(
            {.kind = kind,
             .cell = cell,
             .area = area,
             .time = {.low = 0, .high = scene.time(scene.samples), .from = area.left, .to = area.right},
             .value = {.low = range.low,
                       .high = range.high,
                       .from = area.bottom,
                       .to = area.top,
                       .logarithmic = is_logarithmic(kind)},
             .lines = lines,
             .baseline = area.top - words + caption_line(layout)});
        if (!is_low)
            left = std::max(left, widest(spaced_ticks(layout.strips.back().value, false, em), em) + 0.55f * em);
    }
    for (auto& strip : layout.strips) {
        strip.time.from = strip.area.left = std::round(strip.cell.left + left);
        const auto ticks = spaced_ticks(strip.time, true, em);
        if (ticks.empty()) continue;
        const float end =
            strip.time.at(ticks.back().value) + text_width(ticks.back().text, em) / 2 + text_width(" s", em);
        right = std::max(right, std::ceil(end - strip.cell.right));
    }
    for (auto& strip : layout.strips) {
        strip.time.to = strip.area.right = strip.cell.right - right;
        const double part = strip.time.high / static_cast<double>(seen.distance.size());
        for (std::size_t k = 0; strip.kind == StripKind::distance && k < seen.distance.size(); ++k)
            if (const auto& curve = seen.distance[k]; curve.count > 0)
                strip.covered.push_back({strip.time.at(part * static_cast<double>(k)), strip.value.at(curve.maximum),
                                         strip.time.at(part * static_cast<double>(k + 1)),
                                         strip.value.at(curve.minimum)});
    }
}

std::size_t panel_count(const VideoSpec& video) {
    if (!video.pendulums) return 0;
    return has_panel_for_each(video) || video.layout == Arrangement::phase ? 2 : 1;
}

/// Chooses the pendulums that each panel shows, and the axes of the phase portrait.
void place_panels(Layout& layout, const Scene& scene, const std::vector<Area>& areas, const MotionBounds& seen) {
    if (has_panel_for_each(scene.preset.video)) {
        for (std::size_t side = 0; side < 2; ++side) layout.panels.push_back({.area = areas[side], .shown = {side}});
        return;
    }
    std::vector<std::size_t> all(std::max(scene.members.size(), scene.letters().size()));
    std::iota(all.begin(), all.end(), std::size_t{0});
    layout.panels.push_back({.area = areas[0], .shown = std::move(all)});
    if (scene.preset.video.layout != Arrangement::phase) return;
    const Area& area = areas[1];
    const float em = px(layout.style.font.axis);
    const double fastest = 1.08 * std::max(seen.fastest, 1e-6) * 180 / pi;
    Axis rate{.low = -fastest, .high = fastest, .from = area.bottom - 2.6f * em, .to = area.top + 1.3f * em};
    const Area axes{std::round(area.left + widest(spaced_ticks(rate, false, em), em) + 1.4f * em), rate.to,
                    std::round(area.right - 2 * em), rate.from};
    layout.phase = {area, axes, {.low = -180, .high = 180, .from = axes.left, .to = axes.right}, rate};
}

/// Centres the pendulums in their panels, as large as possible, all at the same scale. A chain's scale is given by the
/// circle it can reach, a mechanism's by the area it visits.
void place_pendulums(Layout& layout, const Scene& scene, const MotionBounds& seen) {
    const auto& style = layout.style;
    auto view = fitted_view(scene, seen);
    const auto across = static_cast<float>(view.width), up = static_cast<float>(view.height);
    const auto& requested = scene.preset.video.view;
    if (requested.follow > 0) view.x = view.y = 0;
    if (const auto& center = requested.center_m)
        view.x = static_cast<double>((*center)[0]), view.y = static_cast<double>((*center)[1]);
    for (auto& panel : layout.panels) {
        const Area& area = panel.area;
        panel.center = {(area.left + area.right) / 2, (area.top + area.bottom) / 2};
        panel.center_x = view.x;
        panel.center_y = view.y;
        const float edges = 80 * layout.unit;
        panel.px_per_m = view.is_circle ? std::min(area.width(), area.height()) / around_circle / across
                                        : std::min((area.width() - edges) / across, (area.height() - edges) / up);
        if (requested.height_m) panel.px_per_m = area.height() / px(*requested.height_m);
    }
    const float radius = layout.panels.front().px_per_m * std::max(across, up) / 2;
    layout.reach = view.is_circle ? radius : 0;
    // the bobs of a long chain must not hide its rods
    const float link =
        view.is_circle ? radius / static_cast<float>(std::max(scene.a.mass.size(), scene.b.mass.size())) : radius;
    // a mechanism has more parts to show; many members share the space of a few
    const float of_many = size_of_many(scene.members.size()), size = view.is_circle ? of_many : 0.6f;
    // many thin rods remain separate; a few are at least as wide as lines
    const float thinnest = of_many < 1 ? 0.5f : 0.8f;
    layout.rod_radius = std::max(std::min(0.0115f * size * radius, 0.2f * link), thinnest);
    layout.bob_radius = std::max(std::min(0.068f * size * radius, 0.3f * link), 1.6f * layout.rod_radius);
    if (link < 0.1f * radius) layout.last_bob_radius = std::max(layout.bob_radius, 0.02f * radius);
    layout.style.width.trail = px(style.width.trail) * std::max(of_many, 0.4f);
    if (style.width.rod) layout.rod_radius = px(*style.width.rod / 2);
    if (style.width.bob) layout.bob_radius = px(*style.width.bob);
    if (style.width.bob) layout.last_bob_radius = std::min(layout.last_bob_radius, layout.bob_radius);
}

/// least ratio of text px to those of a 1920×1080 picture; smallest text, px per em
constexpr float min_unit = 1.0f / 3, min_text = 9;

// in units of the picture's height: curves of a strip; circles of a pair for which strips still go below
constexpr float min_curves = 0.2f, max_curves = 0.34f, min_circle = 0.45f;
// in units of the area: all strips below panels; a column of strips
constexpr float max_below = 0.62f, min_column = 0.285f, min_two_columns = 0.45f;

constexpr std::size_t max_in_row = 3, max_in_column = 5;  // strips in a row below panels; beside them

/// Panels side by side, or one above the other, each below its heading.
std::vector<Area> panel_areas(const Area& room, const RegionNeeds& needs, bool stacked) {
    const auto n = static_cast<float>(needs.panels);
    const float gaps = (n - 1) * needs.gap;
    const float width = stacked ? room.width() : std::floor((room.width() - gaps) / n);
    const float height = std::floor(stacked ? (room.height() - gaps) / n : room.height());
    std::vector<Area> areas;
    for (std::size_t k = 0; k < needs.panels; ++k) {
        const auto i = static_cast<float>(k);
        const float left = room.left + (stacked ? 0 : i * (width + needs.gap)),
                    top = room.top + (stacked ? i * (height + needs.gap) : 0);
        areas.push_back({left, std::round(top + needs.heading), left + width, std::round(top + height)});
    }
    if (areas.size() != 2 || needs.chart_heading == 0) return areas;
    constexpr float wider = 0.1f, first = 0.52f;  // shares of the width of a panel, and of the height of both
    if (stacked) {
        const float both = room.height() - needs.gap - needs.heading - needs.chart_heading;
        areas[0].bottom = std::round(areas[0].top + first * both);
        areas[1].top = areas[0].bottom + needs.gap + std::round(needs.chart_heading);
    } else {
        areas[0].right -= std::round(wider * width);
        areas[1].left -= std::round(wider * width);
    }
    return areas;
}

/// Strips in columns, row by row, with curves of equal height.
std::vector<Area> strip_cells(const Area& room, const RegionNeeds& needs, std::size_t columns) {
    const auto rows = static_cast<float>((needs.strips + columns - 1) / columns), n = static_cast<float>(columns);
    const float width = std::floor((room.width() - (n - 1) * needs.gap) / n);
    const float height = (room.height() - needs.numbers) / rows;
    std::vector<Area> cells;
    for (std::size_t k = 0; k < needs.strips; ++k) {
        const auto row = static_cast<float>(k / columns);
        const float left = room.left + static_cast<float>(k % columns) * (width + needs.gap),
                    top = room.top + row * height;
        const float below = row + 1 < rows ? 0 : needs.numbers;
        cells.push_back({left, std::round(top), left + width, std::round(top + height + below)});
    }
    return cells;
}

/// Diameter of the panels' circles, px.
float circle_in(const Regions& regions) {
    const auto& panel = regions.panels.front();
    return std::min(panel.width(), panel.height()) / around_circle;
}

/// Strips get the height they need, and what the panels leave of the rest.
Regions with_strips_below(const Area& room, const RegionNeeds& needs, std::size_t columns, bool stacked) {
    const auto rows = static_cast<float>((needs.strips + columns - 1) / columns), n = static_cast<float>(needs.panels),
               across = static_cast<float>(columns);
    const float words = rows * needs.caption((room.width() - (across - 1) * needs.gap) / across) + needs.numbers;
    const float gap = needs.gap / 3, gaps = (n - 1) * needs.gap;
    const float squares =
        stacked ? n * (room.width() + needs.heading) + gaps : (room.width() - gaps) / n + needs.heading;
    const float minimum = words + rows * min_curves * needs.height, maximum = words + rows * max_curves * needs.height;
    const float strips =
        std::min(std::clamp(room.height() - gap - squares, minimum, maximum), max_below * room.height());
    const float part = std::round(room.bottom - strips);
    return {panel_areas({room.left, room.top, room.right, part - gap}, needs, stacked),
            strip_cells({room.left, part, room.right, room.bottom}, needs, columns)};
}

/// A single panel is a square; strips get the rest.
Regions with_strips_beside(const Area& room, const RegionNeeds& needs) {
    const std::size_t columns = needs.strips > max_in_column ? 2 : 1;
    const float square = room.height() - needs.heading;
    const float minimum = (columns > 1 ? min_two_columns : min_column) * room.width();
    const float column = needs.panels == 1 ? std::max(room.width() - square - needs.gap, minimum) : minimum;
    const float part = std::round(room.right - column);
    return {panel_areas({room.left, room.top, part - needs.gap, room.bottom}, needs, false),
            strip_cells({part, room.top, room.right, room.bottom}, needs, columns)};
}

}  // namespace

Style make_style(const VideoSpec& video, float unit, float text) {
    Style style{themed(video), video.widths, video.fonts, 0, video.typeface};
    for (const auto& width : width_names) style.width.*width.member *= unit;
    for (auto* width : {&style.width.rod, &style.width.bob})
        if (*width) **width *= unit;
    for (const auto& size : font_size_names) style.font.*size.member *= text;
    // in small pictures lines remain wide enough to be visible
    style.width.trail = std::max(style.width.trail, video.widths.trail > 0 ? 1.6 : 0);
    style.width.trace = std::max(style.width.trace, video.widths.trace > 0 ? 1.2 : 0);
    style.width.grid = std::max(style.width.grid, video.widths.grid > 0 ? 1.0 : 0);
    style.width.mark = std::max(style.width.mark, video.widths.mark > 0 ? 1.0 : 0);
    style.glow = unit * static_cast<float>(video.glow_px.value_or(style.theme.glow));
    if (video.layout != Arrangement::ensemble) return style;
    style.glow = 0;
    if (!video.side_colors)
        style.theme.sides = {color_of(video.members, 0, style.theme),
                             color_of(video.members, video.members.size() - 1, style.theme)};
    return style;
}

float size_of_many(std::size_t pendulums) {
    return std::sqrt(8 / static_cast<float>(std::max<std::size_t>(pendulums, 8)));
}

Color member_color(const Theme& theme, double share) {
    // on dark without the dark end of the maps' scale; on light another one, from indigo to coral
    if (theme.is_dark()) return map_color(0.4 + 0.6 * share);
    const auto from_middle = px(2 * share - 1);
    return mixed(rgb(0xa8327d), rgb(from_middle < 0 ? 0x352a8c : 0xe0683c), std::abs(from_middle));
}

double ShownPendulum::least_bob() const {
    double thickest = 1;
    for (const auto& line : side.lines) thickest = std::max<double>(thickest, line.width);
    return thickest > 1 ? 0.5 * thickest : 1.6;
}

std::vector<ShownPendulum> shown_pendulums(const Scene& scene, const Style& style, bool share_panel) {
    std::vector<ShownPendulum> shown;
    const auto& theme = style.theme;
    for (std::size_t k = 0; const auto& member : scene.members) {
        shown.push_back({member, scene.a, member.physical ? scene.a.mass : member.chain->cast<double>().mass,
                         color_of(scene.preset.video.members, k, theme)});
        ++k;
    }
    const bool is_ensemble = !shown.empty();
    for (const char letter : is_ensemble ? "" : scene.letters()) {
        const auto& side = scene.side(letter);
        shown.push_back({side.motion, side, side.mass, theme.sides[shown.size()]});
    }
    // if several share a panel, each has its own hue, and on light always, where grey ones look black; many are more
    // transparent
    const bool is_grey = theme.is_dark() && !is_ensemble && (shown.size() == 1 || !share_panel);
    for (auto& one : shown) {
        const auto hued = [&](Color color, float share) { return is_grey ? color : mixed(color, one.color, share); };
        const auto clear = [&](float opacity) {
            if (size_of_many(shown.size()) == 1) return one.color;
            return one.color.with_alpha(
                std::clamp(opacity * 14 / std::sqrt(static_cast<float>(shown.size())), 0.16f, 0.9f));
        };
        one.rod = is_ensemble ? clear(0.43f) : hued(theme.rod, 0.55f);
        one.bob = hued(theme.bob, 0.4f);
        one.trail = clear(0.5f);
        one.ghost = scene.preset.video.transparent ? one.color.with_alpha(0.4f) : mixed(theme.panel, one.color, 0.26f);
    }
    return shown;
}

std::vector<Place<double>> pivots_of(const Side& side) {
    using Kind = MechanismLine::Kind;
    std::vector<Place<double>> places;
    for (const auto& line : side.lines) {
        if (line.kind == Kind::slot_line || line.kind == Kind::slot_circle) continue;
        for (const auto* end : {&line.from, line.kind == Kind::anchor ? nullptr : &line.to})
            if (const auto* place = end ? std::get_if<Place<double>>(end) : nullptr) places.push_back(*place);
    }
    return places;
}

Point PendulumPanel::at(double x_m, double y_m) const {
    const auto px = [&](double m) { return static_cast<float>(std::clamp(px_per_m * m, -1e6, 1e6)); };
    return {center.x + px(x_m - center_x), center.y - px(y_m - center_y)};
}

bool depends_on_motion(const Scene& scene) {
    const auto& video = scene.preset.video;
    const bool view = video.pendulums && (!has_circle(scene) || video.layout == Arrangement::phase);
    return view || std::any_of(video.strips.begin(), video.strips.end(),
                               [&](StripKind kind) { return !video.ranges[static_cast<std::size_t>(kind)]; });
}

Layout make_layout(const Scene& scene, const MotionBounds& seen) {
    const auto& video = scene.preset.video;
    const auto width = static_cast<float>(video.size.width), height = static_cast<float>(video.size.height);
    const bool tall = is_tall(video), is_portrait = video.layout == Arrangement::portrait;
    Layout layout;
    layout.unit = tall ? std::min(width / 1080, height / 1920) : std::min(width / 1920, height / 1080);
    // upright pictures are for telephones: larger text, and none where an app has its buttons
    layout.text = tall ? 1.6f * layout.unit : std::max(layout.unit, min_unit);
    layout.min_text = min_text * (tall ? std::max(1080.0f / 390 * layout.unit, 1.0f) : 1);
    layout.style = make_style(video, layout.unit, layout.text);
    const float u = layout.unit;
    const float top = is_portrait ? 0.06f * height : 28 * u, bottom = is_portrait ? 0.14f * height : 26 * u;
    layout.page = {std::round(60 * u), std::round(top), width - std::round(60 * u), height - std::round(bottom)};

    const float header = std::round(place_header(layout, scene));
    const auto regions =
        place_headings(layout, scene, {layout.page.left, header, layout.page.right, layout.page.bottom},
                       {.panels = panel_count(video),
                        .strips = video.strips.size(),
                        .tall = tall,
                        .chart_heading = tall && video.layout == Arrangement::phase ? 46 * layout.text : 0,
                        .gap = std::round(24 * u),
                        .height = height,
                        .numbers = numbers_height(layout),
                        .caption = [&](float strip_width) { return caption_height(layout, scene, strip_width); }});
    place_strips(layout, scene, regions.strips, seen);
    if (!video.pendulums) return layout;
    place_panels(layout, scene, regions.panels, seen);
    place_pendulums(layout, scene, seen);
    return layout;
}

Regions split(const Area& room, const RegionNeeds& needs) {
    if (needs.panels == 0) return {{}, strip_cells(room, needs, needs.strips > max_in_row ? 2 : 1)};
    const bool can_stack = needs.tall && needs.panels > 1;
    if (needs.strips == 0) return {panel_areas(room, needs, can_stack), {}};
    if (needs.tall) {
        auto beside = with_strips_below(room, needs, 1, false), stacked = with_strips_below(room, needs, 1, true);
        return can_stack && circle_in(stacked) > circle_in(beside) ? stacked : beside;
    }
    auto beside = with_strips_beside(room, needs);
    if (needs.panels > 1 && needs.strips <= max_in_row) {
        auto below = with_strips_below(room, needs, needs.strips, false);
        if (circle_in(below) >= std::min(min_circle * needs.height, circle_in(beside))) return below;
    }
    return beside;
}

}  // namespace doppel
