#pragma once

#include "physics/bob.hpp"
#include "physics/rod_multipliers.hpp"

#include <cmath>

namespace doppel {

/// The layout of the state (q, v) of a rigid-body chain. q contains the coordinates of its links; with a drive, the
/// time t, whose rate is 1; if energy is not conserved, a number whose rate is the work W by friction and drive, J, so
/// that energy − W is constant. Users that do not need W leave it out. Methods treat these like coordinates. With
/// `has_all` both are present, needed or not.
struct PhysicalLayout {
    Eigen::Index coordinates, time = -1, work = -1, half;  // `half`: size of q; −1 if not present

    template <class Scalar>
    PhysicalLayout(const PhysicalPendulum<Scalar>& p, Eigen::Index of_links, bool with_work = true,
                   bool has_all = false)
        : coordinates(of_links), half(of_links) {
        if (has_all || p.is_driven()) time = half++;
        if (has_all || (with_work && !p.conserves_energy())) work = half++;
    }

    /// From y = (q, v): the time, s, and the work, J.
    template <class State>
    auto time_of(const State& y) const {
        return time < 0 ? typename State::Scalar(0) : y[time];
    }
    template <class State>
    auto work_of(const State& y) const {
        return work < 0 ? typename State::Scalar(0) : y[half + work];
    }
    template <class State>
    void start(State& y) const {
        if (time >= 0) y[time] = typename State::Scalar(0), y[half + time] = typename State::Scalar(1);
        if (work >= 0) y[work] = y[half + work] = typename State::Scalar(0);
    }
    template <class State>
    void rate(const State& y, const typename State::Scalar& power, State& dydt) const {
        using Scalar = typename State::Scalar;
        if (time >= 0) dydt[time] = y[half + time], dydt[half + time] = Scalar(0);
        if (work >= 0) dydt[work] = y[half + work], dydt[half + work] = power;
    }
    /// (q, v) of the links alone.
    template <class Vector>
    auto of_links(const Vector& y) const {
        State<typename Vector::Scalar, Eigen::Dynamic> alone(2 * coordinates);
        alone.head(coordinates) = y.head(coordinates);
        alone.tail(coordinates) = y.segment(half, coordinates);
        return alone;
    }
};

/// Position, velocity and acceleration of the pivot at time t: m, m/s, m/s².
template <class Scalar>
struct PivotPlace {
    Planar<Scalar> place{Scalar(0), Scalar(0)}, velocity = place, acceleration = place;

    PivotPlace() = default;
    PivotPlace(const PivotMotion<Scalar>& motion, const Scalar& t) {
        if (!motion.moves()) return;
        const auto& nu = motion.frequency;
        const SinCos<Scalar> turn(Scalar(nu * t + motion.phase));
        const Planar<Scalar> amplitude{motion.x, motion.y};
        place = amplitude * turn.cos;
        velocity = amplitude * Scalar(-(nu * turn.sin));
        acceleration = amplitude * Scalar(-(nu * nu * turn.cos));
    }
};

/// The bobs of a motion, its pivot, and its energies, J.
template <class Scalar>
struct Configuration {
    Bobs<Scalar> bobs;
    Bob<Scalar> pivot{};
    Scalar energy{0}, kinetic_energy{0};
};

/// A chain of rigid bodies, whose ends are the bobs, from (θ, ω) of its links at time t. The potential energy is 0 if
/// all centres of mass are level with the origin. The body between positions p and q, with s = a/l, has its centre at
/// p + s (q − p) and rotates at |q′ − p′| / l.
template <class Scalar>
Configuration<Scalar> configuration_of(const PhysicalPendulum<Scalar>& p, const State<Scalar, Eigen::Dynamic>& links,
                                       const Scalar& t) {
    const auto& chain = p.chain;
    const PivotPlace<Scalar> at(p.pivot, t);
    Configuration<Scalar> seen{bobs_of_angles(chain, links)};
    seen.pivot = {Scalar(0), at.place.x, at.place.y, at.velocity.x, at.velocity.y};
    Scalar potential(0);
    const auto* above = &seen.pivot;
    for (std::size_t i = 0; i < seen.bobs.size(); ++i) {
        auto& end = seen.bobs[i];
        end.x += at.place.x;
        end.y += at.place.y;
        end.vx += at.velocity.x;
        end.vy += at.velocity.y;
        const Scalar part = p.center[i] / chain.length[i];
        const Scalar ux = end.vx - above->vx, uy = end.vy - above->vy;
        const Scalar vx = above->vx + part * ux, vy = above->vy + part * uy;
        const Scalar turn = (ux * ux + uy * uy) / (chain.length[i] * chain.length[i]);
        seen.kinetic_energy += Scalar(0.5) * (chain.mass[i] * (vx * vx + vy * vy) + p.inertia[i] * turn);
        potential += chain.mass[i] * chain.gravity * (above->y + part * (end.y - above->y));
        above = &end;
    }
    seen.energy = seen.kinetic_energy + potential;
    return seen;
}

/// The torques on links, N m, and forces on their ends, N, by friction and drive torques, and their power, W.
template <class S, int N = Eigen::Dynamic>
class PhysicalForces {
public:
    using Scalar = S;
    using Half = State<Scalar, N>;

