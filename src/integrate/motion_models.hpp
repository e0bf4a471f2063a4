#pragma once

#include "integrate/simulation.hpp"
#include "physics/angle_chain.hpp"
#include "physics/double_pendulum.hpp"
#include "physics/mechanism.hpp"
#include "physics/rod_chain.hpp"

namespace doppel {

/// The bobs of a chain in angles. Forces in rods are those of the state as doubles, for pictures.
template <class Scalar>
struct AnglesView {
    static constexpr bool follows_turns = false;
    Pendulum<Scalar> pendulum;

    template <class State>
    Bobs<Scalar> bobs(const State& y) const {
        return bobs_of_angles(pendulum, y);
    }
    template <class State>
    Scalar energy(const State&, const Bobs<Scalar>& seen) const {
        return doppel::energy(seen, pendulum.gravity);
    }
    template <class State>
    Scalar length_error(const State&, const Bobs<Scalar>&) const {
        return Scalar(0);
    }
    std::vector<double> tension(const Bobs<double>& seen) const {
        return tensions(pendulum.template cast<double>(), seen);
    }
};

/// The bobs of a chain of particles.
template <class Scalar>
struct ParticlesView {
    static constexpr bool follows_turns = true;
    Pendulum<Scalar> pendulum;

    template <class State>
    Bobs<Scalar> bobs(const State& y) const {
        return bobs_of_particles(pendulum, y);
    }
    template <class State>
    Scalar energy(const State&, const Bobs<Scalar>& seen) const {
        return doppel::energy(seen, pendulum.gravity);
    }
    template <class State>
    Scalar length_error(const State&, const Bobs<Scalar>& seen) const {
        return doppel::length_error(pendulum, seen);
    }
    std::vector<double> tension(const Bobs<double>& seen) const {
        return tensions(pendulum.template cast<double>(), seen);
    }
};

/// The particles of a mechanism, which reports its energy, errors and forces itself.
template <class Scalar>
struct MechanismView {
    static constexpr bool follows_turns = false;
    Mechanism<Scalar> mechanism;
    mutable std::optional<Mechanism<double>> weighed;  // computes in space of its own, where forces are wanted

    MechanismView(const Assembly<Scalar>& assembly, const MotionSpec& spec) : mechanism(assembly) {
        if (spec.wants_tension) weighed.emplace(spec.parts->cast<double>());
    }

    template <class State>
    Bobs<Scalar> bobs(const State& y) const {
        return mechanism.bobs(y);
    }
    template <class State>
    Scalar energy(const State& y, const Bobs<Scalar>&) const {
        return mechanism.energy(y);
    }
    template <class State>
    Scalar length_error(const State& y, const Bobs<Scalar>&) const {
        return mechanism.length_error(y);
    }
    std::vector<double> tension(const Bobs<double>& seen) const { return weighed->tensions(particles_of(seen)); }
};

/// The same, where the particles hang in a chain, whose angles are known.
template <class Scalar>
struct ChainMechanismView : MechanismView<Scalar> {
    static constexpr bool follows_turns = true;
    Pendulum<Scalar> pendulum;

    ChainMechanismView(const Assembly<Scalar>& assembly, const MotionSpec& spec)
        : MechanismView<Scalar>(assembly, spec), pendulum(spec.chain->template cast<Scalar>()) {}

    template <class State>
    Bobs<Scalar> bobs(const State& y) const {
        return bobs_of_particles(pendulum, y);
    }
};

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

template <class Scalar>
std::unique_ptr<Motion> make_mechanism_motion(const MotionSpec& spec) {
    check(spec.parts->cast<double>());
    const auto assembly = spec.parts->cast<Scalar>();
    if (!spec.chain) return stabilised<Mechanism<Scalar>>(spec, assembly, MechanismView<Scalar>(assembly, spec));
    return stabilised<Mechanism<Scalar>>(spec, assembly, ChainMechanismView<Scalar>(assembly, spec));
}

}  // namespace doppel
