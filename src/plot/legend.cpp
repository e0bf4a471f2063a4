#include "plot/labels.hpp"
#include "render/typeface.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace doppel {
namespace {

/// A position for a box of this size where nothing is drawn, preferably a corner.
std::optional<Point> empty_place(float width, float height, float margin, const LabelPlacer& placer) {
    constexpr int steps = 20;
    const Area& area = placer.area();
    const float across = area.width() - width - 2 * margin, down = area.height() - height - 2 * margin;
    if (across < 0 || down < 0) return {};
    std::optional<Point> best;
    float minimum = 0;
    for (int row = 0; row <= steps; ++row) {
        for (int column = steps; column >= 0; --column) {
            const float left = area.left + margin + across * static_cast<float>(column) / steps;
            const float top = area.top + margin + down * static_cast<float>(row) / steps;
            const Area box{left, top, left + width, top + height};
            if (!placer.is_free(box) || placer.ink(box) > 0) continue;
            const bool side = column == 0 || column == steps, end = row == 0 || row == steps;
            const float cost = side && end ? 0 : side || end ? 6.0f : 15.0f;
            if (!best || cost < minimum) best = Point{left, top}, minimum = cost;
        }
    }
    return best;
}

void draw_sample(const Curve& curve, float left, float right, float y, const Panel& panel) {
    DrawnCurve sample;
    const float middle = (left + right) / 2;
    if (curve.mark != Mark::points) sample.lines.push_back({{left, y}, {right, y}});
    if (curve.mark != Mark::line) sample.points.push_back({middle, y});
    draw_curve(curve, sample, panel);
}

// dimensions of a legend, em
constexpr float row = 1.4f, pad = 0.5f, sample = 1.7f, gap = 0.5f;

float legend_width(const std::vector<Curve>& curves, const std::vector<std::size_t>& which, float size) {
    float widest = 0;
    for (const std::size_t i : which) widest = std::max(widest, text_width(curves[i].label, size));
    return (2 * pad + sample + gap) * size + widest;
}
/// Its height, em.
float legend_rows(std::size_t count) {
    return 2 * pad - 0.35f + row * static_cast<float>(count);
}

}  // namespace

std::optional<Legend> fitted_legend(const std::vector<Curve>& curves, std::vector<std::size_t> which, float size,
                                    const LabelPlacer& placer) {
    const float width = legend_width(curves, which, size);
    const float height = legend_rows(which.size()) * size;
    const auto at = empty_place(width, height, 0.5f * size, placer);
    if (!at) return {};
    return Legend{std::move(which), {at->x, at->y, at->x + width, at->y + height}, size};
}

float legend_gutter(const std::vector<Curve>& curves, float size) {
    std::vector<std::size_t> all(curves.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return legend_width(curves, all, size);
}

Legend legend_in(const Area& area, const std::vector<Curve>& curves, std::vector<std::size_t> which, float maximum) {
    const float width = legend_width(curves, which, 1), height = legend_rows(which.size());
    const float size = std::min({maximum, area.width() / width, area.height() / height});
    return {std::move(which), {area.left, area.top, area.left + width * size, area.top + height * size}, size};
}

void draw_legend(const Legend& legend, const Panel& panel) {
    const auto& [which, box, size] = legend;
    const Theme& theme = panel.style.theme;
    const bool over_map = panel.is_map();
    const Color background = over_map ? rgb(0x0b0e13).with_alpha(0.7f) : theme.background.with_alpha(0.88f);
    panel.list.push_back(Box{box.left, box.top, box.right, box.bottom, 0.3f * size, background});
    const float left = box.left + pad * size, right = left + sample * size;
    float baseline = box.top + (pad + 0.8f) * size;
    for (const std::size_t i : which) {
        const Curve& curve = panel.plot.curves[i];
        draw_sample(curve, left, right, baseline - 0.3f * size, panel);
        panel.list.push_back(
            label(curve.label, {right + gap * size, baseline}, size, over_map ? rgb(0xffffff) : theme.text));
        baseline += row * size;
    }
}

}  // namespace doppel
