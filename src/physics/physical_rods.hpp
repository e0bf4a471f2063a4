#pragma once

#include "physics/end_masses.hpp"
#include "physics/physical_forces.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace doppel {

/// A chain of rigid bodies as the ends of its links, which constraints hold apart: the same motion as PhysicalChain, in
/// O(N) (EndMasses, RodPullsOfBodies).
///
///     C_k = ½ (|r_k|² − l_k²) = 0,   r_k = q_k − q_{k−1},   q_0 = p(t), the pivot
///
/// A torque τ on a link acts as a couple on its ends, ± τ r⊥ / |r|². The time of a driven chain is a coordinate that
/// nothing pushes; so J v = r_1·(v_1 − p′ v_t) in the first row. The work's rate contains the pivot's force, and
/// so pull() adds to it what the rods do there.
///
/// State   (q, v) of PhysicalLayout, q = (x1, y1 … xN, yN …), m.
/// Errors  exit 2 with Coulomb's friction, whose joints come to rest in angles alone, and those of EndMasses.
template <class S>
class PhysicalRods {
public:
    using Scalar = S;
    using State = doppel::State<Scalar, Eigen::Dynamic>;
    using Half = State;
    using Multipliers = State;
    using Vector = Planar<Scalar>;

    PhysicalPendulum<Scalar> pendulum;
    PhysicalLayout layout;

    explicit PhysicalRods(const PhysicalPendulum<Scalar>& p)
        : pendulum(p),
          layout(p, 2 * links(p)),
          masses_(p),
          pulls_(p.chain.links()),
          forces_(p),
          rates_(Half::Zero(links(p))),
          lambda_(rates_),
          moved_(rates_),
          push_(Half::Zero(2 * links(p))),
          q_(Half::Zero(layout.half)),
          v_(q_),
          a_(q_) {
        if (!p.friction.coulomb.empty())
            throw bad_input(
                "joints with Coulomb's friction come to rest, which is computed in angles; choose model = \"angles\"");
    }

    static State start(const PhysicalPendulum<Scalar>& p) {
        const PhysicalLayout layout(p, 2 * links(p));
        const auto n = layout.coordinates;
        State y(2 * layout.half);
        layout.start(y);
        const auto released = released_as_particles<Scalar, Eigen::Dynamic>(p.chain);
        const PivotPlace<Scalar> pivot(p.pivot, Scalar(0));
        for (Eigen::Index i = 0; i < n; i += 2) {
            put(y, i, at(released, i) + pivot.place);
            put(y, layout.half + i, at(released, n + i) + pivot.velocity);
        }
        return y;
    }

    /// dydt ← d/dt of the state.
    void rate(const State& y, State& dydt) {
        q_ = y.head(layout.half);
        v_ = y.tail(layout.half);
        free_acceleration(q_, v_, a_);
        jdot_v(q_, v_, lambda_);
        constraint_velocity(q_, a_, moved_);
        lambda_ = -(lambda_ + moved_);
        solve(q_, q_, lambda_);
        pull(q_, lambda_, a_);
        dydt.head(layout.half) = v_;
        dydt.tail(layout.half) = a_;
    }

    /// The forces, or, of motors, their work.
    bool feels_velocity() const { return feels_; }

    // What methods that keep to the constraints themselves need (physics/constraint.hpp). Positions q, velocities v.

    Eigen::Index constraints() const { return masses_.size(); }

    /// a ← M⁻¹ F, the accelerations without rods, and the power without them.
    void free_acceleration(const Half& q, const Half& v, Half& a) {
        const auto pivot = pivot_at(q);
        const Vector fall{Scalar(0), Scalar(-pendulum.chain.gravity)};
        a.setZero();
        take_forces(q, v, pivot);
        if (feels_) masses_.add_solved(push_, a);
        for (Eigen::Index k = 0; k < constraints(); ++k)
            put(a, 2 * k, at(a, 2 * k) + fall - (pivot.acceleration - fall) * masses_.led[k]);
        if (layout.work < 0) return;
        a[layout.work] = forces_.power;
        if (pendulum.pivot.moves()) a[layout.work] += dot(pivot_force(a, pivot.acceleration, fall), pivot.velocity);
    }

    /// c ← C(q), m²
    void residual(const Half& q, Multipliers& c) const {
        const auto pivot = pivot_at(q);
        for (Eigen::Index k = 0; k < c.size(); ++k) {
            const Vector r = along(q, k, pivot.place);
            const Scalar& l = pendulum.chain.length[static_cast<std::size_t>(k)];
            c[k] = (dot(r, r) - l * l) * Scalar(0.5);
        }
    }

    /// c ← ε |q| Σ_j |J_ij|, with the largest coordinate, the pivot's too
    void rounding(const Half& q, Multipliers& c) const {
        using std::abs;
        const auto pivot = pivot_at(q);
        Scalar largest = abs(pivot.place.x) < abs(pivot.place.y) ? abs(pivot.place.y) : abs(pivot.place.x);
        for (Eigen::Index i = 0; i < layout.coordinates; ++i)
            if (largest < abs(q[i])) largest = abs(q[i]);
        const Scalar unit = Scalar(std::numeric_limits<Scalar>::epsilon()) * largest;
        for (Eigen::Index k = 0; k < c.size(); ++k) {
            const Vector r = along(q, k, pivot.place);
            const Scalar part = abs(r.x) + abs(r.y);
            c[k] = (k == 0 && !pendulum.pivot.moves() ? part : Scalar(part + part)) * unit;
        }
    }

