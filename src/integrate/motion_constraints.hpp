#pragma once

#include "integrate/simulation.hpp"
#include "physics/rod_chain.hpp"

namespace doppel {

/// A chain of particles on rods: two and three links of double unrolled by the compiler (three stabilised ones not: their
/// compilation takes longer than they save).
template <class Scalar>
std::unique_ptr<Motion> make_constraints_motion(const MotionSpec& spec) {
    const auto p = spec.chain->cast<Scalar>();
    const auto made = [&]<class Model>(std::type_identity<Model>) {
        return stabilised<Model>(spec, p, ParticlesView<Scalar>{p});
    };
    if constexpr (std::is_same_v<Scalar, double>) {
        if (p.links() == 2) return made(std::type_identity<RodChain<Scalar, 2>>());
        if (p.links() == 3 && spec.stabilise == Stabilise::none)
            return simulation(spec, RodChain<Scalar, 3>(p), RodChain<Scalar, 3>::start(p), ParticlesView<Scalar>{p});
    }
    return made(std::type_identity<RodChain<Scalar, Eigen::Dynamic>>());
}

}  // namespace doppel
