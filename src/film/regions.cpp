#include "film/layout.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

// of the picture's height
constexpr float least_circle = 0.555f, usual_circle = 0.6f, most_strips = 0.3f;
// of the width
constexpr float least_column = 0.23f;
// px of a 1920×1080 picture: heights of a strip's curves
constexpr float least_curve = 60, enough_curve = 110;

/// Panels side by side, or one above the other, each below its heading.
std::vector<Area> panel_areas(const Area& room, const RegionNeeds& needs) {
    const auto n = static_cast<float>(needs.panels);
    const float gaps = (n - 1) * needs.gap;
    const float width = needs.tall ? room.width() : std::floor((room.width() - gaps) / n);
    const float height = std::floor(needs.tall ? (room.height() - gaps) / n : room.height());
    std::vector<Area> areas;
    for (std::size_t k = 0; k < needs.panels; ++k) {
        const auto i = static_cast<float>(k);
        const float left = room.left + (needs.tall ? 0 : i * (width + needs.gap)),
                    top = room.top + (needs.tall ? i * (height + needs.gap) : 0);
        areas.push_back({left, std::round(top + needs.heading), left + width, std::round(top + height)});
    }
    return areas;
}

/// What strips take besides the curves where each has a caption of one line.
float words_of(const RegionNeeds& needs) {
    const auto count = static_cast<float>(needs.strips.size());
    return needs.text * (time_labels_height + count * (caption_line + caption_edge)) + needs.gap / 3;
}

/// Panels as high as their circles want, up to squares; of what they leave, the strips get no more than serves them.
Regions with_strips_below(const Area& room, const RegionNeeds& needs) {
    const auto count = static_cast<float>(needs.strips.size()), n = static_cast<float>(needs.panels);
    const float words = words_of(needs);
    float strips = 0;
    if (needs.tall) {
        const float squares = n * (room.width() + needs.heading) + (n - 1) * needs.gap;
        const float least = std::min(words + 85 * count * needs.text, 0.55f * room.height());
        strips = std::max(least, room.height() - squares);
    } else {
        // the panels get more than the least as soon as the curves have enough
        const float least = least_circle * needs.height * around_circle, most = usual_circle / least_circle * least;
        const float left = room.height() - needs.heading - words - enough_curve * count * needs.text;
        const float square = (room.width() - needs.gap) / 2;
        strips = room.height() - std::min(std::clamp(left, least, most), square) - needs.heading;
    }
    strips = std::min(strips, words + most_strips * needs.height);
    const float split = std::round(room.bottom - strips);
    return {panel_areas({room.left, room.top, room.right, split}, needs),
            {room.left, split + needs.gap / 3, room.right, room.bottom}};
}

Regions with_strips_beside(const Area& room, const RegionNeeds& needs, float column) {
    const float split = std::round(room.right - column);
    return {panel_areas({room.left, room.top, split - needs.gap, room.bottom}, needs),
            {split, room.top, room.right, room.bottom}};
}

}  // namespace

Regions split_regions(const Area& room, const RegionNeeds& needs) {
    if (needs.panels == 0) return {{}, room};
    if (needs.strips.empty()) return {panel_areas(room, needs), {}};
    if (needs.tall) return with_strips_below(room, needs);
    if (needs.panels == 1) {
        const float square = room.height() - needs.heading;
        return with_strips_beside(room, needs,
                                  std::max(room.width() - square - needs.gap, least_column * room.width()));
    }
    const auto count = static_cast<float>(needs.strips.size());
    const float panels = least_circle * needs.height * around_circle + needs.heading;
    const float curves = room.height() - panels - words_of(needs);
    if (count <= 2 && curves >= least_curve * needs.text * count) return with_strips_below(room, needs);
    return with_strips_beside(room, needs, least_column * room.width());
}

}  // namespace doppel