    /// s ← J(q) v
    void constraint_velocity(const Half& q, const Half& v, Multipliers& s) const {
        const auto pivot = pivot_at(q);
        const Vector led = pivot.velocity * layout.time_of(v);
        for (Eigen::Index k = 0; k < s.size(); ++k) s[k] = dot(along(q, k, pivot.place), along(v, k, led));
    }

    /// s ← J̇ v, the part of C″ that is there without any acceleration
    void jdot_v(const Half& q, const Half& v, Multipliers& s) const {
        const auto pivot = pivot_at(q);
        const Scalar rate = layout.time_of(v);
        const Vector led = pivot.velocity * rate;
        for (Eigen::Index k = 0; k < s.size(); ++k) {
            const Vector u = along(v, k, led);
            s[k] = dot(u, u);
        }
        if (pendulum.pivot.moves()) s[0] -= dot(along(q, 0, pivot.place), pivot.acceleration * Scalar(rate * rate));
    }

    /// v ← v + M⁻¹ Jᵀ(q) λ; and the work that the pivot does by it.
    void pull(const Half& q, const Multipliers& lambda, Half& v) {
        const auto pivot = pivot_at(q);
        Vector below{Scalar(0), Scalar(0)};
        for (Eigen::Index k = constraints() - 1; k >= 0; --k) {
            const Vector pulled = along(q, k, pivot.place) * lambda[k];
            put(push_, 2 * k, pulled - below);
            below = pulled;
        }
        const Vector momentum = masses_.add_solved(push_, v);
        if (pendulum.pivot.moves()) v[layout.work] += dot(momentum, pivot.velocity);
    }

    /// x ← (J(q1) M⁻¹ Jᵀ(q0))⁻¹ x
    void solve(const Half& q1, const Half& q0, Multipliers& x) {
        const Vector pivot1 = pivot_at(q1).place, pivot0 = pivot_at(q0).place;
        pulls_.solve(
            masses_, [&](Eigen::Index k) { return std::pair(along(q0, k, pivot0), along(q1, k, pivot1)); }, x);
    }

private:
    static Eigen::Index links(const PhysicalPendulum<Scalar>& p) { return static_cast<Eigen::Index>(p.chain.links()); }

    template <class Values>
    static Vector at(const Values& values, Eigen::Index i) {
        return {values[i], values[i + 1]};
    }
    template <class Values>
    static void put(Values& values, Eigen::Index i, const Vector& value) {
        values[i] = value.x;
        values[i + 1] = value.y;
    }
    /// What node k has more than the one above it; that of node 0 is given.
    static Vector along(const Half& q, Eigen::Index k, const Vector& pivot) {
        return at(q, 2 * k) - (k == 0 ? pivot : at(q, 2 * k - 2));
    }
    PivotPlace<Scalar> pivot_at(const Half& q) const { return {pendulum.pivot, layout.time_of(q)}; }

    /// Friction and motors, and what they push the ends with.
    void take_forces(const Half& q, const Half& v, const PivotPlace<Scalar>& pivot) {
        if (!feels_) return;
        push_.setZero();
        for (Eigen::Index k = 0; k < constraints(); ++k) {
            const Vector r = along(q, k, pivot.place), u = along(v, k, pivot.velocity);
            rates_[k] = (r.x * u.y - r.y * u.x) / dot(r, r);
        }
        forces_.update(rates_, layout.time_of(q), [](Eigen::Index) { return 0; });
        if (!pendulum.friction.air_quadratic.empty())
            for (Eigen::Index k = 0; k < constraints(); ++k) {
                using std::sqrt;
                const Vector r = along(q, k, pivot.place);
                const Vector across = Vector{Scalar(-r.y), r.x} * Scalar(Scalar(1) / sqrt(dot(r, r)));
                forces_.update_air(k, across, k == 0 ? pivot.velocity : at(v, 2 * k - 2), rates_[k]);
            }
        for (Eigen::Index k = 0; k < constraints(); ++k) {
            const Vector r = along(q, k, pivot.place);
            const Vector couple = Vector{Scalar(-r.y), r.x} * Scalar(forces_.torque[k] / dot(r, r));
            put(push_, 2 * k, at(push_, 2 * k) + couple);
            if (k > 0) put(push_, 2 * k - 2, at(push_, 2 * k - 2) - couple);
        }
        if (forces_.drag.empty()) return;
        for (Eigen::Index k = 0; k < constraints(); ++k) {
            using std::abs;
            const Vector velocity = at(v, 2 * k);
            const bool on_circle = k == 0 && !pendulum.pivot.moves();  // as in PhysicalChain
            forces_.update_drag(
                k, velocity,
                on_circle ? Scalar(abs(rates_[0]) * pendulum.chain.length[0]) : forces_.speed_of(velocity));
            put(push_, 2 * k, at(push_, 2 * k) + forces_.drag[static_cast<std::size_t>(k)]);
        }
    }

    /// With which the pivot holds the chain, N, where its ends are accelerated so: what momentum needs besides weight and
    /// drag.
    Vector pivot_force(const Half& a, const Vector& acceleration, const Vector& fall) const {
        Vector force = masses_.momentum(a) + acceleration * masses_.at_pivot - fall * masses_.total - forces_.at_pivot;
        for (const auto& drag : forces_.drag) force = force - drag;
        return force;
    }

    EndMasses<Scalar> masses_;
    RodPullsOfBodies<Scalar> pulls_;
    PhysicalForces<Scalar> forces_;
    bool feels_ = !pendulum.friction.is_none() || !pendulum.torques.empty();
    Half rates_;
    Multipliers lambda_, moved_;
    Half push_, q_, v_, a_;
};

}  // namespace doppel
