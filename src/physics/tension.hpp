#pragma once

#include "physics/bob.hpp"
#include "physics/rod_chain.hpp"

#include <vector>

namespace doppel {

/// The state (x1, y1 … xN, yN, vx1, vy1 … vxN, vyN) of bobs.
template <class Scalar>
State<Scalar, Eigen::Dynamic> particles_of(const Bobs<Scalar>& bobs) {
    const auto n = static_cast<Eigen::Index>(bobs.size());
    State<Scalar, Eigen::Dynamic> y(4 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto& bob = bobs[static_cast<std::size_t>(i)];
        y.template segment<2>(2 * i) << bob.x, bob.y;
        y.template segment<2>(2 * n + 2 * i) << bob.vx, bob.vy;
    }
    return y;
}

/// The forces in the rods of a chain whose bobs are there, N, from the pivot down: > 0 where a rod pulls, < 0 where it
/// pushes. Whatever model the bobs are from, for they follow from places and velocities alone.
template <class Scalar>
std::vector<Scalar> tensions(const Pendulum<Scalar>& p, const Bobs<Scalar>& bobs) {
    return RodChain<Scalar, Eigen::Dynamic>(p).tensions(particles_of(bobs));
}

}  // namespace doppel
