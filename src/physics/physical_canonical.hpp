#pragma once

#include "base/error.hpp"
#include "physics/canonical.hpp"
#include "physics/physical_chain.hpp"

#include <vector>

namespace doppel {

/// The Hamiltonian form of rigid bodies, with the joint of link i at j_i, P_i the momentum of link i and all below, and
/// S_i = m_i a_i + l_i Σ_{k>i} m_k:
///     p_i  = (I_i + m_i a_i²) ω_i + t_i·(m_i a_i j_i′ + l_i P_{i+1}) = Σ_k M_ik ω_k + S_i t_i·j_1′
///     p_i′ = −ω_i n_i·(m_i a_i j_i′ + l_i P_{i+1}) − g S_i sinθ_i + Q_i
/// Q_i is the torque on the link plus l_i t_i·(Σ_{k≥i} drag_k). j_1′ is the velocity of the pivot, a function of time.
/// Time and work are as in (θ, ω). Without friction the flow is symplectic in (θ, p); with friction methods are of
/// their order.
/// Errors  exit 2 with Coulomb friction, whose joints come to rest at the end of steps.
template <class S>
struct Canonical<PhysicalChain<S>> {
    using Scalar = S;
    using Model = PhysicalChain<S>;
    using State = typename Model::State;
    using Half = typename Model::Half;
    using Vector = Planar<Scalar>;
    struct Angles {};

    Model& model;
    Half first;                       // S, kg m
    Half p, omega;                    // N m s, rad/s
    std::vector<Vector> joint, push;  // m/s: velocity of each link's joint; N s: m a j′ + l P_{i+1}

    explicit Canonical(Model& chain)
        : model(chain),
          first(Half::Zero(chain.layout.coordinates)),
          p(first),
          omega(first),
          joint(chain.bodies().size(), Vector{Scalar(0), Scalar(0)}),
          push(joint) {
        if (!chain.pendulum.friction.coulomb.empty())
            throw bad_input("Gauss collocation does not support Coulomb friction; choose another method");
        Scalar below(0);
        for (std::size_t i = joint.size(); i-- > 0;) {
            const auto& link = chain.bodies()[i];
            first[row(i)] = link.first + link.length * below;
            below += link.mass;
        }
    }

    void momenta(const State& y, State& z) {
        const auto n = model.layout.coordinates, half = model.layout.half;
        model.take_angles(y);
        omega = y.segment(half, n);
        take_momenta(pivot_at(y).velocity);
        z = y;
        for (std::size_t i = 0; i < joint.size(); ++i) {
            const auto& link = model.bodies()[i];
            z[half + row(i)] = link.second * omega[row(i)] + dot(link.across, push[i]);
        }
    }

    void velocities(const State& z, State& y) {
        solve(z, pivot_at(z).velocity);
        y = z;
        y.segment(model.layout.half, model.layout.coordinates) = omega;
    }

    void rate(const State& z, Angles&, State& dzdt) {
        const auto half = model.layout.half;
        const auto pivot = pivot_at(z);
        solve(z, pivot.velocity);
        take_momenta(pivot.velocity);
        const auto& forces = model.forces_at(omega, model.layout.time_of(z), pivot.velocity);
        Vector drag{Scalar(0), Scalar(0)};
        for (std::size_t i = joint.size(); i-- > 0;) {
            const auto& link = model.bodies()[i];
            const auto k = row(i);
            dzdt[k] = omega[k];
            dzdt[half + k] = forces.torque[k] - (omega[k] * dot(link.along, push[i]) +
                                                 model.pendulum.chain.gravity * first[k] * link.along.x);
            if (forces.drag.empty()) continue;
            drag = drag + forces.drag[i];
            dzdt[half + k] += link.length * dot(link.across, drag);
        }
        Scalar power = forces.power;
        if (model.pendulum.pivot.moves()) power += dot(model.pivot_force(pivot.acceleration), pivot.velocity);
        model.layout.rate(z, power, dzdt);
    }

private:
    static Eigen::Index row(std::size_t i) { return static_cast<Eigen::Index>(i); }

    PivotPlace<Scalar> pivot_at(const State& z) const { return {model.pendulum.pivot, model.layout.time_of(z)}; }

    /// ω
    void solve(const State& z, const Vector& pivot_velocity) {
        model.take_angles(z);
        p = z.segment(model.layout.half, model.layout.coordinates);
        if (model.pendulum.pivot.moves())
            for (std::size_t i = 0; i < joint.size(); ++i)
                p[row(i)] -= first[row(i)] * dot(model.bodies()[i].across, pivot_velocity);
        model.solve_mass(p, omega);
    }

    /// Computes joint and push from ω.
    void take_momenta(const Vector& pivot_velocity) {
        Vector v = pivot_velocity;
        for (std::size_t i = 0; i < joint.size(); ++i) {
            const auto& link = model.bodies()[i];
            joint[i] = v;
            v = v + link.across * Scalar(link.length * omega[row(i)]);
        }
        Vector below{Scalar(0), Scalar(0)};  // P_{i+1}
        for (std::size_t i = joint.size(); i-- > 0;) {
            const auto& link = model.bodies()[i];
            push[i] = joint[i] * link.first + below * link.length;
            below = below + joint[i] * link.mass + link.across * Scalar(link.first * omega[row(i)]);
        }
    }
};

}  // namespace doppel
