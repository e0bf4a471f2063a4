#pragma once

#include "render/display_list.hpp"

#include <vector>

namespace doppel {

/// The path of a quantity over time, growing to the right, with the points left out that lie within a fifth of a pixel
/// of the straight line through those that stay. What stays depends only on what came before.
class Trace {
public:
    /// x must grow from point to point.
    void add(Point point);

    /// All of it, up to the newest point.
    std::vector<Stroke::Vertex> vertices() const;

private:
    std::vector<Stroke::Vertex> kept_;
    Point newest_{};
    bool pending_ = false;               // the newest point is not among the kept
    float steepest_ = 0, flattest_ = 0;  // slopes from the last kept point that miss no point since
};

}  // namespace doppel
