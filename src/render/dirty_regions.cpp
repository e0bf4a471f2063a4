#include "render/render_list.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
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

/// Rectangles along a path; joins neighbours if that is cheaper.
class RectChain {
public:
    void add(const Rect& rect) {
        if (!rects_.empty() && cheaper_as_one(rects_.back(), rect)) {
            rects_.back() = united(rects_.back(), rect);
        } else {
            rects_.push_back(rect);
        }
    }
    std::vector<Rect> take() { return std::move(rects_); }

private:
    std::vector<Rect> rects_;
};

std::size_t hash_of(const Primitive& q) {
    std::size_t hash = 0;
    const auto mix = [&](float value) { hash = (hash ^ std::bit_cast<std::uint32_t>(value)) * 0x9e3779b97f4a7c15u; };
    for (const float value : {q.origin.x, q.origin.y, q.axis.x, q.half.x, q.half.y, q.shape[1], q.shape[2], q.shape[3]})
        mix(value);
    return hash ^ hash >> 29;
}

/// Looks up the primitives of a part.
class PrimitiveSet {
public:
    PrimitiveSet(const RenderList& items, const RenderList::Part& part) : items_(items) {
        for (std::size_t i = part.begin; i < part.end; ++i) places_.emplace_back(hash_of(items.primitives[i]), i);
        std::sort(places_.begin(), places_.end());
    }
    bool has(const Primitive& primitive, const Rect& bounds) const {
        const auto hash = hash_of(primitive);
        auto at = std::lower_bound(places_.begin(), places_.end(), std::pair{hash, std::size_t{0}});
        for (; at != places_.end() && at->first == hash; ++at)
            if (items_.primitives[at->second] == primitive && items_.bounds[at->second] == bounds) return true;
        return false;
    }

private:
    const RenderList& items_;
    std::vector<std::pair<std::size_t, std::size_t>> places_;
};

/// Calls visit(rect) for disjoint rectangles that cover the primitive: its bounds, or strips if it is long and slanted.
template <class Visit>
void for_each_band(const Primitive& primitive, const Rect& bounds, const Visit& visit) {
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

/// For strokes: the order and repetition of their primitives does not change the picture.
template <class Add>
void compare_masks(const RenderList& before, RenderList::Part old, const RenderList& after, RenderList::Part now,
                   const Add& add) {
    // most of a path is usually unchanged
    const auto same = [&](std::size_t i, std::size_t j) {
        return before.bounds[i] == after.bounds[j] && before.primitives[i] == after.primitives[j];
    };
    while (old.begin < old.end && now.begin < now.end && same(old.begin, now.begin)) ++old.begin, ++now.begin;
    while (old.begin < old.end && now.begin < now.end && same(old.end - 1, now.end - 1)) --old.end, --now.end;
    const PrimitiveSet olds(before, old), news(after, now);
    for (std::size_t i = old.begin; i < old.end; ++i)
        if (!news.has(before.primitives[i], before.bounds[i]))
            for_each_band(before.primitives[i], before.bounds[i], add);
    for (std::size_t j = now.begin; j < now.end; ++j)
        if (!olds.has(after.primitives[j], after.bounds[j])) for_each_band(after.primitives[j], after.bounds[j], add);
}

}  // namespace

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

std::vector<Rect> dirty_regions(const RenderList& before, const RenderList& after) {
    RectChain touched;
    for (std::size_t p = 0; p < std::max(before.parts.size(), after.parts.size()); ++p) {
        const RenderList::Part none{.kind = Kind::shape};
        const RenderList::Part& old = p < before.parts.size() ? before.parts[p] : none;
        const RenderList::Part& now = p < after.parts.size() ? after.parts[p] : none;
        const std::size_t olds = old.end - old.begin, nows = now.end - now.begin;
        const auto add = [&](const Rect& r) { touched.add(r); };
        if (old.kind == Kind::mask && now.kind == Kind::mask) {
            compare_masks(before, old, after, now, add);
            continue;
        }
        for (std::size_t k = 0; k < std::max(olds, nows); ++k) {
            const std::size_t i = old.begin + k, j = now.begin + k;
            if (k < olds && k < nows && old.kind == now.kind && before.bounds[i] == after.bounds[j] &&
                before.primitives[i] == after.primitives[j])
                continue;
            if (k < olds) for_each_band(before.primitives[i], before.bounds[i], add);
            if (k < nows) for_each_band(after.primitives[j], after.bounds[j], add);
        }
    }
    return merged(touched.take());
}

}  // namespace doppel
