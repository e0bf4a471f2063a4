#include "picture/sketch.hpp"

#include "picture/damage.hpp"
#include "picture/font.hpp"
#include "picture/stroke.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

constexpr float edge = 1;  // px that a quad reaches past its shape, for the soft edge

std::uint8_t byte(float channel) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(channel, 0.f, 1.f)));
}

std::array<std::uint8_t, 4> tint(const Color& color, float opacity = 1) {
    return {byte(color.r), byte(color.g), byte(color.b), byte(color.a * opacity)};
}

/// Turns items into quads. What is thinner than a pixel is drawn a pixel thin and fainter.
class Sketcher {
public:
    Sketcher(Size size, GlyphAtlas& atlas) : size_(size), atlas_(atlas) {}

    void operator()(const Box& box) {
        const Point half{(box.right - box.left) / 2, (box.bottom - box.top) / 2};
        if (!(half.x > 0 && half.y > 0)) return;
        add_shape({(box.left + box.right) / 2, (box.top + box.bottom) / 2}, {1, 0}, half, box.corner, box.color);
    }

    void operator()(const Capsule& capsule) {
        if (!(capsule.radius > 0)) return;
        const Segment s(capsule.from, capsule.to);
        add_shape(s.center, s.axis, {s.length / 2 + capsule.radius, capsule.radius}, capsule.radius, capsule.color);
    }

    void operator()(const Ring& ring) {
        if (!(ring.radius >= 0 && ring.width > 0)) return;
        const float pen = std::max(ring.width, 1.f) / 2, reach = ring.radius + pen + edge;
        begin(Kind::shape);
        add({.center = ring.center,
             .half = {reach, reach},
             .shape = {0, 0, ring.radius, pen},
             .tint = tint(ring.color, std::min(ring.width, 1.f))});
    }

    void operator()(const Stroke& stroke) {
        begin(Kind::mask);
        const std::size_t first = made.quads.size();
        const float half_width = std::max(stroke.width, 1.f) / 2;
        const float opacity = stroke.color.a * std::clamp(stroke.width, 0.f, 1.f);
        if (!(opacity > 0)) return;
        for_each_segment(stroke.vertices, [&](const Stroke::Vertex& from, const Stroke::Vertex& to) {
            const Segment s(from.at, to.at);
            const float slope = s.length > 0 ? (to.alpha - from.alpha) / s.length : 0;
            const float alpha = s.length > 0 ? (from.alpha + to.alpha) / 2 : std::max(from.alpha, to.alpha);
            add({.center = s.center,
                 .axis = s.axis,
                 .half = {s.length / 2 + half_width + edge / 2, half_width + edge / 2},
                 .shape = {s.length / 2, half_width, opacity * alpha, opacity * slope},
                 .tint = tint(stroke.color)});
        });

        const std::vector<Rect> covers = merged(chunks(made.bounds, first, made.bounds.size()));
        begin(Kind::cover);
        for (const Rect& r : covers) {
            const Point half{static_cast<float>(r.right - r.left) / 2, static_cast<float>(r.bottom - r.top) / 2};
            const Point center{static_cast<float>(r.left) + half.x, static_cast<float>(r.top) + half.y};
            add({.center = center, .half = half, .tint = tint(stroke.color)});
        }
    }

    void operator()(const Label& label) {
        begin(Kind::glyph);
        const TextLine line = lay_out(label.text, label.size, label.weight);
        const float before = label.align == Align::left ? 0 : label.align == Align::center ? 0.5f : 1;
        const float start = label.anchor.x - before * line.width;
        const float baseline = std::round(label.anchor.y);
        // the whole pixels aside, so that moving by whole pixels changes nothing
        const float whole = std::floor(start);
        for (const TextLine::Glyph& glyph : line.glyphs) {
            const int stop = static_cast<int>(std::lround((start - whole + glyph.pen) * GlyphAtlas::stops));
            const GlyphAtlas::Slot& slot =
                atlas_.slot(glyph.number, label.size, label.weight, stop % GlyphAtlas::stops);
            if (slot.size.width == 0) continue;
            const Point half{static_cast<float>(slot.size.width) / 2, static_cast<float>(slot.size.height) / 2};
            const float left = whole + static_cast<float>(stop / GlyphAtlas::stops + slot.left);
            const float top = baseline + static_cast<float>(slot.top);
            add({.center = {left + half.x, top + half.y},
                 .half = half,
                 .shape = {static_cast<float>(slot.x) + half.x, static_cast<float>(slot.y) + half.y},
                 .tint = tint(label.color)});
        }
    }

