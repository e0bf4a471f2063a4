#pragma once

#include "base/error.hpp"
#include "physics/bob.hpp"
#include "physics/constraint_set.hpp"
#include "physics/mechanism_assembly.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace doppel {

/// A constraint that follows from others before it, here or everywhere: J M⁻¹ Jᵀ is singular.
struct Dependence {
    std::size_t constraint;
    std::vector<std::size_t> others;
};

/// Exit 3: what the dependence means for a motion that has come to these places, (x1, y1, x2, y2 …) in m, and is off
/// the constraints by a fraction `off` of the longest rod.
Error singular_configuration(const std::string& name, const Dependence& dependence, const std::vector<double>& places,
                             double off);

template <class Scalar>
class MechanismSeries;

/// Particles, constraints and forces in a vertical plane: any mechanism of them, loops too.
///
///     M q″ = F(q, q′) + Jᵀ λ ,   J = ∂C/∂q ,   (J M⁻¹ Jᵀ) λ = −J̇ q′ − J M⁻¹ F
///
/// so that C″ = 0. Nothing corrects what a method has let drift (stabilise = "none").
///
/// State   (x1, y1 … xN, yN, vx1, vy1 … vxN, vyN), m and m/s.
/// Energy  zero at rest with all particles at y = 0, springs at their rest length, and attracting bodies infinitely far
///         apart.
/// Errors  Error (exit 3) where a constraint comes to depend on others, so that the forces are not determined.
/// Source  Witkin 1997, Physically Based Modeling: Constrained Dynamics.
template <class S>
struct Mechanism {
    using Scalar = S;
    using State = doppel::State<Scalar, Eigen::Dynamic>;
    using Half = State;         // positions, velocities or accelerations
    using Multipliers = State;  // one a row of J

    Assembly<Scalar> parts;

    /// Of an assembly that check() has nothing against.
    explicit Mechanism(const Assembly<Scalar>& assembly)
        : parts(assembly),
          masses_(masses_of(assembly)),
          set_(assembly.constraints, start(assembly).head(2 * masses_.m.size())),
          matrix_(set_.blank_matrix()),
          lambda_(Multipliers::Zero(set_.rows())),
          gradients_(set_.blank_gradients()),
          gradients_before_(gradients_),
          other_gradients_(gradients_),
          feels_velocity_(!assembly.conserves_energy()) {}

    static State start(const Assembly<Scalar>& assembly) {
        const auto n = static_cast<Eigen::Index>(assembly.particles.size());
        State y(4 * n);
        for (Eigen::Index i = 0; i < n; ++i) {
            const auto& particle = assembly.particles[static_cast<std::size_t>(i)];
            y.template segment<2>(2 * i) = particle.place;
            y.template segment<2>(2 * n + 2 * i) = particle.velocity;
        }
        return y;
    }

    /// dydt ← d/dt of the state.
    void rate(const State& y, State& dydt) {
        const auto n = masses_.m.size();
        const auto q = y.head(2 * n), v = y.tail(2 * n);
        dydt.head(2 * n) = v;
        auto a = dydt.tail(2 * n);
        accelerate(q, v, a);

        turn_to(q);
        if constexpr (requires { y[0].tape(); })  // its series checks the path
            set_.couple(gradients_, gradients_, masses_.w, matrix_);
        else
            factor_and_check_path(q, gradients_);
        find_multipliers(gradients_, v, a);
        set_.add_pull(gradients_, masses_.w, lambda_, a);
    }

    // What methods that keep to the constraints themselves need (physics/constrained.hpp). Positions q, velocities v.

    Eigen::Index constraints() const { return set_.rows(); }

    /// Whether a force depends on velocities.
    bool feels_velocity() const { return feels_velocity_; }

    /// a ← M⁻¹ F, the accelerations without constraints
    void free_acceleration(const Half& q, const Half& v, Half& a) const { accelerate(q, v, a); }

    /// c ← C(q)
    void residual(const Half& q, Multipliers& c) const { set_.value(q, c); }

    /// c ← ε |q| Σ_j |J_ij|
    void rounding(const Half& q, Multipliers& c) {
        set_.update(q, other_gradients_);
        set_.rounding(other_gradients_, q, c);
    }

