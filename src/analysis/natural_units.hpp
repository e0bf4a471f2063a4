#pragma once

#include "physics/pendulum.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {

/// What a pendulum's own motion is measured in: the mean link, and the time it takes for anything to happen.
struct NaturalUnits {
    double length;  // m
    double time;    // s: 1 / √(g/l) or 1 / the greatest rate at the release, whichever is less; 1 where nothing moves

    explicit NaturalUnits(const Pendulum<double>& p) : length(p.reach() / static_cast<double>(p.links())) {
        double fastest = std::sqrt(std::abs(p.gravity) / length);
        for (const double rate : p.rate) fastest = std::max(fastest, std::abs(rate));
        time = fastest > 0 ? 1 / fastest : 1;
    }
};

}  // namespace doppel
