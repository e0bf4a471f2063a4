#pragma once

#include "physics/physical_pendulum.hpp"

#include <cmath>

namespace doppel {

/// Unequal rigid bodies in motion, without friction or drive.
template <class Scalar>
PhysicalPendulum<Scalar> bodies(std::size_t links) {
    PhysicalPendulum<double> p{{{}, {}, {}, {}, 9.8}, {}, {}, {}, {}, {}};
    for (std::size_t i = 0; i < links; ++i) {
        const auto k = static_cast<double>(i);
        p.chain.mass.push_back(0.5 + 0.25 * std::fmod(3 * k + 1, 4));
        p.chain.length.push_back(1.25 - 0.25 * std::fmod(2 * k, 3));
        p.chain.angle.push_back(0.75 - 0.5 * std::fmod(3 * k, 4));
        p.chain.rate.push_back(1.5 - 1.25 * std::fmod(2 * k, 5));
        p.center.push_back(0.375 + 0.25 * std::fmod(k, 3));
        p.inertia.push_back(0.0625 + 0.125 * std::fmod(k, 2));
    }
    return p.template cast<Scalar>();
}

/// The same with viscous friction, drag on links and ends, a motor at the first and the last joint, and a moving
/// pivot.
template <class Scalar>
PhysicalPendulum<Scalar> driven_bodies(std::size_t links) {
    auto p = bodies<double>(links);
    for (std::size_t i = 0; i < links; ++i) {
        const auto k = static_cast<double>(i);
        p.friction.viscous.push_back(0.125 + 0.0625 * k);
        p.friction.link_linear.push_back(0.03125 * (k + 1));
        p.friction.drag_linear.push_back(0.0625 + 0.03125 * k);
        p.friction.drag_quadratic.push_back(0.09375 - 0.015625 * k);
    }
    p.pivot = {0.25, 0.125, 5.5, 0.5};
    p.torques = {{0, 1.5, 3.5, 0.25}, {links - 1, -0.75, 2.25, 1.0}};
    return p.template cast<Scalar>();
}

}  // namespace doppel