    Half torque;                                    // on each link
    std::vector<Planar<Scalar>> drag;               // on the end of each link; empty if there is none
    Planar<Scalar> at_pivot{Scalar(0), Scalar(0)};  // on the first joint
    Scalar power{0};

    explicit PhysicalForces(const PhysicalPendulum<Scalar>& p)
        : torque(Half::Zero(static_cast<Eigen::Index>(p.chain.links()))),
          friction_(p.friction),
          motors_(p.torques),
          is_none_(p.friction.is_none() && p.torques.empty()) {
        if (friction_.has_drag()) drag.resize(p.chain.links());
    }

    /// Updates them for the rates ω of the links and the time t. slides[i] is the sign of joint i in Coulomb's law; 0
    /// if it is held.
    template <class Rates>
    void update(const Rates& omega, const Scalar& t, const std::vector<int>& slides) {
        if (is_none_) return;
        power = Scalar(0);
        torque.setZero();
        at_pivot = {Scalar(0), Scalar(0)};
        for (auto& force : drag) force = at_pivot;
        for (Eigen::Index i = 0; i < torque.size(); ++i) {
            const Scalar rate = i == 0 ? Scalar(omega[0]) : Scalar(omega[i] - omega[i - 1]);
            Scalar at_joint(0);
            if (!friction_.viscous.empty()) at_joint -= of(friction_.viscous, i) * rate;
            if (const int sign = slides[static_cast<std::size_t>(i)]; sign != 0)
                at_joint -= Scalar(sign) * of(friction_.coulomb, i);
            for (const auto& motor : motors_)
                if (static_cast<Eigen::Index>(motor.joint) == i)
                    at_joint += motor.amplitude * SinCos<Scalar>(Scalar(motor.frequency * t + motor.phase)).cos;
            torque[i] += at_joint;
            if (i > 0) torque[i - 1] -= at_joint;
            power += at_joint * rate;
            const auto on_link = [&](const Scalar& on_it) {
                torque[i] += on_it;
                power += on_it * omega[i];
            };
            if (!friction_.link_linear.empty()) on_link(Scalar(-(of(friction_.link_linear, i) * omega[i])));
            if (!friction_.link_quadratic.empty())
                on_link(Scalar(-(of(friction_.link_quadratic, i) * (size(omega[i]) * omega[i]))));
        }
    }
    /// Adds the drag at the end of link i, for its velocity and speed.
    void update_drag(Eigen::Index i, const Planar<Scalar>& v, const Scalar& speed) {
        Planar<Scalar> force{Scalar(0), Scalar(0)};
        if (!friction_.drag_linear.empty()) force = force - v * of(friction_.drag_linear, i);
        if (!friction_.drag_quadratic.empty()) force = force - v * Scalar(of(friction_.drag_quadratic, i) * speed);
        power += dot(force, v);
        auto& sum = drag[static_cast<std::size_t>(i)];
        sum = sum + force;
    }
    /// Adds the air drag of link i (of ArticulatedBodies), for the velocity of its joint.
    template <class Link>
    void update_air(Eigen::Index i, const Link& link, const Planar<Scalar>& joint, const Scalar& rate) {
        if (friction_.air_quadratic.empty()) return;
        const Scalar lever = link.first / link.second;
        const Scalar met = rate + lever * dot(link.across, joint);
        const Scalar on_it = -(of(friction_.air_quadratic, i) * (size(met) * met));
        torque[i] += on_it;
        power += on_it * met;
        auto& sum = i == 0 ? at_pivot : drag[static_cast<std::size_t>(i - 1)];
        sum = sum + link.across * Scalar(on_it * lever);
    }

    /// |v| with derivatives 0 at 0.
    static Scalar speed_of(const Planar<Scalar>& v) {
        using std::sqrt;
        if constexpr (requires { norm(v.x, v.y); }) {
            return norm(v.x, v.y);
        } else {
            const Scalar square = dot(v, v);
            return square == Scalar(0) ? Scalar(0) : Scalar(sqrt(square));
        }
    }

private:
    static const Scalar& of(const std::vector<Scalar>& list, Eigen::Index i) {
        return list[static_cast<std::size_t>(i)];
    }
    static Scalar size(const Scalar& x) {
        using std::abs;
        return abs(x);
    }

    Friction<Scalar> friction_;
    std::vector<JointTorque<Scalar>> motors_;
    bool is_none_;  // neither friction nor drive torques
};

}  // namespace doppel
