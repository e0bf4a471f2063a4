#include "plot/chart_parts.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {

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
    return {px(left), px(top), px(left + size.width), px(top + size.height), std::move(pixels)};
}

}  // namespace doppel
