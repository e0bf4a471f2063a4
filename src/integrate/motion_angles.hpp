#pragma once

#include "integrate/simulation.hpp"
#include "physics/angle_chain.hpp"
#include "physics/double_pendulum.hpp"

namespace doppel {

/// Two links go by the closed form; chains by O(N), three of double unrolled by the compiler.
template <class Scalar>
std::unique_ptr<Motion> make_angles_motion(const MotionSpec& spec) {
    const auto p = spec.chain->cast<Scalar>();
    const auto made = [&]<class Model>(std::type_identity<Model>) {
        return simulation(spec, Model(p), Model::start(p), AnglesView<Scalar>{p});
    };
    if (p.links() == 2) return made(std::type_identity<DoublePendulum<Scalar>>());
    if constexpr (std::is_same_v<Scalar, double>)
        if (p.links() == 3) return made(std::type_identity<AngleChain<Scalar, 3>>());
    return made(std::type_identity<AngleChain<Scalar, Eigen::Dynamic>>());
}

}  // namespace doppel
