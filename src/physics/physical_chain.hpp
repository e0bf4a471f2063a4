#pragma once

#include "physics/articulated.hpp"
#include "physics/physical_forces.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <optional>
#include <vector>

namespace doppel {

/// A chain of rigid bodies in angles, with friction, motors and a pivot that moves: M θ″ = f in O(N) (ArticulatedBodies).
///
/// A joint with Coulomb's friction whose rate is 0 is held while a torque of at most c holds it: then it keeps its angle
/// exactly. A step that ends with a rate of at most w ends at rest where it can be held so (project()).
///
/// State   (q, v) of PhysicalLayout, q = (θ1 … θN …). Angles are not wrapped.
template <class S>
class PhysicalChain {
public:
    using Scalar = S;
    using State = doppel::State<Scalar, Eigen::Dynamic>;
    using Half = State;

    PhysicalPendulum<Scalar> pendulum;
    PhysicalLayout layout;

    explicit PhysicalChain(const PhysicalPendulum<Scalar>& p, bool with_work = true)
        : pendulum(p),
          layout(p, links(p), with_work),
          forces_(p),
          bodies_(p),
          sin_(Half::Zero(links(p))),
          cos_(sin_),
          rates_(sin_),
          alpha_(sin_),
          held_(p.chain.links(), false),
          slip_(p.chain.links(), 0) {}

    static State start(const PhysicalPendulum<Scalar>& p, bool with_work = true) {
        const PhysicalLayout layout(p, links(p), with_work);
        State y(2 * layout.half);
        layout.start(y);
        const auto released = released_in_angles<Scalar, Eigen::Dynamic>(p.chain);
        y.head(layout.coordinates) = released.head(layout.coordinates);
        y.segment(layout.half, layout.coordinates) = released.tail(layout.coordinates);
        return y;
    }

    /// dydt ← d/dt of the state.
    void rate(const State& y, State& dydt) {
        const auto n = layout.coordinates;
        const auto omega = y.segment(layout.half, n);
        for (Eigen::Index i = 0; i < n; ++i) held_[at(i)] = has_coulomb(i) && rate_at(omega, i) == Scalar(0);
        const auto pivot = accelerate(y, omega);
        for (Eigen::Index i = 0; i < n; ++i) {
            dydt[i] = omega[i];
            dydt[layout.half + i] = alpha_[i];
        }
        layout.rate(y, Scalar(forces_.power + dot(pivot.force, pivot.velocity)), dydt);
    }

    bool projects() const { return !pendulum.friction.coulomb.empty(); }
    /// Joints that turn at w or less come to rest where friction can hold them.
    void project(State& y) {
        const auto n = layout.coordinates;
        auto omega = y.segment(layout.half, n);
        bool any = false;
        for (Eigen::Index i = 0; i < n; ++i) {
            const Scalar rate = rate_at(omega, i);
            held_[at(i)] = has_coulomb(i) && rate <= pendulum.friction.width && -rate <= pendulum.friction.width;
            any = any || (held_[at(i)] && rate != Scalar(0));
        }
        if (!any) return;
        accelerate(y, Half(omega));
        for (Eigen::Index i = 0; i < n; ++i) omega[i] = rates_[i];
    }

    /// For Hamilton's form (Canonical), at the angles of y = (q, …).
    void take_angles(const State& y) {
        take_sin_cos(y, sin_, cos_);
        bodies_.factor(sin_, cos_);
    }
    void solve_mass(const Half& f, Half& a) { bodies_.solve_mass(f, a); }
    /// Without Coulomb's friction.
    const PhysicalForces<Scalar>& forces_at(const Half& omega, const Scalar& t, const Planar<Scalar>& pivot_velocity) {
        rates_ = omega;
        take_forces(t, pivot_velocity);
        return forces_;
    }
    /// With which the pivot holds the chain, N, at those rates and forces.
    Planar<Scalar> pivot_force(const Planar<Scalar>& acceleration) {
        return bodies_.accelerate(forces_.torque, forces_.drag, rates_, pendulum.chain.gravity, acceleration, alpha_) -
               forces_.at_pivot;
    }
    const std::vector<typename ArticulatedBodies<Scalar>::Link>& bodies() const { return bodies_.links(); }

private:
    /// What the pivot does to the chain.
    struct Pivot {
        Planar<Scalar> force, velocity;  // N, m/s
    };

    static Eigen::Index links(const PhysicalPendulum<Scalar>& p) { return static_cast<Eigen::Index>(p.chain.links()); }
    static std::size_t at(Eigen::Index i) { return static_cast<std::size_t>(i); }
    template <class Rates>
    static Scalar rate_at(const Rates& omega, Eigen::Index joint) {
        return joint == 0 ? Scalar(omega[0]) : Scalar(omega[joint] - omega[joint - 1]);
    }
    bool has_coulomb(Eigen::Index i) const {
        return !pendulum.friction.coulomb.empty() && pendulum.friction.coulomb[at(i)] != Scalar(0);
    }

    /// rates ← omega, but those of held joints, which turn with the link above.
    template <class Rates>
    void rest(const Rates& omega, Half& rates) const {
        for (Eigen::Index i = 0; i < rates.size(); ++i)
            rates[i] = !held_[at(i)] ? Scalar(omega[i]) : i == 0 ? Scalar(0) : Scalar(rates[i - 1]);
    }

