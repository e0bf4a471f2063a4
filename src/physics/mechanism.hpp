#pragma once

#include "base/error.hpp"
#include "physics/bob.hpp"
#include "physics/constraint_set.hpp"
#include "physics/mechanism_assembly.hpp"

#include <limits>
#include <optional>
#include <utility>

namespace doppel {

/// A constraint that depends on earlier ones, in this configuration or in all: J M⁻¹ Jᵀ is singular.
struct Dependence {
    std::size_t constraint;
    std::vector<std::size_t> others;
};

/// Exit 3: the meaning of the dependence for a motion at these positions, (x1, y1, x2, y2 …) in m, where the constraint
/// error is `relative_error` times the longest rod.
Error singular_configuration(const std::string& name, const Dependence& dependence, const std::vector<double>& places,
                             double relative_error);

template <class Scalar>
class MechanismSeries;

/// Particles, constraints and forces in a vertical plane: any mechanism of these, including loops.
///
///     M q″ = F(q, q′) + Jᵀ λ ,   J = ∂C/∂q ,   (J M⁻¹ Jᵀ) λ = −J̇ q′ − J M⁻¹ F
///
/// so that C″ = 0. The drift of a method is not corrected (stabilise = "none").
///
/// State   (x1, y1 … xN, yN, vx1, vy1 … vxN, vyN), m and m/s.
/// Energy  zero at rest with all particles at y = 0, springs at their rest length, and attracting bodies at infinite
///         distance.
/// Errors  exit 3 if a constraint becomes dependent on others, so that the forces are not determined.
/// Source  Witkin 1997, Physically Based Modeling: Constrained Dynamics.
template <class S>
struct Mechanism : ConstraintSet<S> {
    using Scalar = S;
    using State = doppel::State<Scalar, Eigen::Dynamic>;
    using Half = State;         // positions, velocities or accelerations
    using Multipliers = State;  // one for each row of J

    Assembly<Scalar> parts;

    /// `assembly` must pass check().
    explicit Mechanism(const Assembly<Scalar>& assembly) : Mechanism(assembly, masses_of(assembly)) {}

    static State start(const Assembly<Scalar>& assembly) {
        Bobs<Scalar> bobs;
        for (const auto& [mass, place, velocity] : assembly.particles)
            bobs.push_back({mass, place[0], place[1], velocity[0], velocity[1]});
        return particles_of(bobs);
    }

    /// dydt ← d/dt of the state.
    void rate(const State& y, State& dydt) {
        const auto n = masses_.m.size();
        const auto q = y.head(2 * n), v = y.tail(2 * n);
        dydt.head(2 * n) = v;
        auto a = dydt.tail(2 * n);
        free_acceleration(q, v, a);

        turn_to(q);
        if constexpr (requires { y[0].tape(); })  // the series checks the path
            this->couple(gradients_, gradients_, matrix_);
        else
            factor_and_check_path(q, gradients_);
        find_multipliers(gradients_, v, a);
        this->add_multipliers(gradients_, lambda_, a);
        if (!has_light_mass_) return;
        // its acceleration is a small difference of large forces: what rounding left of C″ is taken away
        find_multipliers(gradients_, v, a);
        this->add_multipliers(gradients_, lambda_, a);
    }

    bool depends_on_velocity() const { return !parts.conserves_energy(); }

    template <class Vector, class Sum>
    void free_acceleration(const Vector& q, const Vector& v, Sum& a) const {
        a.setZero();
        for (const auto& force : parts.forces)
            std::visit([&](const auto& part) { part.accelerate(masses_, q, v, a); }, force);
    }

    void solve(const Half& q1, const Half& q0, Multipliers& x) {
        turn_to(q1);
        this->update(q0, scratch_);
        factor_and_check_path(q1, scratch_);
        matrix_.solve(x);
    }

    // Functions of a state for output.

    Scalar energy(const State& y) const {
        Scalar total = kinetic_energy(bobs(y));
        const auto q = y.head(y.size() / 2);
        for (const auto& force : parts.forces)
            total += std::visit([&](const auto& part) { return Scalar(part.energy(masses_, q)); }, force);
        return total;
    }

    /// The largest constraint error, m.
    template <class Vector>
    Scalar length_error(const Vector& y) const {
        Scalar worst(0);
        for (const auto& constraint : parts.constraints) {
            const Scalar error = error_of(constraint, y);
            if (!(error <= worst)) worst = error;  // NaN counts as the largest
        }
        return worst;
    }

    /// The rod tensions, N, > 0 if a rod pulls, in the order of the constraints that are rods: λ from C″ = 0 without
    /// stabilisation. NaN if a constraint depends on others, so that no tension is determined.
    std::vector<Scalar> tensions(const State& y) {
        const Half q = y.head(y.size() / 2), v = y.tail(y.size() / 2);
        Half a(q.size());
        free_acceleration(q, v, a);
        if (dependence(q))
            lambda_.setConstant(std::numeric_limits<Scalar>::quiet_NaN());
        else
            find_multipliers(scratch_, v, a);
        std::vector<Scalar> all;
        for (Eigen::Index row = 0; row < lambda_.size(); ++row)
            if (const auto* rod = std::get_if<Rod<Scalar>>(&parts.constraints[this->owner(row)]))
                all.push_back(-lambda_[row] * length_of(Place<Scalar>(part_of(q, rod->a) - place_of(rod->b, q))));
        return all;
    }

    Bobs<Scalar> bobs(const State& y) const {
        Bobs<Scalar> all;
        place_particles(masses_.m, y, all);
        return all;
    }

