#include "film/layout.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

// in units of the picture's height: curves of a strip; circles of a pair for which strips still go below
constexpr float min_curves = 0.2f, max_curves = 0.34f, min_circle = 0.45f;
// in units of the area: all strips below panels; a column of strips
constexpr float max_below = 0.62f, min_column = 0.285f;

constexpr std::size_t max_in_row = 3;  // strips in a row below panels

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
    const float square = room.height() - needs.heading, minimum = min_column * room.width();
    const float column = needs.panels == 1 ? std::max(room.width() - square - needs.gap, minimum) : minimum;
    const float part = std::round(room.right - column);
    return {panel_areas({room.left, room.top, part - needs.gap, room.bottom}, needs, false),
            strip_cells({part, room.top, room.right, room.bottom}, needs, 1)};
}

}  // namespace

Regions split(const Area& room, const RegionNeeds& needs) {
    if (needs.panels == 0) return {{}, strip_cells(room, needs, needs.strips > max_in_row ? 2 : 1)};
    const bool can_stack = needs.tall && needs.panels > 1;
    if (needs.strips == 0) return {panel_areas(room, needs, can_stack), {}};
    if (needs.tall) {
        auto beside = with_strips_below(room, needs, 1, false), stacked = with_strips_below(room, needs, 1, true);
        return can_stack && circle_in(stacked) > circle_in(beside) ? stacked : beside;
    }
    if (needs.panels > 1 && needs.strips <= max_in_row) {
        auto below = with_strips_below(room, needs, needs.strips, false);
        if (circle_in(below) >= min_circle * needs.height) return below;
    }
    return with_strips_beside(room, needs);
}

}  // namespace doppel