    void operator()(const Image& image) {
        const float left = std::round(image.left), top = std::round(image.top);
        const Point half{(std::round(image.right) - left) / 2, (std::round(image.bottom) - top) / 2};
        if (!(half.x > 0 && half.y > 0) || !image.pixels || image.pixels->rgba.empty()) return;
        const Size texels = image.pixels->size;
        begin(Kind::image);
        add({.center = {left + half.x, top + half.y},
             .half = half,
             .shape = {half.x, half.y, static_cast<float>(texels.width) / (2 * half.x),
                       static_cast<float>(texels.height) / (2 * half.y)},
             .image = image.pixels.get()});
        made.images.push_back(image.pixels);
    }

    Sketch made;

private:
    struct Segment {
        Point center, axis{1, 0};
        float length;
        Segment(Point from, Point to) : center{(from.x + to.x) / 2, (from.y + to.y) / 2} {
            const Point along{to.x - from.x, to.y - from.y};
            length = std::sqrt(along.x * along.x + along.y * along.y);
            if (length > 0) axis = {along.x / length, along.y / length};
        }
    };

    void begin(Kind kind) { made.parts.push_back({kind, made.quads.size(), made.quads.size()}); }

    void add(const Quad& quad) {
        const float x = std::abs(quad.axis.x) * quad.half.x + std::abs(quad.axis.y) * quad.half.y;
        const float y = std::abs(quad.axis.y) * quad.half.x + std::abs(quad.axis.x) * quad.half.y;
        // fmin and fmax, for they lose what is not a number
        const auto within = [](float v, int most) { return std::fmin(std::fmax(v, 0.f), static_cast<float>(most)); };
        const Rect bounds{static_cast<int>(std::floor(within(quad.center.x - x, size_.width))),
                          static_cast<int>(std::floor(within(quad.center.y - y, size_.height))),
                          static_cast<int>(std::ceil(within(quad.center.x + x, size_.width))),
                          static_cast<int>(std::ceil(within(quad.center.y + y, size_.height)))};
        if (bounds.empty()) return;
        made.quads.push_back(quad);
        made.bounds.push_back(bounds);
        made.parts.back().end = made.quads.size();
    }

    void add_shape(Point center, Point axis, Point half, float corner, const Color& color) {
        const float opacity = std::min(2 * half.x, 1.f) * std::min(2 * half.y, 1.f);
        half = {std::max(half.x, 0.5f), std::max(half.y, 0.5f)};
        corner = std::clamp(corner, 0.f, std::min(half.x, half.y));
        begin(Kind::shape);
        add({.center = center,
             .axis = axis,
             .half = {half.x + edge, half.y + edge},
             .shape = {half.x - corner, half.y - corner, corner, 0},
             .tint = tint(color, opacity)});
    }

    Size size_;
    GlyphAtlas& atlas_;
};

}  // namespace

bool operator==(const Quad& a, const Quad& b) {
    return a.center.x == b.center.x && a.center.y == b.center.y && a.axis.x == b.axis.x && a.axis.y == b.axis.y &&
           a.half.x == b.half.x && a.half.y == b.half.y && a.shape == b.shape && a.tint == b.tint && a.image == b.image;
}

Sketch sketch(const DisplayList& list, Size size, GlyphAtlas& atlas) {
    Sketcher sketcher(size, atlas);
    for (const Item& item : list) std::visit(sketcher, item);
    return std::move(sketcher.made);
}

}  // namespace doppel
