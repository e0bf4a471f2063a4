#pragma once

#include "integrate/simulation.hpp"
#include "physics/mechanism.hpp"
#include "physics/tension.hpp"

namespace doppel {

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

template <class Scalar>
std::unique_ptr<Motion> make_mechanism_motion(const MotionSpec& spec) {
    check(spec.parts->cast<double>());
    const auto assembly = spec.parts->cast<Scalar>();
    if (!spec.chain) return stabilised<Mechanism<Scalar>>(spec, assembly, MechanismView<Scalar>(assembly, spec));
    return stabilised<Mechanism<Scalar>>(spec, assembly, ChainMechanismView<Scalar>(assembly, spec));
}

}  // namespace doppel
