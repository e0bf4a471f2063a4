#include "render/render_list.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <unordered_set>
#include <utility>

namespace doppel {
namespace {

constexpr long rect_overhead = 3000;  // one more rectangle costs as much time as restoring and reading this many pixels

long area(const Rect& r) {
    return long{r.right - r.left} * (r.bottom - r.top);
}

bool cheaper_as_one(const Rect& a, const Rect& b) {
    return area(united(a, b)) <= area(a) + area(b) + rect_overhead;
}

/// Adds the parts of `rect` that lie outside all of disjoint[from…].
void add_outside(const Rect& rect, std::size_t from, std::vector<Rect>& disjoint) {
    if (rect.empty()) return;
    for (std::size_t i = from; i < disjoint.size(); ++i) {
        const Rect hole = intersection(rect, disjoint[i]);
        if (hole.empty()) continue;
        add_outside({rect.left, rect.top, rect.right, hole.top}, i + 1, disjoint);
        add_outside({rect.left, hole.bottom, rect.right, rect.bottom}, i + 1, disjoint);
        add_outside({rect.left, hole.top, hole.left, hole.bottom}, i + 1, disjoint);
        add_outside({hole.right, hole.top, rect.right, hole.bottom}, i + 1, disjoint);
        return;
    }
    disjoint.push_back(rect);
}

struct PrimitiveHash {
    std::size_t operator()(const Primitive& q) const {
        std::size_t hash = 0;
        for (const float value :
             {q.origin.x, q.origin.y, q.axis.x, q.half.x, q.half.y, q.shape[1], q.shape[2], q.shape[3]})
            hash = (hash ^ std::bit_cast<std::uint32_t>(value)) * 0x9e3779b97f4a7c15u;
        return hash ^ hash >> 29;
    }
};

/// Calls visit(rect) for disjoint rectangles that cover the primitive: its bounds, or strips if it is long and slanted.
template <class Visit>
void for_each_band(const Primitive& primitive, const Visit& visit) {
    const Rect& bounds = primitive.bounds;
    const float across = std::abs(primitive.axis.x), down = std::abs(primitive.axis.y);
    const int thick = 16 + 4 * static_cast<int>(std::min(primitive.half.y, 1000.f));
    const int shorter = std::min(bounds.right - bounds.left, bounds.bottom - bounds.top);
    if (shorter < 3 * thick || !(primitive.half.x > 2 * primitive.half.y) || std::min(across, down) < 0.05f)
        return visit(bounds);
    // cut along the axis closest to its direction; 0.05 px for rounding
    const bool steep = down > across;
    const float slope = steep ? primitive.axis.x / primitive.axis.y : primitive.axis.y / primitive.axis.x;
    const float margin = primitive.half.y / std::max(across, down) + 0.05f;
    const float middle = steep ? primitive.origin.x : primitive.origin.y,
                start = steep ? primitive.origin.y : primitive.origin.x;
    const int end = steep ? bounds.bottom : bounds.right;
    for (int a = steep ? bounds.top : bounds.left; a < end; a += thick) {
        const int b = std::min(a + thick, end);
        const float at_a = middle + slope * (static_cast<float>(a) - start);
        const float at_b = middle + slope * (static_cast<float>(b) - start);
        const int low = static_cast<int>(std::floor(std::min(at_a, at_b) - margin));
        const int high = static_cast<int>(std::ceil(std::max(at_a, at_b) + margin));
        const Rect band = intersection(bounds, steep ? Rect{low, a, high, b} : Rect{a, low, b, high});
        if (!band.empty()) visit(band);
    }
}

using Primitives = std::span<const Primitive>;

/// For strokes: the order and repetition of their primitives does not change the picture.
template <class Add>
void compare_masks(Primitives olds, Primitives news, const Add& add) {
    // most of a path is usually unchanged
    while (!olds.empty() && !news.empty() && olds.front() == news.front())
        olds = olds.subspan(1), news = news.subspan(1);
    while (!olds.empty() && !news.empty() && olds.back() == news.back())
        olds = olds.first(olds.size() - 1), news = news.first(news.size() - 1);
    using Set = std::unordered_set<Primitive, PrimitiveHash>;
    const Set old_set(olds.begin(), olds.end()), new_set(news.begin(), news.end());
    for (const auto& primitive : olds)
        if (!new_set.contains(primitive)) for_each_band(primitive, add);
    for (const auto& primitive : news)
        if (!old_set.contains(primitive)) for_each_band(primitive, add);
}

/// A few disjoint rectangles that cover all of `rects`. Rectangles are joined if that is cheaper to draw.
std::vector<Rect> merged(std::vector<Rect> rects) {
    // a rectangle that grows is compared with all others again
    for (std::size_t i = 0; i < rects.size(); ++i) {
        for (std::size_t j = 0; j < rects.size(); ++j) {
            if (i == j || !cheaper_as_one(rects[i], rects[j])) continue;
            rects[std::min(i, j)] = united(rects[i], rects[j]);
            rects[std::max(i, j)] = rects.back();
            rects.pop_back();
            i = std::min(i, j);
            j = static_cast<std::size_t>(-1);
        }
    }
    std::vector<Rect> disjoint;
    for (const Rect& rect : rects) add_outside(rect, 0, disjoint);
    return disjoint;
}

}  // namespace

std::vector<Rect> dirty_regions(const RenderList& before, const RenderList& after) {
    std::vector<Rect> touched;
    const auto add = [&](const Rect& rect) {  // neighbours along a path are joined if that is cheaper
        if (!touched.empty() && cheaper_as_one(touched.back(), rect))
            touched.back() = united(touched.back(), rect);
        else
            touched.push_back(rect);
    };
    for (std::size_t p = 0; p < std::max(before.parts.size(), after.parts.size()); ++p) {
        const auto part_of = [&](const RenderList& list) {
            return p < list.parts.size() ? list.parts[p] : RenderList::Part{.kind = Kind::shape};
        };
        const auto old = part_of(before), now = part_of(after);
        const auto olds = Primitives(before.primitives).subspan(old.begin, old.end - old.begin),
                   news = Primitives(after.primitives).subspan(now.begin, now.end - now.begin);
        if (old.kind == Kind::mask && now.kind == Kind::mask) {
            compare_masks(olds, news, add);
            continue;
        }
        for (std::size_t k = 0; k < std::max(olds.size(), news.size()); ++k) {
            const bool is_old = k < olds.size(), is_new = k < news.size();
            if (is_old && is_new && old.kind == now.kind && olds[k] == news[k]) continue;
            if (is_old) for_each_band(olds[k], add);
            if (is_new) for_each_band(news[k], add);
        }
    }
    return merged(std::move(touched));
}

}  // namespace doppel
