#pragma once

#include "physics/pendulum.hpp"

#include <cmath>

namespace doppel {

inline Pendulum<double> released(double degrees1, double degrees2) {
    Pendulum<double> p;
    p.angle = {radians(degrees1), radians(degrees2)};
    return p;
}

/// Unit masses and lengths, at rest.
inline Pendulum<double> from_rest(const std::vector<double>& degrees) {
    const std::vector<double> ones(degrees.size(), 1.0);
    Pendulum<double> p{.mass = ones, .length = ones, .angle = {}, .rate = std::vector<double>(degrees.size(), 0.0)};
    for (double angle : degrees) p.angle.push_back(radians(angle));
    return p;
}

/// Unequal numbers, every link in motion.
inline Pendulum<double> uneven(std::size_t links) {
    Pendulum<double> p{.mass = {}, .length = {}, .angle = {}, .rate = {}};
    for (std::size_t i = 0; i < links; ++i) {
        const auto k = static_cast<double>(i);
        p.mass.push_back(0.4 + 0.5 * std::fmod(1.7 * k, 2.0));
        p.length.push_back(1.3 - 0.6 * std::fmod(0.7 * k, 1.3));
        p.angle.push_back(1.1 * std::sin(3 * k + 1));
        p.rate.push_back(2.3 * std::cos(5 * k));
    }
    return p;
}

}  // namespace doppel
