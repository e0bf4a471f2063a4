#include "render/trace.hpp"

#include <algorithm>
#include <limits>

namespace doppel {
namespace {
constexpr float tolerance = 0.2f;  // px
constexpr float any_slope = std::numeric_limits<float>::max();

/// One that stays: what follows changes nothing before it.
Stroke::Vertex vertex(Point at) {
    return {.at = at, .joint = true};
}
}  // namespace

void Trace::add(Point point) {
    if (kept_.empty()) {
        kept_.push_back(vertex(point));
        steepest_ = any_slope;
        flattest_ = -any_slope;
        return;
    }
    const auto slope = [&](float dy) {
        const Point from = kept_.back().at;
        return (point.y + dy - from.y) / std::max(point.x - from.x, 1e-6f);
    };
    if (pending_ && (slope(0) > steepest_ || slope(0) < flattest_)) {
        kept_.push_back(vertex(newest_));
        steepest_ = any_slope;
        flattest_ = -any_slope;
    }
    steepest_ = std::min(steepest_, slope(tolerance));
    flattest_ = std::max(flattest_, slope(-tolerance));
    newest_ = point;
    pending_ = true;
}

std::vector<Stroke::Vertex> Trace::vertices() const {
    auto all = kept_;
    if (pending_) all.push_back(vertex(newest_));
    return all;
}

}  // namespace doppel
