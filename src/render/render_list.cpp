#include "render/render_list.hpp"

#include "base/error.hpp"
#include "render/stroke.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <string_view>
#include <unordered_set>

namespace doppel {
namespace {

constexpr float edge = 1;  // width of a soft edge, px; half of it lies outside the shape

std::array<std::uint8_t, 4> tint(const Color& color, float opacity = 1) {
    return bytes_of(color.with_alpha(color.a * opacity));
}

/// Converts items to primitives. Lines thinner than a pixel are drawn one pixel wide and fainter.
class RenderListMaker {
public:
    RenderListMaker(Size size, GlyphAtlas& atlas, RenderList& made) : size_(size), atlas_(atlas), made_(made) {}

    void operator()(const Box& box) {
        const Point half{(box.right - box.left) / 2, (box.bottom - box.top) / 2};
        if (!(half.x > 0 && half.y > 0)) return;
        add_shape({(box.left + box.right) / 2, (box.top + box.bottom) / 2}, {1, 0}, half, box.corner, box.color);
    }

    void operator()(const Capsule& capsule) {
        if (!(capsule.radius > 0)) return;
        const Chord s(capsule.from, capsule.to);
        add_shape(s.middle(), s.axis, {s.length / 2 + capsule.radius, capsule.radius}, capsule.radius, capsule.color,
                  std::max(capsule.glow, 0.f));
    }

    void operator()(const Ring& ring) {
        if (!(ring.radius >= 0 && ring.width > 0)) return;
        const float pen = std::max(ring.width, 1.f) / 2, reach = ring.radius + pen + edge / 2;
        begin(Kind::shape);
        add({.origin = ring.center,
             .shape = {0, 0, ring.radius, pen},
             .tint = tint(ring.color, std::min(ring.width, 1.f))},
            {reach, reach});
    }

    void operator()(const Stroke& stroke) {
        begin(Kind::mask);
        if (!(stroke.color.a > 0 && stroke.width > 0)) return;
        // as drawn: opacity includes the colour's, width in px
        path_ = stroke.vertices;
        for (Stroke::Vertex& v : path_) {
            const float width = stroke.width * v.width;
            v.alpha *= stroke.color.a * std::clamp(width, 0.f, 1.f);
            v.width = std::max(width, 1.f);
            v.glow *= std::max(stroke.glow, 0.f);
        }
        segments_.clear();
        if (path_.size() == 1) {
            path_[0].bend = 0;
            segments_.push_back({path_[0], path_[0]});
        }
        for (std::size_t i = 0; i + 1 < path_.size(); ++i) {
            const Segment segment{path_[i], path_[i + 1]};
            // one of zero length between two joints only changes width and opacity
            if (!(segment.from.joint && segment.to.joint && segment.chord.length == 0)) segments_.push_back(segment);
        }
        const auto color = tint(stroke.color);
        for (std::size_t i = 0; i < segments_.size(); ++i) {
            const auto& [from, to, s] = segments_[i];
            const float bend = from.bend;
            if (!(from.alpha > 0 || to.alpha > 0)) continue;
            const float per_px = s.length > 0 ? 1 / s.length : 0;
            const float alpha = s.length > 0 ? (from.alpha + to.alpha) / 2 : std::max(from.alpha, to.alpha);
            const float reach = std::max(from.width, to.width) / 2 + std::max({edge / 2, from.glow, to.glow});
            const float half_length =
                s.length / 2 + edge / 2 +
                reach * std::max(i > 0 ? share_at_joint(segments_[i - 1], segments_[i]) : 1,
                                 i + 1 < segments_.size() ? share_at_joint(segments_[i], segments_[i + 1]) : 1);
            const Point middle = s.middle();
            add({.origin = {middle.x - s.axis.y * bend / 2, middle.y + s.axis.x * bend / 2},
                 .axis = s.axis,
                 .shape = {s.length / 2, (from.width + to.width) / 4, alpha, (to.alpha - from.alpha) * per_px},
                 .params = {(to.width - from.width) / 2 * per_px, (from.glow + to.glow) / 2,
                            (to.glow - from.glow) * per_px, half_length},
                 .parabola = {bend / 2, 4 * bend * per_px * per_px},
                 .tint = color},
                {half_length, reach + std::abs(bend) / 2});
        }
    }

    void operator()(const Label& label) {
        begin(Kind::glyph);
        const TextLine line = atlas_.typeface().lay_out(label.text, label.size, label.weight);
        const auto [start, baseline] = start_of(label, line);
        // separates the whole pixels, so that shifts by whole pixels change nothing
        const float whole = std::floor(start);
        for (const TextLine::Glyph& glyph : line.glyphs) {
            const int subpixel = static_cast<int>(std::lround((start - whole + glyph.pen) * GlyphAtlas::subpixels));
            const GlyphAtlas::Slot& slot = atlas_.slot(glyph, label.size, subpixel % GlyphAtlas::subpixels);
            if (slot.size.width == 0) continue;
            const Point corner{whole + static_cast<float>(subpixel / GlyphAtlas::subpixels + slot.left),
                               baseline + static_cast<float>(slot.top)};
            add({.origin = corner,
                 .shape = {static_cast<float>(slot.x), static_cast<float>(slot.y)},
                 .tint = tint(label.color)},
                corner,
                {corner.x + static_cast<float>(slot.size.width), corner.y + static_cast<float>(slot.size.height)});
        }
    }

private:
    struct Segment {
        Stroke::Vertex from, to;
        Chord chord{from.at, to.at};