    /// The first constraint that depends on earlier ones at positions q, if there is one.
    std::optional<Dependence> dependence(const Half& q) {
        this->update(q, scratch_);
        this->couple(scratch_, scratch_, matrix_);
        matrix_.factor();
        const auto row = matrix_.dependent_row();
        if (row == matrix_.rows()) return std::nullopt;
        return dependence_of(row);
    }

private:
    friend MechanismSeries<Scalar>;  // with the same errors (integrate/taped_series.hpp)

    using Set = ConstraintSet<Scalar>;
    using Gradients = typename Set::Gradients;
    using Set::scratch_;

    Mechanism(const Assembly<Scalar>& assembly, const Masses<Scalar>& masses)
        : Set(assembly.constraints, masses.w),
          parts(assembly),
          masses_(masses),
          has_light_mass_(Scalar(1000) * masses.m.minCoeff() < masses.m.maxCoeff()),
          matrix_(this->blank_matrix()),
          lambda_(Multipliers::Zero(this->constraints())),
          gradients_(this->blank_gradients()),
          gradients_before_(gradients_) {}

    static Masses<Scalar> masses_of(const Assembly<Scalar>& assembly) {
        const auto n = static_cast<Eigen::Index>(assembly.particles.size());
        Masses<Scalar> masses{Half(n), Half(n)};
        for (Eigen::Index i = 0; i < n; ++i) {
            masses.m[i] = assembly.particles[static_cast<std::size_t>(i)].mass;
            masses.w[i] = Scalar(1) / masses.m[i];
        }
        return masses;
    }

    /// λ from C″ = 0, for the factored matrix and the accelerations a without constraints
    template <class Vector, class Sum>
    void find_multipliers(const Gradients& gradients, const Vector& v, const Sum& a) {
        this->jdot_v(v, v, lambda_);
        this->add_constraint_velocity(gradients, a, lambda_);
        lambda_ = -lambda_;
        solve_factored(matrix_, lambda_);
    }

    /// Computes J(q), and keeps the previous one.
    template <class Vector>
    void turn_to(const Vector& q) {
        gradients_.swap(gradients_before_);
        this->update(q, gradients_);
    }

    /// Factors J(q) M⁻¹ J0ᵀ. Near a singular configuration, also checks whether one lies between the previous call and
    /// this one. Integrated over, it would look like any other step, but lead to another motion.
    template <class Vector>
    void factor_and_check_path(const Vector& q, const Gradients& zero) {
        factor(q, zero);
        const bool was_near = std::exchange(is_near_, matrix_.nearly_singular());
        if (!(was_near || is_near_) || !nearly_parallel(gradients_, gradients_before_)) return;
        factor(q, gradients_before_);
        factor(q, zero);
    }

    /// Factors J(q) M⁻¹ J0ᵀ, unless a constraint depends on others at q or between the two positions.
    ///
    /// det(J1 M⁻¹ J0ᵀ) is the scalar product of two volumes, each spanned by gradients. A negative pivot shows that one
    /// of them changed its sign. If the gradients have otherwise hardly rotated, it passed through zero.
    template <class Vector>
    void factor(const Vector& q, const Gradients& zero) {
        this->couple(gradients_, zero, matrix_);
        matrix_.factor();
        if (const auto row = matrix_.dependent_row(); row < matrix_.rows()) fail(q, row);
        if (const auto row = matrix_.negative_row(); row < matrix_.rows() && nearly_parallel(gradients_, zero))
            fail(q, row);
    }

    /// Whether no gradient differs by more than half its length.
    static bool nearly_parallel(const Gradients& one, const Gradients& zero) {
        for (std::size_t k = 0; k < one.size(); ++k) {
            const Place<Scalar> change = one[k] - zero[k];
            if (Scalar(4) * inner(change, change) > inner(zero[k], zero[k])) return false;
        }
        return true;
    }

    template <class Vector>
    [[noreturn]] void fail(const Vector& q, Eigen::Index row) const {
        std::vector<double> places;
        for (Eigen::Index i = 0; i < q.size(); ++i) places.push_back(static_cast<double>(q[i]));
        const Scalar& rod = this->longest_rod();
        const double relative_error = rod > Scalar(0) ? static_cast<double>(Scalar(length_error(q) / rod)) : 0;
        const auto found = dependence_of(row);
        throw singular_configuration(name_of(found.constraint, parts.constraints[found.constraint]), found, places,
                                     relative_error);
    }

    /// Row j counts if its share in row i exceeds rounding.
    Dependence dependence_of(Eigen::Index row) const {
        using std::abs;
        Dependence found{this->owner(row), {}};
        const auto share = matrix_.dependence(row);
        Scalar largest(0);
        for (const auto& part : share)
            if (abs(part) > largest) largest = abs(part);
        for (Eigen::Index j = 0; j < row; ++j) {
            const auto other = this->owner(j);
            const bool is_listed = !found.others.empty() && found.others.back() == other;
            if (abs(share[j]) > Scalar(1e-6) * largest && other != found.constraint && !is_listed)
                found.others.push_back(other);
        }
        return found;
    }

    Masses<Scalar> masses_;
    bool has_light_mass_;  // below a thousandth of another
    EnvelopeMatrix<Scalar> matrix_;
    Multipliers lambda_;
    Gradients gradients_, gradients_before_;  // at the last and the previous solution
    bool is_near_ = false;                    // near a singular configuration
};

}  // namespace doppel
