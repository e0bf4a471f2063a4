#pragma once

#include <array>
#include <cstddef>

namespace doppel {

inline constexpr std::size_t link_count = 2;

/// What a double pendulum is made of and how it is released; the same for every model. Link i hangs below link i − 1.
///
///     pivot o──l1──● m1        angles θ from the downward vertical, counter-clockwise, rad
///                   ╲l2        rates  ω = dθ/dt, rad/s
///                    ● m2      the pivot is the origin, x to the right, y up
struct Pendulum {
    std::array<double, link_count> mass{1, 1};    // kg, > 0
    std::array<double, link_count> length{1, 1};  // m, > 0
    std::array<double, link_count> angle{};       // rad, at t = 0
    std::array<double, link_count> rate{};        // rad/s, at t = 0
    double gravity = 9.8;                         // m/s²

    /// Between hanging straight down and standing straight up, J: the scale of its energies.
    double potential_range() const {
        double range = 0, reach = 0;
        for (std::size_t i = 0; i < link_count; ++i) {
            reach += length[i];
            range += 2 * mass[i] * gravity * reach;
        }
        return range;
    }

    /// From the pivot to the end of the outstretched chain, m.
    double reach() const { return length[0] + length[1]; }
};

/// One mass as every model reports it.
template <class Scalar>
struct Bob {
    Scalar mass;          // kg
    Scalar x, y, vx, vy;  // m, m/s
    Scalar theta, omega;  // of the rod above it: rad, rad/s
};

template <class Scalar>
using Bobs = std::array<Bob<Scalar>, link_count>;

/// Energy, J: zero at rest with every mass level with the pivot. The true motion keeps it.
///     E = Σ ½ m v² + m g y
template <class Scalar>
Scalar energy(const Bobs<Scalar>& bobs, const Scalar& gravity) {
    Scalar total(0);
    for (const auto& bob : bobs)
        total += bob.mass * (Scalar(0.5) * (bob.vx * bob.vx + bob.vy * bob.vy) + gravity * bob.y);
    return total;
}

}  // namespace doppel