        /// At the start; at the end it is the negative.
        float steepness() const { return chord.length > 0 ? 4 * from.bend / chord.length : 0; }
        Point direction(float slope) const {
            const float scale = 1 / std::sqrt(1 + slope * slope);
            return {scale * (chord.axis.x - slope * chord.axis.y), scale * (chord.axis.y + slope * chord.axis.x)};
        }
    };

    /// How far two consecutive segments must extend beyond their joint, in units of the stroke's reach. They share the
    /// round end there, each up to the bisector; at a free end the value is 1.
    static float share_at_joint(const Segment& a, const Segment& b) {
        const Point out = a.direction(-a.steepness()), in = b.direction(b.steepness());
        const float along = out.x * in.x + out.y * in.y;  // cosine of the turning angle
        if (!(along > 0 && a.chord.length > 0 && b.chord.length > 0)) return 1;
        const float slope = std::max(std::abs(a.steepness()), std::abs(b.steepness()));
        return std::min(std::sqrt((1 - std::min(along, 1.f)) / 2) + slope, 1.f);
    }

    void begin(Kind kind) { made_.parts.push_back({kind, made_.primitives.size(), made_.primitives.size()}); }

    /// Adds the primitive, which touches only pixels between `from` and `to`.
    void add(Primitive primitive, Point from, Point to) {
        // fmin and fmax ignore NaN
        const auto within = [](float v, int maximum) {
            return std::fmin(std::fmax(v, 0.f), static_cast<float>(maximum));
        };
        primitive.bounds = {static_cast<int>(within(from.x, size_.width)),
                            static_cast<int>(within(from.y, size_.height)),
                            static_cast<int>(std::ceil(within(to.x, size_.width))),
                            static_cast<int>(std::ceil(within(to.y, size_.height)))};
        if (primitive.bounds.empty()) return;
        made_.primitives.push_back(primitive);
        made_.parts.back().end = made_.primitives.size();
        made_.parts.back().bounds = united(made_.parts.back().bounds, primitive.bounds);
    }

    /// Adds the primitive, which extends by `half` from its origin along its two axes.
    void add(Primitive primitive, Point half) {
        const float across = std::abs(primitive.axis.x), down = std::abs(primitive.axis.y);
        const Point reach{across * half.x + down * half.y, down * half.x + across * half.y};
        primitive.half = half;
        add(primitive, {primitive.origin.x - reach.x, primitive.origin.y - reach.y},
            {primitive.origin.x + reach.x, primitive.origin.y + reach.y});
    }

    void add_shape(Point center, Point axis, Point half, float corner, const Color& color, float glow = 0) {
        const float opacity = std::min(2 * half.x, 1.f) * std::min(2 * half.y, 1.f);
        half = {std::max(half.x, 0.5f), std::max(half.y, 0.5f)};
        corner = std::clamp(corner, 0.f, std::min(half.x, half.y));
        const float beyond = std::max(edge / 2, glow);
        begin(Kind::shape);
        add({.origin = center,
             .axis = axis,
             .shape = {half.x - corner, half.y - corner, corner, 0},
             .params = {glow > 0 ? 1 / glow : 0, glow > 0 ? 1.0f / 3 : 0},
             .tint = tint(color, opacity)},
            {half.x + beyond, half.y + beyond});
    }

    Size size_;
    GlyphAtlas& atlas_;
    RenderList& made_;
    // of the current stroke; reused
    std::vector<Stroke::Vertex> path_;
    std::vector<Segment> segments_;
};

}  // namespace

void make_render_list(const DisplayList& list, Size size, GlyphAtlas& atlas, RenderList& made) {
    made.parts.clear();
    made.primitives.clear();
    RenderListMaker maker(size, atlas, made);
    for (const Item& item : list) std::visit(maker, item);
}

namespace {

constexpr long rect_overhead = 3000;  // one more rectangle costs as much time as restoring and reading this many pixels

bool cheaper_as_one(const Rect& a, const Rect& b) {
    return united(a, b).area() <= a.area() + b.area() + rect_overhead;
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

const GlyphAtlas::Slot& GlyphAtlas::slot(const TextLine::Glyph& glyph, float size, int subpixel) {
    const Key key{glyph.font, glyph.number, size, subpixel};
    if (const auto found = slots_.find(key); found != slots_.end()) return found->second;

    const Coverage drawn = glyph.font->rasterised(glyph.number, size, static_cast<float>(subpixel) / subpixels);
    if (pen_ + drawn.size.width > width) {
        pen_ = 0;
        shelf_ += shelf_height_;
        shelf_height_ = 0;
    }
    shelf_height_ = std::max(shelf_height_, drawn.size.height);
    if (drawn.size.width > width || shelf_ + shelf_height_ > max_height_) {
        throw io_failed("no room for a glyph of {} × {} px: the text is too large or has too many sizes",
                        drawn.size.width, drawn.size.height);
    }
    if (const int rows = shelf_ + shelf_height_; rows > height())
        values_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(rows));
    const Slot slot{drawn.left, drawn.top, drawn.size, pen_, shelf_};
    for (int row = 0; row < drawn.size.height; ++row)
        std::copy_n(&drawn.values[static_cast<std::size_t>(row) * drawn.size.width], drawn.size.width,
                    &values_[static_cast<std::size_t>(shelf_ + row) * width + pen_]);
    pen_ += drawn.size.width;
    return slots_.emplace(key, slot).first->second;
}

}  // namespace doppel
