#pragma once

#include "physics/pendulum.hpp"

#include <random>

namespace doppel {

/// A pendulum with random unequal numbers.
inline Pendulum<double> random_pendulum(std::mt19937& random, std::size_t links = 2) {
    std::uniform_real_distribution<double> size(0.3, 3), angle(-3, 3), rate(-5, 5);
    Pendulum<double> p{{}, {}, {}, {}, 9.8 * size(random)};
    for (std::size_t i = 0; i < links; ++i) {
        p.mass.push_back(size(random));
        p.length.push_back(size(random));
        p.angle.push_back(angle(random));
        p.rate.push_back(rate(random));
    }
    return p;
}

}  // namespace doppel