    /// rates_ ← omega, where held joints rest, and alpha_ at them; joints that friction cannot hold are taken out of held_.
    template <class Rates>
    Pivot accelerate(const State& y, const Rates& omega) {
        take_sin_cos(y, sin_, cos_);
        bodies_.factor(sin_, cos_);
        const Scalar t = layout.time_of(y);
        const PivotPlace<Scalar> pivot(pendulum.pivot, t);
        auto tried = attempt(omega, t, pivot);
        std::vector<std::size_t> let_go;
        while (tried.slips) {
            held_[*tried.slips] = false;
            let_go.push_back(*tried.slips);
            tried = attempt(omega, t, pivot);
        }
        // one that was let go may well be held now that others slide
        for (const auto joint : let_go) {
            held_[joint] = true;
            auto again = attempt(omega, t, pivot);
            if (again.slips) {
                held_[joint] = false;
                again = attempt(omega, t, pivot);
            }
            tried = again;
        }
        return {tried.force, pivot.velocity};
    }

    /// The accelerations with the joints in held_ at rest.
    struct Attempt {
        Planar<Scalar> force;              // of the pivot, N
        std::optional<std::size_t> slips;  // the joint that takes most in excess of what friction gives
    };
    template <class Rates>
    Attempt attempt(const Rates& omega, const Scalar& t, const PivotPlace<Scalar>& pivot) {
        rest(omega, rates_);
        take_forces(t, pivot.velocity);
        const auto solve = [&] {
            return bodies_.accelerate(forces_.torque, forces_.drag, rates_, pendulum.chain.gravity, pivot.acceleration,
                                      alpha_) -
                   forces_.at_pivot;
        };
        const auto free = solve();
        if (std::find(held_.begin(), held_.end(), true) == held_.end()) return {free, std::nullopt};
        if (const auto slips = add_holding_torques()) return {free, slips};
        const auto force = solve();
        const Half all = alpha_;
        rest(all, alpha_);
        return {force, std::nullopt};
    }

    void take_forces(const Scalar& t, const Planar<Scalar>& pivot_velocity) {
        forces_.update(rates_, t, [&](Eigen::Index i, const Scalar& rate) {
            return !has_coulomb(i) || held_[at(i)] ? 0 : rate > Scalar(0) ? 1 : rate < Scalar(0) ? -1 : slip_[at(i)];
        });
        if (forces_.drag.empty()) return;
        Planar<Scalar> v = pivot_velocity;
        for (Eigen::Index i = 0; i < sin_.size(); ++i) {
            using std::abs;
            const Scalar own = pendulum.chain.length[at(i)] * rates_[i];
            const Planar<Scalar> across{cos_[i], sin_[i]};
            forces_.update_air(i, across, v, rates_[i]);
            v = v + across * own;
            // on a circle the speed vanishes again and again, and its root says so no more: |ω| does
            const bool on_circle = i == 0 && !pendulum.pivot.moves();
            forces_.update_drag(i, v, on_circle ? Scalar(abs(own)) : forces_.speed_of(v));
        }
    }

    /// The torques λ that keep the held joints at rest: (D M⁻¹ Dᵀ) λ = −D θ″, where D takes the rates of links to those of
    /// joints. None is added where friction cannot give one of them: returns the joint that exceeds it by most.
    std::optional<std::size_t> add_holding_torques() {
        std::vector<Eigen::Index> joints;
        for (Eigen::Index i = 0; i < alpha_.size(); ++i)
            if (held_[at(i)]) joints.push_back(i);
        const auto m = static_cast<Eigen::Index>(joints.size());
        Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> matrix(m, m);
        Half right(m), one(alpha_.size()), answer(alpha_.size());
        for (Eigen::Index k = 0; k < m; ++k) {
            one.setZero();
            add_torque(joints[at(k)], Scalar(1), one);
            bodies_.solve_mass(one, answer);
            for (Eigen::Index j = 0; j < m; ++j) matrix(j, k) = rate_at(answer, joints[at(j)]);
            right[k] = -rate_at(alpha_, joints[at(k)]);
        }
        const Half torque = matrix.partialPivLu().solve(right);
        Eigen::Index worst = 0;
        Scalar most(0);
        for (Eigen::Index k = 0; k < m; ++k) {
            using std::abs;
            const Scalar share = abs(torque[k]) / pendulum.friction.coulomb[at(joints[at(k)])];
            if (share <= most) continue;
            most = share;
            worst = k;
        }
        if (most > Scalar(1)) {
            const auto joint = at(joints[at(worst)]);
            slip_[joint] = torque[worst] > Scalar(0) ? -1 : 1;
            return joint;
        }
        for (Eigen::Index k = 0; k < m; ++k) add_torque(joints[at(k)], torque[k], forces_.torque);
        return std::nullopt;
    }
    static void add_torque(Eigen::Index joint, const Scalar& torque, Half& on_links) {
        on_links[joint] += torque;
        if (joint > 0) on_links[joint - 1] -= torque;
    }

    PhysicalForces<Scalar> forces_;
    ArticulatedBodies<Scalar> bodies_;
    Half sin_, cos_, rates_, alpha_;
    std::vector<bool> held_;
    std::vector<int> slip_;  // the sign of the rate with which a joint at rest begins to turn that cannot be held
};

}  // namespace doppel
