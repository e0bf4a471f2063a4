#include "film/layer.hpp"
#include "render/stroke.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace doppel {
namespace {

// Fading points have to be redrawn. To limit this, the points of a trail fade in groups, in steps of 3 % of the light,
// and rarely two groups at once.
constexpr long group = 24;      // samples
constexpr double steps = 32;    // from full light to none
constexpr double fading = 1.6;  // brightness = freshness to this power

}  // namespace

Trail::Trail(const Scene& scene, const Style& style, Color color, float width, float jump)
    : sample_hz_(scene.preset.sample_hz.value()),
      trail_s_(scene.preset.video.trail_s),
      jump_(jump),
      pen_{.vertices = {}, .width = width, .color = color, .glow = style.glow} {}

std::optional<Point> Trail::end() const {
    return points_.empty() ? std::nullopt : std::optional(points_.back().at);
}

/// Removes whole groups that have faded out.
void Trail::add(Point at, double time, double now) {
    const long g = static_cast<long>(std::floor(time * sample_hz_ + 1e-6)) / group;
    if (!points_.empty() && points_.back().group != g) {
        simplify(points_);
        // the new group begins where the last one ends
        TrailPoint first = points_.back();
        first.group = g;
        first.starts = false;
        points_.push_back(first);
    }
    const bool starts = !points_.empty() && std::abs(at.x - points_.back().at.x) > jump_;
    if (starts) points_.back().joint = true;
    points_.push_back({.at = at, .time = time, .group = g, .starts = starts, .joint = starts});
    while (end_of(points_.front().group) < now - trail_s_) points_.pop_front();
}

/// Removes points of the newest group between which the path bends evenly.
void Trail::simplify(Points& points) const {
    std::size_t begin = points.size() - 1;
    while (begin > 0 && points[begin - 1].group == points.back().group) --begin;
    std::vector<Stroke::Vertex> path;
    for (std::size_t i = begin; i < points.size(); ++i) {
        // brightness falls almost linearly over short times
        const double part = (points[i].time - points[begin].time) / trail_s_;
        path.push_back(
            {.at = points[i].at, .alpha = static_cast<float>(part), .bend = points[i].bend, .joint = points[i].joint});
    }
    std::size_t kept = begin;
    for (std::size_t i = 0; i < path.size(); ++kept) {
        const auto piece = i + 1 < path.size() ? next_piece(path, i) : StrokePiece{i, i + 1};
        points[kept] = points[begin + i];
        points[kept].bend = piece.bend;
        points[kept].joint = true;
        i = piece.last;
    }
    points.resize(kept);
}

/// The time of a group's last sample, s.
double Trail::end_of(long g) const {
    return static_cast<double>((g + 1) * group) / sample_hz_;
}

/// The time for which the points of a group show their age; it advances in steps.
double Trail::faded_until(long g, double now) const {
    const double end = end_of(g);
    const double light = std::pow(std::max(1 - (now - end) / trail_s_, 0.0), fading);
    return end + (1 - std::pow(std::ceil(steps * light) / steps, 1 / fading)) * trail_s_;
}

void Trail::draw(const Area& area, double now, std::optional<Point> head, DisplayList& list, Point shift) const {
    if (!(trail_s_ > 0) || !(pen_.width > 0) || points_.empty()) return;
    auto points = points_;
    if (head) points.push_back({.at = *head, .time = now, .group = points.back().group});
    simplify(points);
    Stroke stroke = pen_;
    const auto end_stroke = [&] {
        if (!stroke.vertices.empty()) list.push_back(std::exchange(stroke, pen_));
    };
    std::optional<long> last_group;
    double until = 0;
    for (const auto& point : points) {
        const Point at{point.at.x + shift.x, point.at.y + shift.y};
        const bool is_within = area.contains(at);
        if (point.starts || !is_within) end_stroke();
        if (!is_within) continue;
        if (point.group != last_group) until = faded_until(point.group, now);
        last_group = point.group;
        const double freshness = std::clamp(1 - (until - point.time) / trail_s_, 0.0, 1.0);
        constexpr double thinnest = 0.55;
        stroke.vertices.push_back({.at = at,
                                   .alpha = static_cast<float>(std::pow(freshness, fading)),
                                   .width = static_cast<float>(thinnest + (1 - thinnest) * freshness),
                                   .glow = static_cast<float>(std::pow(freshness, 4)),
                                   .bend = point.bend,
                                   .joint = point.joint});
    }
    end_stroke();
}

}  // namespace doppel
