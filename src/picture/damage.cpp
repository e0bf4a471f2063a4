#include "picture/damage.hpp"

#include "picture/sketch.hpp"

#include <algorithm>

namespace doppel {
namespace {

constexpr long price_of_a_rect = 8192;  // as many pixels could be restored and read in the time one more costs

long area(const Rect& r) {
    return long{r.right - r.left} * (r.bottom - r.top);
}

}  // namespace

std::vector<Rect> merged(std::vector<Rect> rects) {
    // take each rectangle in turn; what it swallows makes it larger, so it looks at all others again
    for (std::size_t i = 0; i < rects.size(); ++i) {
        for (std::size_t j = 0; j < rects.size(); ++j) {
            if (i == j) continue;
            const Rect both = united(rects[i], rects[j]);
            if (area(both) > area(rects[i]) + area(rects[j]) + price_of_a_rect) continue;
            rects[std::min(i, j)] = both;
            rects[std::max(i, j)] = rects.back();
            rects.pop_back();
            i = std::min(i, j);
            j = static_cast<std::size_t>(-1);
        }
    }
    return rects;
}

std::vector<Rect> chunks(const std::vector<Rect>& bounds, std::size_t begin, std::size_t end) {
    constexpr std::size_t few = 16;
    std::vector<Rect> covers;
    for (std::size_t i = begin; i < end; ++i) {
        if ((i - begin) % few == 0) covers.emplace_back();
        covers.back() = united(covers.back(), bounds[i]);
    }
    return covers;
}

std::vector<Rect> damage(const Sketch& before, const Sketch& after) {
    std::vector<Rect> touched;
    // the rectangles of quads that come one after another are neighbours: gather them first
    std::vector<Rect> bounds;
    const auto add_part = [&](const Sketch& sketch, const Sketch::Part& part, const std::vector<bool>& same) {
        bounds.clear();
        for (std::size_t i = part.begin; i < part.end; ++i) {
            const std::size_t k = i - part.begin;
            if (k >= same.size() || !same[k]) bounds.push_back(sketch.bounds[i]);
        }
        const std::vector<Rect> covers = chunks(bounds, 0, bounds.size());
        touched.insert(touched.end(), covers.begin(), covers.end());
    };

    // a cover shows nothing by itself: its stroke's mask holds the colour too
    std::vector<bool> same;
    for (std::size_t p = 0; p < std::max(before.parts.size(), after.parts.size()); ++p) {
        const Sketch::Part* old = p < before.parts.size() ? &before.parts[p] : nullptr;
        const Sketch::Part* now = p < after.parts.size() ? &after.parts[p] : nullptr;
        same.clear();
        if (old && now && old->kind == now->kind) {
            const std::size_t shared = std::min(old->end - old->begin, now->end - now->begin);
            for (std::size_t k = 0; k < shared; ++k) {
                same.push_back(before.quads[old->begin + k] == after.quads[now->begin + k]);
            }
        }
        if (old && old->kind != Kind::cover) add_part(before, *old, same);
        if (now && now->kind != Kind::cover) add_part(after, *now, same);
    }
    return merged(std::move(touched));
}

}  // namespace doppel
