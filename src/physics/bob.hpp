#pragma once

#include "numeric/portable_math.hpp"
#include "physics/physical_pendulum.hpp"

#include <cmath>
#include <vector>

namespace doppel {

/// The state of a mass, the same for every model.
template <class Scalar>
struct Bob {
    Scalar mass;              // kg
    Scalar x, y, vx, vy;      // m, m/s
    Scalar theta{}, omega{};  // of the rod above it, for a chain: rad, rad/s

    auto members() const { return std::tie(mass, x, y, vx, vy, theta, omega); }
};

template <class Scalar>
using Bobs = std::vector<Bob<Scalar>>;

/// Writes the bobs of a chain from its state in angles to `bobs`, whose memory is reused.
template <class Scalar, int N>
void place_angles(const Pendulum<Scalar>& p, const State<Scalar, N>& state, Bobs<Scalar>& bobs) {
    bobs.clear();
    Scalar x(0), y(0), vx(0), vy(0);
    const auto n = static_cast<Eigen::Index>(p.links());
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto& l = p.length[static_cast<std::size_t>(i)];
        const Scalar theta = state[i], omega = state[n + i];
        const SinCos<Scalar> turn(theta);
        x += l * turn.sin;
        y -= l * turn.cos;
        vx += l * omega * turn.cos;
        vy += l * omega * turn.sin;
        bobs.push_back({p.mass[static_cast<std::size_t>(i)], x, y, vx, vy, theta, omega});
    }
}

template <class Scalar, int N>
Bobs<Scalar> bobs_of_angles(const Pendulum<Scalar>& p, const State<Scalar, N>& state) {
    Bobs<Scalar> bobs;
    place_angles(p, state, bobs);
    return bobs;
}

/// Writes particles of these masses, without angles, to `bobs`, whose memory is reused. Others may follow them in the
/// state; its first half contains positions, the second velocities.
template <class Masses, class Scalar, int N>
void place_particles(const Masses& mass, const State<Scalar, N>& state, Bobs<Scalar>& bobs) {
    bobs.clear();
    for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(mass.size()); ++k) {
        const Eigen::Index q = 2 * k, v = state.size() / 2 + q;
        bobs.push_back({mass[k], state[q], state[q + 1], state[v], state[v + 1]});
    }
}

/// Includes angles, within (−π, π].
template <class Scalar, int N>
Bobs<Scalar> bobs_of_particles(const Pendulum<Scalar>& p, const State<Scalar, N>& state) {
    Bobs<Scalar> bobs;
    place_particles(p.mass, state, bobs);
    Bob<Scalar> above{};  // the pivot
    for (auto& bob : bobs) {
        const Scalar rx = bob.x - above.x, ry = bob.y - above.y;
        bob.theta = portable_atan2(rx, Scalar(-ry));
        bob.omega = (rx * (bob.vy - above.vy) - ry * (bob.vx - above.vx)) / (rx * rx + ry * ry);
        above = bob;
    }
    return bobs;
}

/// The state (x1, y1 … xN, yN, vx1, vy1 … vxN, vyN) for given bobs.
template <int N = Eigen::Dynamic, class Scalar>
State<Scalar, times<4, N>> particles_of(const Bobs<Scalar>& bobs) {
    const auto n = static_cast<Eigen::Index>(bobs.size());
    State<Scalar, times<4, N>> y(4 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto& bob = bobs[static_cast<std::size_t>(i)];
        y.template segment<2>(2 * i) << bob.x, bob.y;
        y.template segment<2>(2 * n + 2 * i) << bob.vx, bob.vy;
    }
    return y;
}

template <class Scalar, int N>
State<Scalar, times<4, N>> released_as_particles(const Pendulum<Scalar>& p) {
    return particles_of<N>(bobs_of_angles(p, released_in_angles<Scalar, N>(p)));
}

/// Σ ½ m v², J
template <class Scalar>
Scalar kinetic_energy(const Bobs<Scalar>& bobs) {
    Scalar sum(0);
    for (const auto& bob : bobs) sum += Scalar(0.5) * bob.mass * (bob.vx * bob.vx + bob.vy * bob.vy);
    return sum;
}

/// The largest error of a rod's length, m.
template <class Scalar>
Scalar length_error(const Pendulum<Scalar>& p, const Bobs<Scalar>& bobs) {
    using std::abs;
    using std::sqrt;
    Scalar worst(0), x(0), y(0);
    for (std::size_t i = 0; i < bobs.size(); ++i) {
        const Scalar rx = bobs[i].x - x, ry = bobs[i].y - y;
        const Scalar error = abs(sqrt(rx * rx + ry * ry) - p.length[i]);
        if (!(error <= worst)) worst = error;  // NaN counts as the largest
        x = bobs[i].x;
        y = bobs[i].y;
    }
    return worst;
}

/// Energy, J: zero at rest with every mass level with the pivot. It is conserved.
///     E = Σ ½ m v² + m g y
template <class Scalar>
Scalar energy(const Bobs<Scalar>& bobs, const Scalar& gravity) {
    Scalar total(0);
    for (const auto& bob : bobs)
        total += bob.mass * (Scalar(0.5) * (bob.vx * bob.vx + bob.vy * bob.vy) + gravity * bob.y);
    return total;
}

}  // namespace doppel
