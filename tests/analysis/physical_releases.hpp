#pragma once

#include "physics/physical_pendulum.hpp"

#include <cmath>

namespace doppel {

/// Uniform rods in place of point masses.
inline PhysicalPendulum<double> rods(Pendulum<double> chain) {
    auto p = physical(chain);
    for (std::size_t i = 0; i < chain.links(); ++i) {
        p.center[i] = chain.length[i] / 2;
        p.inertia[i] = chain.mass[i] * chain.length[i] * chain.length[i] / 12;
    }
    return p;
}

/// θ″ + θ′/q + sinθ = γ cos(2τ/3), with τ in units of √(l/g): one mass on a rod of 0.8 m.
inline PhysicalPendulum<double> driven(double gamma, double quality = 2) {
    constexpr double mass = 1.3, length = 0.8, gravity = 9.8;
    const double rate = std::sqrt(gravity / length);
    auto p = physical(Pendulum<double>{{mass}, {length}, {0.2}, {0}, gravity});
    p.friction.viscous = {mass * length * length * rate / quality};
    p.torques = {{0, gamma * mass * gravity * length, rate * 2 / 3, 0}};
    return p;
}

}  // namespace doppel
