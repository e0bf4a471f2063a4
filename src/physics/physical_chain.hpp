#pragma once

#include "numeric/solvers.hpp"
#include "physics/articulated.hpp"
#include "physics/physical_forces.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace doppel {

/// A chain of rigid bodies in angles, with friction, drive torques and a moving pivot: M θ″ = f in O(N)
/// (ArticulatedBodies).
///
/// A joint with Coulomb friction that comes to rest is held as long as a torque of at most c can hold it; its angle is
/// then exactly constant. Between such events the right-hand side is smooth.
///
/// State   (q, v) of PhysicalLayout, q = (θ1 … θN …), with time and work if N is known to the compiler. Angles are not
///         wrapped.
template <class S, int N = Eigen::Dynamic>
class PhysicalChain {
public:
    using Scalar = S;
    static constexpr bool has_all = N != Eigen::Dynamic;
    /// Not over numbers with derivatives or a tape, which have no motion of their own.
    static constexpr bool chooses_modes = !requires(const Scalar& number) { number.value; };
    using State = doppel::State<Scalar, has_all ? 2 * (N + 2) : N>;
    using Half = doppel::State<Scalar, N>;
    using Angles = StageAngles<Scalar, N>;

    PhysicalPendulum<Scalar> pendulum;
    PhysicalLayout layout;

    explicit PhysicalChain(const PhysicalPendulum<Scalar>& p, bool with_work = true)
        : pendulum(p),
          layout(p, links(p), with_work, has_all),
          forces_(p),
          bodies_(p),
          turned_(Half::Zero(links(p))),
          sin_(turned_),
          cos_(sin_),
          rates_(sin_),
          alpha_(sin_),
          holding_(sin_),
          slides_(p.chain.links(), 0) {}

    static State start(const PhysicalPendulum<Scalar>& p, bool with_work = true) {
        const PhysicalLayout layout(p, links(p), with_work, has_all);
        State y(2 * layout.half);
        layout.start(y);
        const auto released = released_in_angles<Scalar, N>(p.chain);
        y.head(layout.coordinates) = released.head(layout.coordinates);
        y.segment(layout.half, layout.coordinates) = released.tail(layout.coordinates);
        return y;
    }

    /// dydt ← d/dt of the state. The modes of the joints (held, or sliding in one direction) are those set by
    /// take_modes() and settle(), or if none were set, those at y.
    /// `take` is TakeSinCos, or one of StageAngles.
    template <class Take = TakeSinCos>
    void rate(const State& y, State& dydt, const Take& take = {}) {
        if constexpr (chooses_modes)
            if (switches() && !has_modes_) choose_modes(y);
        take_angles(y, take);
        rate_at_angles(y, dydt);
    }

    // Events (integrate/events.hpp): a sliding joint stops, or a held one starts to slide.
    bool switches() const { return !pendulum.friction.coulomb.empty(); }
    void take_modes(State& y) {
        has_modes_ = false;
        settle(y);
        has_modes_ = true;
    }
    void settle(State& y) {
        choose_modes(y);
        y.segment(layout.half, layout.coordinates) = rates_;
    }
    Scalar margin(const State& y) {
        const auto omega = y.segment(layout.half, layout.coordinates);
        Scalar minimum(1);
        for (Eigen::Index i = 0; i < omega.size(); ++i)
            if (slides_[at(i)] != 0) minimum = std::min(minimum, Scalar(Scalar(slides_[at(i)]) * rate_at(omega, i)));
        const auto joints = held();
        if (!joints.empty()) accelerate(y, omega);
        for (const auto i : joints) minimum = std::min(minimum, Scalar(Scalar(1) - load(i)));
        return minimum;
    }
    /// Half a period of the fastest drive, because joints at rest do not limit steps.
    Scalar longest_step() const {
        Scalar fastest = pendulum.pivot.moves() ? pendulum.pivot.frequency : Scalar(0);
        for (const auto& motor : pendulum.torques) fastest = std::max(fastest, motor.frequency);
        return fastest > Scalar(0) ? Scalar(pi_of<Scalar>() / fastest) : Scalar(std::numeric_limits<double>::max());
    }
    /// Takes those of another model, for a model on a tape.
    void keep_modes(const std::vector<int>& modes) {
        slides_ = modes;
        has_modes_ = true;
    }
    const std::vector<int>& modes() const { return slides_; }

