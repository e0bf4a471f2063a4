#include "plot/panel.hpp"
#include "render/stroke.hpp"

namespace doppel {
namespace {

struct Place {
    double x, y;
};

/// At most four points of each half pixel column: the first, the lowest, the highest and the last.
std::vector<Place> thinned(const std::vector<Place>& piece) {
    const auto column = [](const Place& place) { return std::floor(2 * place.x); };
    const auto is_lower = [](const Place& a, const Place& b) { return a.y < b.y; };
    std::vector<Place> kept;
    for (auto first = piece.begin(); first != piece.end();) {
        const auto end = std::find_if(first, piece.end(), [&](const Place& p) { return column(p) != column(*first); });
        if (end - first <= 4) {
            kept.insert(kept.end(), first, end);
        } else {
            const auto low = std::min_element(first + 1, end - 1, is_lower);
            auto high = std::max_element(first + 1, end - 1, is_lower);
            if (low == high) high = end - 2;
            kept.insert(kept.end(), {*first, *std::min(low, high), *std::max(low, high), end[-1]});
        }
        first = end;
    }
    return kept;
}

/// Adds the parts of a piece inside the area.
void add_clipped(const std::vector<Place>& piece, const Area& area, std::vector<std::vector<Point>>& lines) {
    bool is_joined = false;  // whether the last line ends at the previous point
    for (std::size_t i = 1; i < piece.size(); ++i) {
        const Place &from = piece[i - 1], &to = piece[i];
        const auto within = clip_segment(area, from.x, from.y, to.x, to.y);
        const auto at = [&](double part) {
            // clamped, because rounding of a far point may exceed the panel
            return Point{std::clamp(static_cast<float>(from.x + part * (to.x - from.x)), area.left, area.right),
                         std::clamp(static_cast<float>(from.y + part * (to.y - from.y)), area.top, area.bottom)};
        };
        if (within && (within->from > 0 || !is_joined)) lines.push_back({at(within->from)});
        if (within) lines.back().push_back(at(within->to));
        is_joined = within && within->to == 1;
    }
}

/// The points of a curve, px, in pieces between values that cannot be drawn.
std::vector<std::vector<Place>> pieces_of(const Curve& curve, const Axis& x, const Axis& y) {
    std::vector<std::vector<Place>> pieces(1);
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
        const Place at{x.pixel(curve.x[i]), y.pixel(curve.y[i])};
        if (std::isfinite(at.x) && std::isfinite(at.y))
            pieces.back().push_back(at);
        else if (!pieces.back().empty())
            pieces.emplace_back();
    }
    return pieces;
}

/// Above these numbers, marks are drawn smaller and as images, and lines are thin.
constexpr std::size_t many = 400;

/// Discs at many points as an image with `scale` pixels per px: cheaper than paths. Discs of less than full opacity add
/// up where they overlap. They are clipped to `area`.
Image scatter_image(const std::vector<Point>& points, float radius, Color color, float opacity, const Area& area,
                    float scale) {
    const auto below = [&](float px) { return static_cast<int>(std::floor(px * scale)); };
    const int left = below(area.left), top = below(area.top);
    const Size size{std::max(1, static_cast<int>(std::ceil(area.right * scale)) - left),
                    std::max(1, static_cast<int>(std::ceil(area.bottom * scale)) - top)};
    std::vector<float> covered(static_cast<std::size_t>(size.width) * size.height);  // coverage of each pixel, 0…1
    const float reach = std::max(radius * scale, 0.5f);
    for (const Point& point : points) {
        const float x = point.x * scale - static_cast<float>(left), y = point.y * scale - static_cast<float>(top);
        const int right = std::min(static_cast<int>(std::ceil(x + reach)), size.width - 1);
        const int bottom = std::min(static_cast<int>(std::ceil(y + reach)), size.height - 1);
        for (int row = std::max(static_cast<int>(y - reach) - 1, 0); row <= bottom; ++row)
            for (int column = std::max(static_cast<int>(x - reach) - 1, 0); column <= right; ++column) {
                const float dx = static_cast<float>(column) + 0.5f - x, dy = static_cast<float>(row) + 0.5f - y;
                const float part = std::clamp(0.5f + reach - std::sqrt(dx * dx + dy * dy), 0.0f, 1.0f);
                float& value = covered[static_cast<std::size_t>(row) * size.width + column];
                value = opacity < 1 ? value + (1 - value) * opacity * part : std::max(value, part);
            }
    }
    auto pixels = std::make_shared<Picture>(size);
    for (std::size_t i = 0; i < covered.size(); ++i)
        if (covered[i] > 0) std::ranges::copy(bytes_of(color.with_alpha(color.a * covered[i])), &pixels->rgba[4 * i]);
    const auto px = [&](int v) { return static_cast<float>(v) / scale; };
    return {{px(left), px(top), px(left + size.width), px(top + size.height)}, std::move(pixels)};
}

}  // namespace

