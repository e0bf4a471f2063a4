#include "render/render_list.hpp"

#include <algorithm>
#include <functional>
#include <span>
#include <string_view>
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

/// Of all bytes; there is no padding.
struct PrimitiveHash {
    std::size_t operator()(const Primitive& q) const {
        return std::hash<std::string_view>()({reinterpret_cast<const char*>(&q), sizeof q});
    }
};

using Primitives = std::span<const Primitive>;

/// For strokes: the order and repetition of their primitives does not change the picture.
template <class Add>
void compare_masks(Primitives olds, Primitives news, const Add& add) {
    // most of a path is usually unchanged
    const auto same = static_cast<std::size_t>(std::ranges::mismatch(olds, news).in1 - olds.begin());
    olds = olds.subspan(same), news = news.subspan(same);
    using Set = std::unordered_set<Primitive, PrimitiveHash>;
    const Set old_set(olds.begin(), olds.end()), new_set(news.begin(), news.end());
    for (const auto& primitive : olds)
        if (!new_set.contains(primitive)) add(primitive.bounds);
    for (const auto& primitive : news)
        if (!old_set.contains(primitive)) add(primitive.bounds);
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
            if (is_old) add(olds[k].bounds);
            if (is_new) add(news[k].bounds);
        }
    }
    return merged(std::move(touched));
}

}  // namespace doppel
