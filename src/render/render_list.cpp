#include "render/render_list.hpp"

#include "render/glyph_atlas.hpp"
#include "render/stroke.hpp"

#include <algorithm>
#include <cmath>

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
            const GlyphAtlas::Slot& slot =
                atlas_.slot(glyph, label.size, label.weight, subpixel % GlyphAtlas::subpixels);
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

}  // namespace doppel
