#pragma once

#include "physics/pendulum.hpp"

namespace doppel {

/// What slows a chain down. A joint is where a link hangs: joint 1 at the pivot, joint i at the end of link i − 1; its rate
/// is that of its link less that of the link above. Each list has one number a link, ≥ 0, or is empty: none.
///
///     at a joint       −b ω − c sign ω                  torque on its link, the opposite on the link above
///     on a link        −k1 ω − k2 |ω| ω                 torque, by the link's own rate
///     by the air       −k3 |u| u , u = ω + t·p′ m a / J  torque about the joint p and, m a / J times it along t, force
///     on a link's end  −d1 v − d2 |v| v                 force, by its velocity
///
/// The third one acts at the centre of oscillation of a link, J / (m a) from the joint, by its normal velocity u J / (m a).
/// t is across the link, J its inertia about the joint. The second term at a joint is Coulomb friction: it holds a joint at
/// rest as long as a torque of at most c does.
template <class Scalar>
struct Friction {
    std::vector<Scalar> viscous;         // b, N m s
    std::vector<Scalar> coulomb;         // c, N m
    std::vector<Scalar> arm_linear;      // k1, N m s
    std::vector<Scalar> arm_quadratic;   // k2, N m s²
    std::vector<Scalar> air_quadratic;   // k3, N m s²
    std::vector<Scalar> drag_linear;     // d1, N s/m
    std::vector<Scalar> drag_quadratic;  // d2, N s²/m²

    auto members() const {
        return std::tie(viscous, coulomb, arm_linear, arm_quadratic, air_quadratic, drag_linear, drag_quadratic);
    }

    /// Whether forces act on the links' ends.
    bool has_drag() const { return !drag_linear.empty() || !drag_quadratic.empty() || !air_quadratic.empty(); }
    bool is_none() const { return *this == Friction(); }
};

/// A pivot that moves: its place is a cos(ν t + φ) along one direction, from the origin.
template <class Scalar>
struct PivotMotion {
    Scalar x = Scalar(0), y = Scalar(0);  // of the amplitude, m
    Scalar frequency = Scalar(0);         // ν, rad/s
    Scalar phase = Scalar(0);             // φ, rad

    auto members() const { return std::tie(x, y, frequency, phase); }

    bool moves() const { return x != Scalar(0) || y != Scalar(0); }
};

/// A motor at a joint: the torque q cos(ν t + φ) on its link, the opposite on the link above.
template <class Scalar>
struct JointTorque {
    std::size_t joint = 0;         // from 0
    Scalar amplitude = Scalar(0);  // q, N m
    Scalar frequency = Scalar(0);  // ν, rad/s
    Scalar phase = Scalar(0);      // φ, rad

    auto members() const { return std::tie(joint, amplitude, frequency, phase); }
};

/// A chain of rigid bodies (a physical pendulum), with friction and a drive. `chain.mass` is that of the bodies.
/// Its ideal form, all centres at the ends and no inertia, is the chain itself.
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

    /// Between hanging straight down and standing straight up, J.
    Scalar potential_range() const { return chain.potential_range(center); }

    auto members() const { return std::tie(chain, center, inertia, friction, pivot, torques); }
    /// The same in another scalar.
    template <class To>
    PhysicalPendulum<To> cast() const {
        return Cast<To>()(*this);
    }
};

/// A chain of point masses on massless rods, as one.
template <class Scalar>
PhysicalPendulum<Scalar> physical(const Pendulum<Scalar>& chain) {
    return {chain, chain.length, std::vector<Scalar>(chain.links(), Scalar(0)), {}, {}, {}};
}

}  // namespace doppel
