#pragma once

#include "scene/scene.hpp"

#include <vector>

namespace doppel {

/// What there is to film at one sample: the pair, and of an ensemble where all its members are.
struct Shot {
    Moment moment;
    std::vector<Bobs<double>> crowd;
};

}  // namespace doppel