    /// For the Hamiltonian form (Canonical), at the angles of y = (q, …).
    template <class Take = TakeSinCos>
    void take_angles(const State& y, const Take& take = {}) {
        take(turned(y), sin_, cos_);
        bodies_.factor(sin_, cos_);
    }
    void solve_mass(const Half& f, Half& a) { bodies_.solve_mass(f, a); }
    /// Without Coulomb friction.
    const PhysicalForces<Scalar, N>& forces_at(const Half& omega, const Scalar& t,
                                               const Planar<Scalar>& pivot_velocity) {
        rates_ = omega;
        take_forces(t, pivot_velocity);
        return forces_;
    }
    /// The force of the pivot on the chain, N, at these rates and forces.
    Planar<Scalar> pivot_force(const Planar<Scalar>& acceleration) {
        return bodies_.accelerate(forces_.torque, forces_.drag, rates_, pendulum.chain.gravity, acceleration, alpha_) -
               forces_.at_pivot;
    }
    const auto& bodies() const { return bodies_.links(); }

private:
    static Eigen::Index links(const PhysicalPendulum<Scalar>& p) { return static_cast<Eigen::Index>(p.chain.links()); }
    const Half& turned(const State& y) {
        turned_[0] = y[0];
        for (Eigen::Index i = 1; i < turned_.size(); ++i) turned_[i] = y[i] - y[i - 1];
        return turned_;
    }
    static std::size_t at(Eigen::Index i) { return static_cast<std::size_t>(i); }
    template <class Rates>
    static Scalar rate_at(const Rates& omega, Eigen::Index joint) {
        return joint == 0 ? Scalar(omega[0]) : Scalar(omega[joint] - omega[joint - 1]);
    }
    bool has_coulomb(Eigen::Index i) const {
        return !pendulum.friction.coulomb.empty() && pendulum.friction.coulomb[at(i)] != Scalar(0);
    }

    bool is_held(Eigen::Index i) const { return has_coulomb(i) && slides_[at(i)] == 0; }
    std::vector<Eigen::Index> held() const {
        std::vector<Eigen::Index> joints;
        for (Eigen::Index i = 0; i < alpha_.size(); ++i)
            if (is_held(i)) joints.push_back(i);
        return joints;
    }
    /// The friction torque of a held joint relative to its limit; within rounding it is not exceeded.
    Scalar load(Eigen::Index i) const {
        using std::abs;
        const Scalar maximum =
            pendulum.friction.coulomb[at(i)] * (Scalar(1) + Scalar(64) * std::numeric_limits<Scalar>::epsilon());
        return abs(holding_[i]) / maximum;
    }
    /// The held joint that exceeds its limit the most.
    std::optional<Eigen::Index> overloaded() const {
        std::optional<Eigen::Index> worst;
        Scalar maximum(1);
        for (const auto i : held())
            if (load(i) > maximum) maximum = load(i), worst = i;
        return worst;
    }

    /// Holds joints at rest if friction can hold them; the others start to slide.
    [[gnu::noinline]] void choose_modes(const State& y) {
        const auto n = layout.coordinates;
        const auto omega = y.segment(layout.half, n);
        for (Eigen::Index i = 0; i < n; ++i) {
            if (!has_coulomb(i)) continue;
            const Scalar rate = rate_at(omega, i);
            const int sign = rate > Scalar(0) ? 1 : rate < Scalar(0) ? -1 : 0;
            int& slides = slides_[at(i)];
            slides = has_modes_ && slides != sign ? 0 : sign;
        }
        Half resting(n);
        rest(omega, resting);
        accelerate(y, resting);
        std::vector<Eigen::Index> let_go;
        while (const auto joint = overloaded()) {
            slides_[at(*joint)] = holding_[*joint] > Scalar(0) ? -1 : 1;
            let_go.push_back(*joint);
            accelerate(y, resting);
        }
        // a released joint may be held again now that others slide
        for (const auto joint : let_go) {
            const int sign = std::exchange(slides_[at(joint)], 0);
            accelerate(y, resting);
            if (overloaded()) slides_[at(joint)] = sign;
        }
        rates_ = resting;
    }

