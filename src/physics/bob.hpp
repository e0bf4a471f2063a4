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

/// Writes the bobs of a chain, without angles, from its state as particles to `bobs`, whose memory is reused. Other
/// particles may follow those of the chain. The first half of the state contains positions, the second velocities.
template <class Scalar, int N>
void place_particles(const Pendulum<Scalar>& p, const State<Scalar, N>& state, Bobs<Scalar>& bobs) {
    bobs.resize(p.links());
    for (std::size_t k = 0; k < p.links(); ++k) {
        const Eigen::Index q = 2 * static_cast<Eigen::Index>(k), v = state.size() / 2 + q;
        bobs[k] = {p.mass[k], state[q], state[q + 1], state[v], state[v + 1]};
    }
}

/// Includes angles, within (−π, π].
template <class Scalar, int N>
Bobs<Scalar> bobs_of_particles(const Pendulum<Scalar>& p, const State<Scalar, N>& state) {
    Bobs<Scalar> bobs;
    place_particles(p, state, bobs);
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

/// Kinetic and potential energy, J.
template <class Scalar>
struct Energies {
    Scalar kinetic, potential;
};

/// For rigid bodies whose ends are the bobs. The potential energy is 0 if all centres of mass are level with the
/// origin. The body between positions p and q, with s = a/l, has its centre at p + s (q − p) and rotates at |q′ − p′| /
/// l.
template <class Scalar>
Energies<Scalar> energies(const PhysicalPendulum<Scalar>& p, const Bobs<Scalar>& bobs, const Bob<Scalar>& pivot) {
    Energies<Scalar> sum{Scalar(0), Scalar(0)};
    const auto* above = &pivot;
    for (std::size_t i = 0; i < bobs.size(); ++i) {
        const auto& end = bobs[i];
        const Scalar part = p.center[i] / p.chain.length[i];
        const Scalar ux = end.vx - above->vx, uy = end.vy - above->vy;
        const Scalar vx = above->vx + part * ux, vy = above->vy + part * uy;
        const Scalar turn = (ux * ux + uy * uy) / (p.chain.length[i] * p.chain.length[i]);
        sum.kinetic += Scalar(0.5) * (p.chain.mass[i] * (vx * vx + vy * vy) + p.inertia[i] * turn);
        sum.potential += p.chain.mass[i] * p.chain.gravity * (above->y + part * (end.y - above->y));
        above = &end;
    }
    return sum;
}

/// Moves the bobs of a chain from a pivot at the origin to `pivot`.
template <class Scalar>
void move_with(Bobs<Scalar>& bobs, const Bob<Scalar>& pivot) {
    for (auto& bob : bobs) {
        bob.x += pivot.x;
        bob.y += pivot.y;
        bob.vx += pivot.vx;
        bob.vy += pivot.vy;
    }
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
