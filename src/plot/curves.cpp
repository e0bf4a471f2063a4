#include "plot/chart_parts.hpp"
#include "render/stroke.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

struct Place {
    double x, y;
};

/// Collects a polyline segment by segment, clipped to an area.
class Clipper {
public:
    Clipper(const Area& area, std::vector<std::vector<Point>>& lines) : area_(area), lines_(lines) {}

    void lift() { down_ = false; }

    void move(Place to) {
        if (!down_) {
            down_ = true;
            joined_ = false;
        } else {
            clip(last_, to);
        }
        last_ = to;
    }

private:
    void clip(Place from, Place to) {
        const auto within = clip_segment(area_, from.x, from.y, to.x, to.y);
        if (!within) {
            joined_ = false;
            return;
        }
        const double dx = to.x - from.x, dy = to.y - from.y;
        const auto at = [&](double part) {
            // clamped, because rounding of a far point may exceed the panel
            return Point{std::clamp(static_cast<float>(from.x + part * dx), area_.left, area_.right),
                         std::clamp(static_cast<float>(from.y + part * dy), area_.top, area_.bottom)};
        };
        if (within->from > 0 || !joined_) lines_.push_back({at(within->from)});
        lines_.back().push_back(at(within->to));
        joined_ = within->to == 1;
    }

    Area area_;
    std::vector<std::vector<Point>>& lines_;
    Place last_{};
    bool down_ = false, joined_ = false;  // state of the pen; whether the last piece ends at last_
};

/// Passes on at most four points of a dense line for each half pixel column.
class PointReducer {
public:
    explicit PointReducer(Clipper& clipper) : clipper_(clipper) {}

    void add(Place place) {
        const double column = std::floor(2 * place.x);
        if (held_.empty() || column != column_) {
            flush();
            column_ = column;
        }
        if (held_.size() < 4) {
            held_.push_back(place);
            return;
        }
        // replaces the previous point if it is neither first nor an extreme
        held_.push_back(place);
        std::size_t low = 1, high = 1;
        for (std::size_t i = 1; i + 1 < held_.size(); ++i) {
            if (held_[i].y < held_[low].y) low = i;
            if (held_[i].y > held_[high].y) high = i;
        }
        for (std::size_t i = 1; i + 1 < held_.size(); ++i) {
            if (i == low || i == high) continue;
            held_.erase(held_.begin() + static_cast<std::ptrdiff_t>(i));
            return;
        }
    }

    void flush() {
        for (const Place& place : held_) clipper_.move(place);
        held_.clear();
    }

    void lift() {
        flush();
        clipper_.lift();
    }

private:
    Clipper& clipper_;
    std::vector<Place> held_;
    double column_ = 0;
};

double pixel(const Axis& axis, double value) {
    if (axis.logarithmic && value <= 0) return std::nan("");
    return axis.from + (static_cast<double>(axis.to) - axis.from) * axis.share(value);
}

/// A thick or pale line behind the others.
void draw_background(const Curve& curve, const Axis& x, const Axis& y, const Area& area, const PlotStyle& style,
                     PageList& list) {
    std::vector<std::vector<Point>> lines;
    Clipper clipper(area, lines);
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
        const Place at{pixel(x, curve.x[i]), pixel(y, curve.y[i])};
        std::isfinite(at.x) && std::isfinite(at.y) ? clipper.move(at) : clipper.lift();
    }
    if (curve.background == Background::band)
        draw_line(lines, 6 * style.curve, false, mixed(style.theme.background, style.theme.open, 0.22f), style, list);
    else
        draw_line(lines, style.thin, curve.dashed,
                  mixed(style.theme.background, curve_color(curve, style, false), 0.3f), style, list);
}

/// Above these numbers, marks are drawn smaller and as images, and lines are thin.
constexpr std::size_t many = 400;

}  // namespace

