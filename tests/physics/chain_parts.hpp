#pragma once

#include "physics/bob.hpp"
#include "physics/mechanism.hpp"

namespace doppel {

/// A chain out of parts: its bobs, its rods, gravity.
template <class S>
Assembly<S> parts_of(const Pendulum<S>& p) {
    const auto y = released_as_particles<S, Eigen::Dynamic>(p);
    const auto n = static_cast<Eigen::Index>(p.links());
    Assembly<S> parts;
    for (std::size_t i = 0; i < p.links(); ++i) {
        const auto k = 2 * static_cast<Eigen::Index>(i);
        parts.particles.push_back({p.mass[i], y.template segment<2>(k), y.template segment<2>(2 * n + k)});
        const End<S> above = i == 0 ? End<S>(Place<S>(S(0), S(0))) : End<S>(i - 1);
        parts.constraints.push_back(Rod<S>{i, above, p.length[i]});
    }
    parts.forces.push_back(Gravity<S>{p.gravity});
    return parts;
}

}  // namespace doppel
