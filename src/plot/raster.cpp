#include "plot/chart_parts.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// How much of each pixel of an area is covered, 0…1.
class CoverageRaster {
public:
    CoverageRaster(const Area& area, float scale)
        : left(static_cast<int>(std::floor(area.left * scale))),
          top(static_cast<int>(std::floor(area.top * scale))),
          size{std::max(1, static_cast<int>(std::ceil(area.right * scale)) - left),
               std::max(1, static_cast<int>(std::ceil(area.bottom * scale)) - top)},
          values(static_cast<std::size_t>(size.width) * size.height) {}

    void cover(int x, int y, float part) {
        float& value = values[static_cast<std::size_t>(y) * size.width + x];
        value = std::max(value, part);
    }

    Image image(Color color, float scale) const {
        auto pixels = std::make_shared<Picture>(size);
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (values[i] == 0) continue;
            std::ranges::copy(bytes_of(color.with_alpha(color.a * values[i])), &pixels->rgba[4 * i]);
        }
        const auto px = [&](int v) { return static_cast<float>(v) / scale; };
        return {px(left), px(top), px(left + size.width), px(top + size.height), std::move(pixels)};
    }

    const int left, top;  // device pixels
    const Size size;

private:
    std::vector<float> values;
};

}  // namespace

Image scatter_image(const std::vector<Point>& points, float radius, Color color, const Area& area, float scale) {
    CoverageRaster coverage(area, scale);
    const float reach = std::max(radius * scale, 0.5f);
    for (const Point& point : points) {
        const float x = point.x * scale - static_cast<float>(coverage.left);
        const float y = point.y * scale - static_cast<float>(coverage.top);
        const int right = std::min(static_cast<int>(std::ceil(x + reach)), coverage.size.width - 1);
        const int bottom = std::min(static_cast<int>(std::ceil(y + reach)), coverage.size.height - 1);
        for (int row = std::max(static_cast<int>(y - reach) - 1, 0); row <= bottom; ++row) {
            for (int column = std::max(static_cast<int>(x - reach) - 1, 0); column <= right; ++column) {
                const float dx = static_cast<float>(column) + 0.5f - x, dy = static_cast<float>(row) + 0.5f - y;
                const float part = 0.5f + reach - std::sqrt(dx * dx + dy * dy);
                if (part > 0) coverage.cover(column, row, std::min(part, 1.0f));
            }
        }
    }
    return coverage.image(color, scale);
}

}  // namespace doppel