DrawnCurve drawn(const Curve& curve, const Axis& x, const Axis& y, const Area& area) {
    DrawnCurve made;
    if (curve.background != Background::none) return made;
    Clipper clipper(area, made.lines);
    PointReducer thinner(clipper);
    const bool dense = static_cast<float>(curve.x.size()) > 2 * area.width();
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
        const Place at{pixel(x, curve.x[i]), pixel(y, curve.y[i])};
        if (!std::isfinite(at.x) || !std::isfinite(at.y)) {
            thinner.lift();
            continue;
        }
        if (curve.mark == Mark::line || curve.mark == Mark::both) dense ? thinner.add(at) : clipper.move(at);
        const bool inside = at.x >= area.left && at.x <= area.right && at.y >= area.top && at.y <= area.bottom;
        // a value between two gaps is drawn as a dot, otherwise it would be invisible
        const auto gap = [&](std::size_t k) {
            return k >= curve.x.size() || !std::isfinite(pixel(x, curve.x[k]) + pixel(y, curve.y[k]));
        };
        if (inside && (curve.mark != Mark::line || (gap(i - 1) && gap(i + 1))))
            made.points.push_back({static_cast<float>(at.x), static_cast<float>(at.y)});
    }
    thinner.flush();
    return made;
}

Color curve_color(const Curve& curve, const PlotStyle& style, bool over_map) {
    if (over_map && curve.quiet) return rgb(0xffffff);
    const Theme& theme = over_map ? themes.front() : style.theme;
    if (curve.quiet) return curve.mark == Mark::points ? theme.quiet_text : theme.cursor;
    return theme.palette[static_cast<std::size_t>(curve.hue) % theme.palette.size()];
}

void draw_band(const Curve& curve, const Axis& x, const Axis& y, const Area& area, const PlotStyle& style,
               PageList& list) {
    if (curve.background != Background::none) draw_background(curve, x, y, area, style, list);
    if (curve.uncertainty.empty()) return;
    Polylines band{.lines = {}, .color = curve_color(curve, style, false).with_alpha(0.2f), .within = area};
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
        const double at = pixel(x, curve.x[i]), lower = pixel(y, low), upper = pixel(y, curve.y[i] + wide);
        if (!std::isfinite(at + lower + upper)) {
            end();
            continue;
        }
        above.push_back(place(at, upper));
        below.push_back(place(at, lower));
    }
    end();
    list.push_back(std::move(band));
}

void draw_line(const std::vector<std::vector<Point>>& lines, float width, bool dashed, Color color,
               const PlotStyle& style, PageList& list) {
    if (lines.empty()) return;
    const float dash = dashed ? std::max(9 * style.unit, 5.0f) + width : 0;
    list.push_back(Polylines{lines, width, color, dash, std::max(7 * style.unit, 4.0f) + width});
}

void draw_curve(const Curve& curve, const DrawnCurve& drawn, const Area& area, const PlotStyle& style, bool over_map,
                PageList& list) {
    const Color color = curve_color(curve, style, over_map), edge = rgb(0x0b0e13).with_alpha(0.75f);
    const bool thin = (curve.quiet && !over_map) || curve.x.size() > many;
    const float width = thin ? style.thin : style.curve;
    const float casing = std::max(1.6f * style.unit, 1.0f);
    if (over_map) draw_line(drawn.lines, width + 2 * casing, false, edge, style, list);
    draw_line(drawn.lines, width, curve.dashed, color, style, list);

    float radius = curve.quiet ? 0.75f * style.marker : style.marker;
    if (curve.mark == Mark::line) radius = 0.8f * width;
    if (drawn.marks_in_panel > many) {
        // px for unit 1: the width of a panel to which `many` refers, and the smallest marks that give no moiré pattern
        constexpr float wide = 450, minimum = 1;
        const float side = std::sqrt(std::max(area.width(), 0.0f) * std::max(area.height(), 0.0f)) / style.unit;
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
