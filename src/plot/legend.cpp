#include "plot/labels.hpp"
#include "plot/text.hpp"
#include "render/font.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace doppel {
namespace {

constexpr float square = 3;  // px

std::uint64_t bit(std::size_t owner) {
    return std::uint64_t{1} << (owner % LabelPlacer::no_owner);
}

}  // namespace

LabelPlacer::LabelPlacer(const Area& area)
    : area_(area),
      columns_(std::max(1, static_cast<int>(std::ceil(area.width() / square)))),
      rows_(std::max(1, static_cast<int>(std::ceil(area.height() / square)))),
      drawn_(static_cast<std::size_t>(columns_) * rows_) {}

void LabelPlacer::add_line(Point from, Point to, std::size_t owner) {
    const float length = std::max(std::abs(to.x - from.x), std::abs(to.y - from.y));
    const int steps = 1 + static_cast<int>(length / square * 1.5f);
    for (int i = 0; i <= steps; ++i) {
        const float part = static_cast<float>(i) / static_cast<float>(steps);
        const int column = static_cast<int>((std::lerp(from.x, to.x, part) - area_.left) / square);
        const int row = static_cast<int>((std::lerp(from.y, to.y, part) - area_.top) / square);
        if (column < 0 || row < 0 || column >= columns_ || row >= rows_) continue;
        drawn_[static_cast<std::size_t>(row) * columns_ + column] |= bit(owner);
    }
}

LabelPlacer::Squares LabelPlacer::squares(const Area& box) const {
    const auto within = [](float v, int most) {
        return static_cast<int>(std::clamp(v, 0.0f, static_cast<float>(most)));
    };
    return {within(std::floor((box.left - area_.left) / square), columns_),
            within(std::floor((box.top - area_.top) / square), rows_),
            within(std::ceil((box.right - area_.left) / square), columns_),
            within(std::ceil((box.bottom - area_.top) / square), rows_)};
}

int LabelPlacer::ink(const Area& box, std::size_t except) const {
    const std::uint64_t others = except == no_owner ? ~std::uint64_t{0} : ~bit(except);
    const Squares part = squares(box);
    int count = 0;
    for (int row = part.top; row < part.bottom; ++row)
        for (int column = part.left; column < part.right; ++column)
            count += (drawn_[static_cast<std::size_t>(row) * columns_ + column] & others) != 0;
    return count;
}

bool LabelPlacer::is_free(const Area& box) const {
    return area_.holds(box) &&
           std::none_of(texts_.begin(), texts_.end(), [&](const Area& text) { return text.overlaps(box); });
}

namespace {

/// The emptiest place for a box of this size.
std::optional<Point> emptiest(float width, float height, float margin, const LabelPlacer& placer) {
    constexpr int steps = 20;
    const Area& area = placer.area();
    const float across = area.width() - width - 2 * margin, down = area.height() - height - 2 * margin;
    if (across < 0 || down < 0) return {};
    std::optional<Point> best;
    float least = 0;
    for (int row = 0; row <= steps; ++row) {
        for (int column = steps; column >= 0; --column) {
            const float left = area.left + margin + across * static_cast<float>(column) / steps;
            const float top = area.top + margin + down * static_cast<float>(row) / steps;
            const Area box{left, top, left + width, top + height};
            if (!placer.is_free(box)) continue;
            const bool side = column == 0 || column == steps, end = row == 0 || row == steps;
            const float cost = static_cast<float>(placer.ink(box)) + (side && end ? 0 : side || end ? 6.0f : 15.0f);
            if (!best || cost < least) best = Point{left, top}, least = cost;
        }
    }
    return best;
}

/// A short piece of the curve.
void draw_sample(const Curve& curve, float left, float right, float y, const PlotStyle& style, bool over_map,
                 DisplayList& list) {
    DrawnCurve sample;
    const float middle = (left + right) / 2;
    if (curve.mark != Mark::points) sample.lines.push_back({{left, y}, {right, y}});
    if (curve.mark != Mark::line) sample.points.push_back({middle, y});
    draw_curve(curve, sample, {}, style, over_map, list);
}

// of a legend's parts, em
constexpr float row = 1.4f, pad = 0.5f, sample = 1.7f, gap = 0.5f;

}  // namespace

std::optional<Legend> fitted_legend(const std::vector<Curve>& curves, std::vector<std::size_t> which,
                                    const PlotStyle& style, const LabelPlacer& placer) {
    for (float size = 0.95f * style.text; size > 0.6f * style.text; size *= 0.9f) {
        float widest = 0;
        for (const std::size_t i : which) widest = std::max(widest, text_width(curves[i].label, size));
        const float width = (2 * pad + sample + gap) * size + widest;
        const float height = (2 * pad - 0.35f + row * static_cast<float>(which.size())) * size;
        if (const auto at = emptiest(width, height, 0.5f * size, placer))
            return Legend{std::move(which), {at->x, at->y, at->x + width, at->y + height}, size};
    }
    return {};
}

void draw_legend(const Legend& legend, const std::vector<Curve>& curves, const PlotStyle& style, bool over_map,
                 DisplayList& list) {
    const auto& [which, box, size] = legend;
    const Color background = over_map ? rgb(0x0b0e13).with_alpha(0.7f) : style.theme.background.with_alpha(0.88f);
    list.push_back(Box{box.left, box.top, box.right, box.bottom, 0.3f * size, background});
    const float left = box.left + pad * size, right = left + sample * size;
    float baseline = box.top + (pad + 0.8f) * size;
    for (const std::size_t i : which) {
        draw_sample(curves[i], left, right, baseline - 0.3f * size, style, over_map, list);
        list.push_back(
            label(curves[i].label, {right + gap * size, baseline}, size, over_map ? rgb(0xffffff) : style.theme.text));
        baseline += row * size;
    }
}

}  // namespace doppel
