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

Image band_image(const Band& band, Color color, const Area& area, float scale) {
    CoverageRaster coverage(area, scale);
    for (std::size_t i = 0; i + 1 < band.x.size(); ++i) {
        const std::size_t a = band.x[i] <= band.x[i + 1] ? i : i + 1, b = 2 * i + 1 - a;
        const double from = band.x[a] * scale - coverage.left, to = band.x[b] * scale - coverage.left;
        const double sum = from + to + band.low[a] + band.low[b] + band.high[a] + band.high[b];
        if (!std::isfinite(sum)) continue;
        const int end = static_cast<int>(std::min(std::ceil(to - 0.5), static_cast<double>(coverage.size.width)));
        for (int column = static_cast<int>(std::ceil(std::clamp(from - 0.5, 0.0, 1e9))); column < end; ++column) {
            // both edges at the middle of the pixel's column
            const double part = to > from ? (column + 0.5 - from) / (to - from) : 0;
            const auto edge = [&](const std::vector<double>& y) {
                const double at = std::lerp(y[a], y[b], part) * scale - coverage.top;
                return static_cast<float>(std::clamp(at, 0.0, static_cast<double>(coverage.size.height)));
            };
            const float low = edge(band.low), high = edge(band.high);
            const float upper = std::min(low, high), lower = std::max(low, high);
            for (int row = static_cast<int>(upper);
                 row < std::min(static_cast<int>(std::ceil(lower)), coverage.size.height); ++row) {
                const auto pixel = static_cast<float>(row);
                coverage.cover(column, row, std::min(lower, pixel + 1) - std::max(upper, pixel));
            }
        }
    }
    return coverage.image(color, scale);
}

}  // namespace doppel