    /// s ← J(q) v
    void constraint_velocity(const Half& q, const Half& v, Multipliers& s) {
        set_.update(q, other_gradients_);
        s.setZero();
        set_.add_constraint_velocity(other_gradients_, v, s);
    }

    /// s ← J̇ v, the part of C″ that is there without any acceleration
    void jdot_v(const Half&, const Half& v, Multipliers& s) const { set_.jdot_v(v, s); }

    /// v ← v + M⁻¹ Jᵀ(q) λ
    void pull(const Half& q, const Multipliers& lambda, Half& v) {
        set_.update(q, other_gradients_);
        set_.add_pull(other_gradients_, masses_.w, lambda, v);
    }

    /// x ← (J(q1) M⁻¹ Jᵀ(q0))⁻¹ x
    void solve(const Half& q1, const Half& q0, Multipliers& x) {
        turn_to(q1);
        set_.update(q0, other_gradients_);
        factor_and_check_path(q1, other_gradients_);
        matrix_.solve(x);
    }

    // What is reported of a state.

    Scalar energy(const State& y) const {
        const auto n = masses_.m.size();
        Scalar total(0);
        for (Eigen::Index i = 0; i < n; ++i) {
            const Scalar &vx = y[2 * n + 2 * i], &vy = y[2 * n + 2 * i + 1];
            total += Scalar(0.5) * masses_.m[i] * (vx * vx + vy * vy);
        }
        const auto q = y.head(2 * n);
        for (const auto& force : parts.forces)
            total += std::visit([&](const auto& part) { return Scalar(part.energy(masses_, q)); }, force);
        return total;
    }

    /// The constraint that is furthest from being met, m.
    Scalar length_error(const State& y) const { return set_.worst_error(y.head(y.size() / 2)); }

    /// The forces in the rods, N, > 0 where one pulls, in the order of the constraints that are rods: the λ of C″ = 0,
    /// without what a stabilisation adds. NaN where a constraint depends on others, so that none is
    /// determined.
    std::vector<Scalar> tensions(const State& y) {
        const auto q = y.head(y.size() / 2), v = y.tail(y.size() / 2);
        Half a(q.size());
        accelerate(q, v, a);
        set_.update(q, other_gradients_);
        set_.couple(other_gradients_, other_gradients_, masses_.w, matrix_);
        matrix_.factor();
        if (matrix_.dependent_row() < matrix_.rows())
            lambda_.setConstant(std::numeric_limits<Scalar>::quiet_NaN());
        else
            find_multipliers(other_gradients_, v, a);
        return set_.tensions(other_gradients_, lambda_);
    }

    Bobs<Scalar> bobs(const State& y) const {
        const auto n = masses_.m.size();
        Bobs<Scalar> all;
        for (Eigen::Index i = 0; i < n; ++i) {
            const Eigen::Index q = 2 * i, v = 2 * n + 2 * i;
            all.push_back({masses_.m[i], y[q], y[q + 1], y[v], y[v + 1]});
        }
        return all;
    }

    /// The first constraint that follows from those before it at positions q, if there is one.
    std::optional<Dependence> dependence(const Half& q) {
        set_.update(q, other_gradients_);
        set_.couple(other_gradients_, other_gradients_, masses_.w, matrix_);
        matrix_.factor();
        const auto row = matrix_.dependent_row();
        if (row == matrix_.rows()) return std::nullopt;
        return dependence_of(row);
    }

private:
    friend MechanismSeries<Scalar>;  // made of the same parts, with the same errors (integrate/mechanism_series.hpp)

    using Gradients = typename ConstraintSet<Scalar>::Gradients;

    static Masses<Scalar> masses_of(const Assembly<Scalar>& assembly) {
        const auto n = static_cast<Eigen::Index>(assembly.particles.size());
        Masses<Scalar> masses{Half(n), Half(n)};
        for (Eigen::Index i = 0; i < n; ++i) {
            masses.m[i] = assembly.particles[static_cast<std::size_t>(i)].mass;
            masses.w[i] = Scalar(1) / masses.m[i];
        }
        return masses;
    }

    template <class Vector, class Sum>
    void accelerate(const Vector& q, const Vector& v, Sum& a) const {
        a.setZero();
        for (const auto& force : parts.forces)
            std::visit([&](const auto& part) { part.accelerate(masses_, q, v, a); }, force);
    }

