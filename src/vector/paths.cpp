#include "vector/paths.hpp"

#include "render/stroke.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace doppel {
namespace {

using Step = Path::Step;

constexpr float quarter_turn = 0.5522847f;  // of the radius: where the control points of a quarter of a circle lie

Step move_to(Point p) {
    return {Step::Kind::move, p};
}
Step line_to(Point p) {
    return {Step::Kind::line, p};
}
Step close() {
    return {Step::Kind::close, {}};
}

/// A quarter of an ellipse from `from` to `to`, which leaves along the line to `corner` and arrives along it.
Step quarter(Point from, Point corner, Point to) {
    const auto toward = [&](Point p) {
        return Point{p.x + quarter_turn * (corner.x - p.x), p.y + quarter_turn * (corner.y - p.y)};
    };
    return {Step::Kind::curve, to, toward(from), toward(to)};
}

/// With corners rounded by `r` px; a circle where r is half of both sides.
std::vector<Step> rectangle(const Area& a, float r) {
    r = std::clamp(r, 0.f, std::min(a.width(), a.height()) / 2);
    if (r == 0)
        return {move_to({a.left, a.top}), line_to({a.right, a.top}), line_to({a.right, a.bottom}),
                line_to({a.left, a.bottom}), close()};
    const Point top_right{a.right, a.top}, bottom_right{a.right, a.bottom}, bottom_left{a.left, a.bottom},
        top_left{a.left, a.top};
    const auto beside = [&](Point corner, float x, float y) { return Point{corner.x + x * r, corner.y + y * r}; };
    const auto round = [&](Point corner, Point from, Point to) {
        return std::pair{line_to(from), quarter(from, corner, to)};
    };
    std::vector<Step> steps{move_to(beside(top_left, 1, 0))};
    for (const auto& [line, curve] : {round(top_right, beside(top_right, -1, 0), beside(top_right, 0, 1)),
                                      round(bottom_right, beside(bottom_right, 0, -1), beside(bottom_right, -1, 0)),
                                      round(bottom_left, beside(bottom_left, 1, 0), beside(bottom_left, 0, -1)),
                                      round(top_left, beside(top_left, 0, 1), beside(top_left, 1, 0))}) {
        steps.push_back(line);
        steps.push_back(curve);
    }
    steps.push_back(close());
    return steps;
}

std::vector<Step> circle(Point center, float r) {
    return rectangle({center.x - r, center.y - r, center.x + r, center.y + r}, r);
}

/// A glow's rings from its outer edge inward, each `beyond` px past the shape's edge and so opaque: together they fall
/// off with the square of the distance, from a third at the edge.
template <class Add>
void for_each_ring(float reach, const Add& add) {
    constexpr int rings = 6;
    const auto light = [](float share) { return (1 - share) * (1 - share) / 3; };
    for (int k = rings; k-- > 0;) {
        const float inner = light((static_cast<float>(k) + 0.5f) / rings);
        const float outer = k + 1 < rings ? light((static_cast<float>(k) + 1.5f) / rings) : 0;
        add(reach * static_cast<float>(k + 1) / rings, (inner - outer) / (1 - outer));
    }
}

/// Turns items into those of a page.
class ItemMaker {
public:
    explicit ItemMaker(std::vector<PageItem>& made) : made_(made) {}

    void operator()(const Box& box) {
        if (!(box.right > box.left && box.bottom > box.top)) return;
        made_.push_back(Path{rectangle({box.left, box.top, box.right, box.bottom}, box.corner), box.color});
    }

    void operator()(const Capsule& capsule) {
        if (!(capsule.radius > 0)) return;
        const auto add = [&](float radius, Color color) {
            if (distance(capsule.from, capsule.to) > 0)
                made_.push_back(Path{{move_to(capsule.from), line_to(capsule.to)}, color, 2 * radius});
            else
                made_.push_back(Path{circle(capsule.from, radius), color});
        };
        if (capsule.glow > 0)
            for_each_ring(capsule.glow, [&](float beyond, float alpha) {
                add(capsule.radius + beyond, capsule.color.with_alpha(capsule.color.a * alpha));
            });
        add(capsule.radius, capsule.color);
    }