    /// rates ← omega, except that held joints rotate with the link above.
    template <class Rates>
    void rest(const Rates& omega, Half& rates) const {
        for (Eigen::Index i = 0; i < rates.size(); ++i)
            rates[i] = !is_held(i) ? Scalar(omega[i]) : i == 0 ? Scalar(0) : Scalar(rates[i - 1]);
    }

    /// Computes rates_ (omega with held joints at rest), alpha_ and holding_, the torques of held joints. Returns the
    /// power of the pivot, W.
    template <class Rates>
    Scalar accelerate(const State& y, const Rates& omega) {
        take_angles(y);
        return accelerate_at_angles(y, omega);
    }
    void rate_at_angles(const State& y, State& dydt) {
        const auto n = layout.coordinates;
        const auto omega = y.segment(layout.half, n);
        const Scalar by_pivot = accelerate_at_angles(y, omega);
        for (Eigen::Index i = 0; i < n; ++i) {
            dydt[i] = omega[i];
            dydt[layout.half + i] = alpha_[i];
        }
        layout.rate(y, Scalar(forces_.power + by_pivot), dydt);
    }
    template <class Rates>
    Scalar accelerate_at_angles(const State& y, const Rates& omega) {
        const Scalar t = layout.time_of(y);
        const PivotPlace<Scalar> pivot(pendulum.pivot, t);
        rest(omega, rates_);
        take_forces(t, pivot.velocity);
        auto force = pivot_force(pivot.acceleration);
        if (const auto joints = held(); !joints.empty()) {
            add_holding_torques(joints);
            force = pivot_force(pivot.acceleration);
            const Half all = alpha_;
            rest(all, alpha_);
        }
        return dot(force, pivot.velocity);
    }

    void take_forces(const Scalar& t, const Planar<Scalar>& pivot_velocity) {
        forces_.update(rates_, t, slides_);
        if (forces_.drag.empty()) return;
        Planar<Scalar> v = pivot_velocity;
        for (Eigen::Index i = 0; i < sin_.size(); ++i) {
            using std::abs;
            const auto& link = bodies_.links()[at(i)];
            const Scalar own = link.length * rates_[i];
            forces_.update_air(i, link, v, rates_[i]);
            v = v + link.across * own;
            // on a circle the speed can vanish repeatedly, where its root has no series, but |ω| has
            const bool on_circle = i == 0 && !pendulum.pivot.moves();
            forces_.update_drag(i, v, on_circle ? Scalar(abs(own)) : forces_.speed_of(v));
        }
    }

    /// The torques λ that keep the held joints at rest: (D M⁻¹ Dᵀ) λ = −D θ″, where D converts the rates of links to
    /// those of joints.
    [[gnu::noinline]] void add_holding_torques(const std::vector<Eigen::Index>& joints) {
        const auto m = static_cast<Eigen::Index>(joints.size());
        Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> matrix(m, m);
        doppel::State<Scalar, Eigen::Dynamic> right(m);
        Half one(alpha_.size()), answer(alpha_.size());
        for (Eigen::Index k = 0; k < m; ++k) {
            one.setZero();
            add_torque(joints[at(k)], Scalar(1), one);
            bodies_.solve_mass(one, answer);
            for (Eigen::Index j = 0; j < m; ++j) matrix(j, k) = rate_at(answer, joints[at(j)]);
            right[k] = -rate_at(alpha_, joints[at(k)]);
        }
        solve_positive_definite(matrix, right);
        for (Eigen::Index k = 0; k < m; ++k) {
            holding_[joints[at(k)]] = right[k];
            add_torque(joints[at(k)], right[k], forces_.torque);
        }
    }
    static void add_torque(Eigen::Index joint, const Scalar& torque, Half& on_links) {
        on_links[joint] += torque;
        if (joint > 0) on_links[joint - 1] -= torque;
    }

    PhysicalForces<Scalar, N> forces_;
    ArticulatedBodies<Scalar, N> bodies_;
    Half turned_, sin_, cos_;  // of θ_1 and the differences of neighbouring angles
    Half rates_, alpha_;
    Half holding_;  // of held joints, N m
    std::vector<int>
        slides_;  // the sign of the rate of each joint in Coulomb's law until the next event; 0 if it is held
    bool has_modes_ = false;  // slides_ has been set for a motion
};

}  // namespace doppel