    /// λ from C″ = 0, of the factored matrix and the accelerations a without constraints
    template <class Vector, class Sum>
    void find_multipliers(const Gradients& gradients, const Vector& v, const Sum& a) {
        set_.jdot_v(v, lambda_);
        set_.add_constraint_velocity(gradients, a, lambda_);
        lambda_ = -lambda_;
        solve_factored(matrix_, lambda_);
    }

    /// J(q), and that of the call before.
    template <class Vector>
    void turn_to(const Vector& q) {
        gradients_.swap(gradients_before_);
        set_.update(q, gradients_);
    }

    /// Factors J(q) M⁻¹ J0ᵀ, and near a singular configuration finds out whether one lies between this call and the one
    /// before: stepped over, it would look like any other step, and end in another motion.
    template <class Vector>
    void factor_and_check_path(const Vector& q, const Gradients& zero) {
        factor(q, gradients_, zero);
        const bool was_near = std::exchange(is_near_, matrix_.nearly_singular());
        if (!(was_near || is_near_) || !alike(gradients_, gradients_before_)) return;
        factor(q, gradients_, gradients_before_);
        factor(q, gradients_, zero);
    }

    /// Factors J1 M⁻¹ J0ᵀ, unless a constraint depends on others at q or between the two.
    ///
    /// det(J1 M⁻¹ J0ᵀ) is the scalar product of two volumes, each spanned by gradients. A negative pivot says that one
    /// of them turned over. If gradients have hardly turned otherwise, it did so by passing through zero.
    template <class Vector>
    void factor(const Vector& q, const Gradients& one, const Gradients& zero) {
        set_.couple(one, zero, masses_.w, matrix_);
        matrix_.factor();
        if (const auto row = matrix_.dependent_row(); row < matrix_.rows()) fail(q, row);
        if (const auto row = matrix_.negative_row(); row < matrix_.rows() && alike(one, zero)) fail(q, row);
    }

    /// Whether no gradient differs by more than half its length.
    static bool alike(const Gradients& one, const Gradients& zero) {
        for (std::size_t k = 0; k < one.size(); ++k) {
            const Place<Scalar> change = one[k] - zero[k];
            if (Scalar(4) * squared(change) > squared(zero[k])) return false;
        }
        return true;
    }
    static Scalar squared(const Place<Scalar>& r) { return r[0] * r[0] + r[1] * r[1]; }

    template <class Vector>
    [[noreturn]] void fail(const Vector& q, Eigen::Index row) const {
        std::vector<double> places;
        for (Eigen::Index i = 0; i < q.size(); ++i) places.push_back(static_cast<double>(q[i]));
        const Scalar& rod = set_.longest_rod();
        const double off = rod > Scalar(0) ? static_cast<double>(Scalar(set_.worst_error(q) / rod)) : 0;
        const auto found = dependence_of(row);
        throw singular_configuration(name_of(found.constraint, set_[found.constraint]), found, places, off);
    }

    /// Row j counts where its share in row i is more than rounding could make it.
    Dependence dependence_of(Eigen::Index row) const {
        using std::abs;
        Dependence found{set_.owner(row), {}};
        const auto share = matrix_.dependence(row);
        Scalar largest(0);
        for (Eigen::Index j = 0; j < row; ++j)
            if (abs(share[j]) > largest) largest = abs(share[j]);
        for (Eigen::Index j = 0; j < row; ++j) {
            const auto other = set_.owner(j);
            if (abs(share[j]) > Scalar(1e-6) * largest && other != found.constraint) found.others.push_back(other);
        }
        std::sort(found.others.begin(), found.others.end());
        found.others.erase(std::unique(found.others.begin(), found.others.end()), found.others.end());
        return found;
    }

    Masses<Scalar> masses_;
    ConstraintSet<Scalar> set_;
    EnvelopeMatrix<Scalar> matrix_;
    Multipliers lambda_;
    Gradients gradients_, gradients_before_;  // where a system was solved last, and before that
    Gradients other_gradients_;
    bool is_near_ = false;  // a singular configuration
    bool feels_velocity_;
};

}  // namespace doppel