DrawnCurve drawn(const Curve& curve, const Axis& x, const Axis& y, const Area& area) {
    DrawnCurve made;
    const bool is_behind = curve.background != Background::none, has_line = curve.mark == Mark::line;
    const bool is_dense = !is_behind && static_cast<float>(curve.x.size()) > 2 * area.width();
    for (const auto& piece : pieces_of(curve, x, y)) {
        if (is_behind || has_line || curve.mark == Mark::both)
            add_clipped(is_dense ? thinned(piece) : piece, area, made.lines);
        // a value between two gaps is drawn as a dot, otherwise it would be invisible
        if (is_behind || (has_line && piece.size() > 1)) continue;
        for (const Place& at : piece)
            if (at.x >= area.left && at.x <= area.right && at.y >= area.top && at.y <= area.bottom)
                made.points.push_back({static_cast<float>(at.x), static_cast<float>(at.y)});
    }
    return made;
}

Color curve_color(const Curve& curve, const Theme& of_page, bool over_map) {
    if (over_map && curve.quiet) return rgb(0xffffff);
    const Theme& theme = over_map ? themes.front() : of_page;
    if (curve.quiet) return curve.mark == Mark::points ? theme.quiet_text : theme.cursor;
    return theme.palette[static_cast<std::size_t>(curve.hue) % theme.palette.size()];
}

void draw_band(const Curve& curve, const Panel& panel) {
    if (curve.uncertainty.empty()) return;
    const Axis &x = panel.axes.x, &y = panel.y_of(curve);
    const Color color = curve_color(curve, panel.style.theme).with_alpha(0.2f);
    Polylines band{.lines = {}, .color = color, .within = panel.area};
    const auto place = [](double at_x, double at_y) {
        constexpr double far = 1e5;  // px: outside any panel, and inside the range of Cairo's numbers
        return Point{static_cast<float>(std::clamp(at_x, -far, far)), static_cast<float>(std::clamp(at_y, -far, far))};
    };
    std::vector<Point> above, below;
    const auto end = [&] {
        above.insert(above.end(), below.rbegin(), below.rend());
        if (below.size() > 1) band.lines.push_back(std::move(above));
        above.clear(), below.clear();
    };
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
        const double wide = std::abs(curve.uncertainty[i]);
        double low = curve.y[i] - wide;
        // on a logarithmic axis, a band that reaches zero extends to the end of the axis
        if (y.logarithmic && low <= 0 && curve.y[i] > 0) low = std::min(y.low, y.high);
        const double at = x.pixel(curve.x[i]), lower = y.pixel(low), upper = y.pixel(curve.y[i] + wide);
        if (!std::isfinite(at + lower + upper)) {
            end();
            continue;
        }
        above.push_back(place(at, upper));
        below.push_back(place(at, lower));
    }
    end();
    panel.list.push_back(std::move(band));
}

void draw_line(const std::vector<std::vector<Point>>& lines, float width, bool dashed, Color color,
               const Panel& panel) {
    if (lines.empty()) return;
    const float unit = panel.style.unit, dash = dashed ? std::max(9 * unit, 5.0f) + width : 0;
    panel.list.push_back(Polylines{lines, width, color, dash, std::max(7 * unit, 4.0f) + width});
}

void draw_curve(const Curve& curve, const DrawnCurve& drawn, const Panel& panel) {
    const PlotStyle& style = panel.style;
    const Theme& theme = style.theme;
    PageList& list = panel.list;
    const bool over_map = panel.is_map();
    if (curve.background == Background::band)
        return draw_line(drawn.lines, 6 * style.curve, false, mixed(theme.background, theme.open, 0.22f), panel);
    if (curve.background == Background::line)
        return draw_line(drawn.lines, style.thin, curve.dashed,
                         mixed(theme.background, curve_color(curve, theme), 0.3f), panel);
    const Color color = curve_color(curve, theme, over_map), edge = rgb(0x0b0e13).with_alpha(0.75f);
    const bool thin = (curve.quiet && !over_map) || curve.x.size() > many;
    const float width = thin ? style.thin : style.curve;
    const float casing = std::max(1.6f * style.unit, 1.0f);
    if (over_map) draw_line(drawn.lines, width + 2 * casing, false, edge, panel);
    const bool repeats_color = curve.hue >= static_cast<int>(theme.palette.size());
    draw_line(drawn.lines, width, curve.dashed || repeats_color, color, panel);

    float radius = curve.quiet ? 0.75f * style.marker : style.marker;
    if (curve.mark == Mark::line) radius = 0.8f * width;
    if (drawn.marks_in_panel > many) {
        // px for unit 1: the width of a panel to which `many` refers, and the smallest marks that give no moiré pattern
        constexpr float wide = 450, minimum = 1;
        const Area& area = panel.area;
        const float side = std::sqrt(area.width() * area.height()) / style.unit;
        const float share = static_cast<float>(many) / static_cast<float>(drawn.marks_in_panel);
        radius = std::max(radius * std::sqrt(share) * std::min(side / wide, 1.0f), minimum * style.unit);
        const float opacity = curve.mark == Mark::density ? 0.4f : 1;
        if (over_map) list.push_back(scatter_image(drawn.points, radius + casing, edge, 1, area, style.scale));
        list.push_back(scatter_image(drawn.points, radius, color, opacity, area, style.scale));
        return;
    }
    for (const Point& at : drawn.points) {
        if (over_map) list.push_back(Capsule{at, at, radius + casing, edge});
        list.push_back(Capsule{at, at, radius, color});
    }
}

}  // namespace doppel
