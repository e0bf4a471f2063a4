#pragma once

#include "physics/pendulum.hpp"

namespace doppel {

/// The friction of a chain. Joint 1 is the pivot, joint i is at the end of link i − 1. The rate of a joint is that of
/// its link minus that of the previous link. Each list has one number ≥ 0 per link, or is empty: no friction.
///
///     at a joint       −b ω − c sign ω                  torque on its link, and the opposite on the previous link
///     on a link        −k1 ω − k2 |ω| ω                 torque, with the link's own rate
///     by the air       −k3 |u| u , u = ω + t·p′ m a / J  torque about the joint p, and a force m a / J times it along
///     t
///     on a link's end  −d1 v − d2 |v| v                 force, with its velocity
///
/// The third one acts at the centre of oscillation of a link, J / (m a) from the joint, with its normal velocity u J /
/// (m a). t is across the link, J its moment of inertia about the joint. The term c is Coulomb friction: it holds a
/// joint at rest as long as a torque of at most c is enough.
template <class Scalar>
struct Friction {
    std::vector<Scalar> viscous;         // b, N m s
    std::vector<Scalar> coulomb;         // c, N m
    std::vector<Scalar> link_linear;     // k1, N m s
    std::vector<Scalar> link_quadratic;  // k2, N m s²
    std::vector<Scalar> air_quadratic;   // k3, N m s²
    std::vector<Scalar> drag_linear;     // d1, N s/m
    std::vector<Scalar> drag_quadratic;  // d2, N s²/m²

    auto members() const {
        return std::tie(viscous, coulomb, link_linear, link_quadratic, air_quadratic, drag_linear, drag_quadratic);
    }

    /// Whether there are forces on the links' ends.
    bool has_drag() const { return !drag_linear.empty() || !drag_quadratic.empty() || !air_quadratic.empty(); }
    bool is_none() const { return *this == Friction(); }
};

/// An oscillating pivot: its position is a cos(ν t + φ) along one direction, from the origin.
template <class Scalar>
struct PivotMotion {
    Scalar x = Scalar(0), y = Scalar(0);  // of the amplitude, m
    Scalar frequency = Scalar(0);         // ν, rad/s
    Scalar phase = Scalar(0);             // φ, rad

    auto members() const { return std::tie(x, y, frequency, phase); }

    bool moves() const { return x != Scalar(0) || y != Scalar(0); }
};

/// A driving torque at a joint: q cos(ν t + φ) on its link, and the opposite on the previous link.
template <class Scalar>
struct JointTorque {
    std::size_t joint = 0;         // from 0
    Scalar amplitude = Scalar(0);  // q, N m
    Scalar frequency = Scalar(0);  // ν, rad/s
    Scalar phase = Scalar(0);      // φ, rad

    auto members() const { return std::tie(joint, amplitude, frequency, phase); }
};

/// A chain of rigid bodies (a physical pendulum) with friction and drive. `chain.mass` contains the masses of the
/// bodies. With all centres at the ends and no inertia it equals the ideal chain.
template <class Scalar>
struct PhysicalPendulum {
    Pendulum<Scalar> chain;
    std::vector<Scalar> center;   // m, from a link's joint to its centre of mass, along the link
    std::vector<Scalar> inertia;  // kg m², ≥ 0, about the centre of mass
    Friction<Scalar> friction;
    PivotMotion<Scalar> pivot;
    std::vector<JointTorque<Scalar>> torques;

    bool is_driven() const { return pivot.moves() || !torques.empty(); }
    bool conserves_energy() const { return friction.is_none() && !is_driven(); }

    /// Energy difference between hanging straight down and standing straight up, J.
    Scalar potential_range() const { return chain.potential_range(center); }

    auto members() const { return std::tie(chain, center, inertia, friction, pivot, torques); }
    /// The same in another scalar.
    template <class To>
    PhysicalPendulum<To> cast() const {
        return Cast<To>()(*this);
    }
};

/// A chain of point masses on massless rods as a rigid-body chain.
template <class Scalar>
PhysicalPendulum<Scalar> physical(const Pendulum<Scalar>& chain) {
    return {chain, chain.length, std::vector<Scalar>(chain.links(), Scalar(0)), {}, {}, {}};
}

}  // namespace doppel
