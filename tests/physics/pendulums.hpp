#pragma once

#include "numeric/quad.hpp"
#include "physics/physical_pendulum.hpp"

#include <cmath>
#include <random>
#include <vector>

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

/// The period of one link released at rest, s. Gauss 1799: T = 2π √(l/g) / agm(1, cos(A/2)).
inline Quad exact_period(const Pendulum<Quad>& p) {
    Quad a(1), b = cos(p.angle[0] / Quad(2));
    for (int i = 0; i < 12; ++i) {
        const Quad mean = (a + b) / Quad(2);
        b = sqrt(a * b);
        a = mean;
    }
    return Quad(2) * pi_of<Quad>() * sqrt(p.length[0] / p.gravity) / a;
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
