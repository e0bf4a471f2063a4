#pragma once

#include "scene/scene.hpp"

namespace doppel {

/// How far a pair gets, from a run without pictures: what a picture needs to know of a mechanism, whose reach no
/// formula gives.
struct Survey {
    double left, right, bottom, top;  // m, of all bobs of both sides at all samples
    double largest_distance = 0;      // state space
};

/// Ends without an error where a side breaks down.
Survey survey(const Scene& scene);

}  // namespace doppel