    void operator()(const Ring& ring) {
        if (ring.radius >= 0 && ring.width > 0)
            made_.push_back(Path{circle(ring.center, ring.radius), ring.color, ring.width});
    }

    void operator()(const Stroke& stroke);
    void operator()(const Label& label) { made_.push_back(label); }
    void operator()(const Image& image) {
        if (!(image.right > image.left && image.bottom > image.top) || !image.pixels || image.pixels->rgba.empty())
            return;
        // on whole pixels, as in a picture
        made_.push_back(Image{std::round(image.left), std::round(image.top), std::round(image.right),
                              std::round(image.bottom), image.pixels});
    }

private:
    std::vector<PageItem>& made_;
};

/// A straight part of a stroke. Its looks are even.
struct Part {
    Point from, to;
    float alpha, width, glow;  // alpha 0…1, px

    bool goes_on(const Part& next) const {
        return to.x == next.from.x && to.y == next.from.y && alpha == next.alpha && width == next.width &&
               glow == next.glow;
    }
};

/// Bends are cut into chords at most 1/20 px off, changing looks into steps of 4 %.
std::vector<Part> parts_of(const Stroke& stroke) {
    std::vector<Part> parts;
    for (std::size_t i = 0; i + 1 < stroke.vertices.size(); ++i) {
        const auto &from = stroke.vertices[i], &to = stroke.vertices[i + 1];
        const Chord chord(from.at, to.at);
        if (!(chord.length > 0)) continue;
        const float bends = std::sqrt(std::abs(from.bend) / 0.05f);
        const float looks = std::max({std::abs(to.alpha - from.alpha), std::abs(to.width - from.width),
                                      std::abs(to.glow - from.glow)}) /
                            0.04f;
        const int count = std::max(1, static_cast<int>(std::ceil(std::max(bends, looks))));
        const auto at = [&](int k) {
            const float share = static_cast<float>(k) / static_cast<float>(count);
            const float along = share * chord.length, right = 4 * share * (1 - share) * from.bend;
            return Point{from.at.x + chord.axis.x * along - chord.axis.y * right,
                         from.at.y + chord.axis.y * along + chord.axis.x * right};
        };
        for (int k = 0; k < count; ++k) {
            const float share = (static_cast<float>(k) + 0.5f) / static_cast<float>(count);
            parts.push_back({at(k), at(k + 1), std::lerp(from.alpha, to.alpha, share),
                             stroke.width * std::lerp(from.width, to.width, share),
                             stroke.glow * std::lerp(from.glow, to.glow, share)});
        }
    }
    return parts;
}

void ItemMaker::operator()(const Stroke& stroke) {
    if (!(stroke.color.a > 0 && stroke.width > 0)) return;
    const auto parts = parts_of(stroke);
    std::vector<Path> glows, lines;
    for (std::size_t i = 0; i < parts.size();) {
        Path path{{move_to(parts[i].from)}, stroke.color.with_alpha(stroke.color.a * parts[i].alpha), parts[i].width};
        const Part& looks = parts[i];
        do path.steps.push_back(line_to(parts[i].to));
        while (++i < parts.size() && parts[i - 1].goes_on(parts[i]));
        // see-through parts must not overlap
        path.has_round_ends = path.color.a == 1;
        if (!(path.color.a > 0)) continue;
        if (looks.glow > 0.5f)
            for_each_ring(looks.glow, [&](float beyond, float alpha) {
                Path ring = path;
                ring.pen += 2 * beyond;
                ring.color.a *= alpha;
                ring.has_round_ends = false;
                glows.push_back(std::move(ring));
            });
        lines.push_back(std::move(path));
    }
    for (auto* paths : {&glows, &lines}) std::move(paths->begin(), paths->end(), std::back_inserter(made_));
}

}  // namespace

std::vector<PageItem> page_items(const DisplayList& list) {
    std::vector<PageItem> items;
    ItemMaker maker(items);
    for (const auto& item : list) std::visit(maker, item);
    return items;
}

}  // namespace doppel
