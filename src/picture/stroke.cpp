#include "picture/stroke.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

constexpr float hair = 1.0f / 10;  // px

/// Whether the segment from…to stands for the vertex `v` as well.
bool passes(const Stroke::Vertex& from, const Stroke::Vertex& to, const Stroke::Vertex& v) {
    const Point along{to.at.x - from.at.x, to.at.y - from.at.y}, out{v.at.x - from.at.x, v.at.y - from.at.y};
    const float square = along.x * along.x + along.y * along.y;
    const float part = square > 0 ? std::clamp((along.x * out.x + along.y * out.y) / square, 0.f, 1.f) : 0;
    const float x = out.x - part * along.x, y = out.y - part * along.y;
    return x * x + y * y <= hair * hair && std::abs(std::lerp(from.alpha, to.alpha, part) - v.alpha) <= 1.0f / 255 &&
           std::abs(std::lerp(from.width, to.width, part) - v.width) <= 2 * hair &&
           std::abs(std::lerp(from.glow, to.glow, part) - v.glow) <= 5 * hair;
}

}  // namespace

std::size_t straight_until(const std::vector<Stroke::Vertex>& path, std::size_t first, std::size_t reach) {
    const std::size_t end = std::min(path.size(), first + 1 + reach);
    std::size_t last = first + 1;
    while (last + 1 < end) {
        const std::size_t next = last + 1;
        for (std::size_t between = first + 1; between < next; ++between) {
            if (!passes(path[first], path[next], path[between])) return last;
        }
        last = next;
    }
    return last;
}

}  // namespace doppel
