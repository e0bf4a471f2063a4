#pragma once

#include "integrate/methods.hpp"
#include "integrate/stabilise.hpp"
#include "integrate/stepper.hpp"
#include "numeric/quad.hpp"
#include "physics/rod_chain.hpp"

#include <array>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace doppel {

/// RATTLE as a composition: several substeps make one step. Their fractions γ of it are symmetric and sum to 1;
/// `fractions` are those before the middle one, in decimal. A substep of size h from (q, v) to (q1, v1), both on the
/// constraints, is
///     u  = v + h/2 a(q, v) + M⁻¹ Jᵀ(q) λ ,     q1 = q + h u ,     λ such that C(q1) = 0 ,
///     v1 = u + h/2 a(q1, v1) + M⁻¹ Jᵀ(q1) μ ,                     μ such that J(q1) v1 = 0 ,
/// where a = M⁻¹ F is the acceleration without constraints. u is corrected by the multipliers, never by (q1 − q) / h,
/// which would cost three digits.
/// If forces do not depend on velocity, μ is merged into the λ of the next step, which acts in the same direction. It
/// is only computed for state(): the same motion at half the cost. If they do, v1 is found by iteration, so that a step
/// remains of second order and time-reversible, although no longer symplectic.
/// Errors  exit 3 if λ or v1 is not found.
/// Source  Andersen 1983; Hairer, Lubich & Wanner, Geometric Numerical Integration, §VII.1.4 and §V.3.2.
template <Unstabilised Model>
class ComposedRattle {
public:
    using Scalar = typename Model::Scalar;
    using State = typename Model::State;

    ComposedRattle(Model& model, const State& start, const Scalar& step, std::string_view name,
                   std::span<const std::string_view> fractions)
        : name_(name),
          model_(model),
          friction_(model.depends_on_velocity()),
          y_(start),
          step_(step),
          sizes_(2 * fractions.size() + 1, step),
          q_(start.head(start.size() / 2)),
          v_(start.tail(start.size() / 2)),
          q0_(q_),
          u_(v_),
          a_(v_),
          a_before_(v_),
          guess_(Multipliers::Zero(model.constraints())),
          force_(guess_),
          force_before_(guess_),
          newton_(model, q_) {
        const std::size_t middle = fractions.size();
        for (std::size_t i = 0; i < middle; ++i) {
            sizes_[i] = sizes_[2 * middle - i] = number(fractions[i]) * step;
            sizes_[middle] -= Scalar(2) * sizes_[i];
        }
        model_.free_acceleration(q_, v_, a_);
        start_forces();
    }

    void advance(long steps) {
        for (long i = 0; i < steps; ++i) {
            for (const Scalar& h : sizes_) move(h);
            ++done_;
        }
        u_ = v_;
        if (!friction_) newton_.project_velocities(model_, q_, u_);
        y_.head(q_.size()) = q_;
        y_.tail(q_.size()) = u_;
    }

    const State& state() const { return y_; }
    long evaluations() const { return newton_.solves; }

private:
    using Half = typename Model::Half;
    using Multipliers = typename Model::Multipliers;

    static Scalar number(std::string_view decimal) {
        if constexpr (std::is_constructible_v<Scalar, Quad>)
            return Scalar(parse_quad(decimal));
        else
            return Scalar(static_cast<double>(parse_quad(decimal)));
    }

    /// The forces of the constraints at the start: (J M⁻¹ Jᵀ) λ / s = −J̇ v − J a.
    void start_forces() {
        model_.jdot_v(q_, v_, force_);
        model_.constraint_velocity(q_, a_, guess_);
        force_ = -(force_ + guess_);
        model_.solve(q_, q_, force_);
        force_before_ = force_;
    }

    void move(const Scalar& h) {
        const Scalar half = h * Scalar(0.5), span = merged_ + half;
        extrapolate();

        // u and q1 with the guessed λ, then with the right one
        guess_ *= span;
        q0_ = q_;
        u_ = v_;
        add(u_, half, a_);
        model_.apply_multipliers(q0_, guess_, u_);
        add(q_, h, u_);
        if (!newton_.project_positions(model_, q0_, q_))
            throw method_failed(
                "{}: step {}: the constraints still have an error of {:.2g} after {} corrections; choose a smaller "
                "step_s than {:g}",
                name_, done_ + 1, newton_.remained(), newton_.limit, static_cast<double>(step_));
        newton_.lambda /= h;
        model_.apply_multipliers(q0_, newton_.lambda, u_);
        force_ = (guess_ + newton_.lambda) / span;

        // v1
        model_.free_acceleration(q_, u_, a_);
        if (friction_) {
            end_with_friction(half);
        } else {
            v_ = u_;
            add(v_, half, a_);
            merged_ = half;
        }
    }

    /// Extrapolates the forces λ / s of the constraints linearly from the earlier ones, for equal steps.
    void extrapolate() {
        guess_ = force_;
        if (sizes_.size() == 1) {
            guess_ += force_ - force_before_;
            force_before_ = force_;
        }
    }

    void end_with_friction(const Scalar& half) {
        for (int i = 0; i < newton_.limit; ++i) {
            v_ = u_;
            add(v_, half, a_);
            newton_.project_velocities(model_, q_, v_);
            a_.swap(a_before_);
            model_.free_acceleration(q_, v_, a_);
            if (unchanged(half, i >= newton_.many)) return;
        }
        throw method_failed("{}: step {}: friction is too strong for steps of {:g} s; choose a smaller step_s", name_,
                            done_ + 1, static_cast<double>(step_));
    }

    /// Whether the forces at the new velocity are unchanged to rounding. If large forces cancel, this never happens;
    /// after many corrections, an unchanged velocity is enough.
    bool unchanged(const Scalar& half, bool after_many) const {
        using std::abs;
        const Scalar rounding = Scalar(4) * std::numeric_limits<Scalar>::epsilon();
        const Scalar change = (a_ - a_before_).cwiseAbs().maxCoeff();
        if (change <= rounding * a_.cwiseAbs().maxCoeff()) return true;
        return after_many && abs(half) * change <= rounding * v_.cwiseAbs().maxCoeff();
    }

    std::string_view name_;
    Model& model_;
    bool friction_;
    State y_;
    Scalar step_;
    std::vector<Scalar> sizes_;  // of the substeps, s
    long done_ = 0;
    Half q_, v_, q0_, u_;
    Half a_, a_before_;                         // M⁻¹ F
    Multipliers guess_, force_, force_before_;  // λ, and λ / s
    Scalar merged_ = Scalar(0);                 // s, length of the last step whose μ is merged into the next λ
    Newton<Model> newton_;
};

/// With the fractions of `Which`.
template <Unstabilised Model, class Which>
struct RattleStepper : ComposedRattle<Model> {
    RattleStepper(Model& model, const typename Model::State& start, const typename Model::Scalar& step)
        : ComposedRattle<Model>(model, start, step, Which::method.name, Which::fractions) {}
};

struct Rattle {
    static constexpr Method method{"rattle", "RATTLE", 2, false,
                                   "keeps rods; symplectic and time-reversible without friction"};
    static constexpr std::array<std::string_view, 0> fractions{};
    template <Unstabilised Model>
    using Stepper = RattleStepper<Model, Rattle>;
};

/// Kahan & Li 1997: of the symmetric compositions of nine steps with Σγ = 1, Σγ³ = Σγ⁵ = Σγ³m² = 0 (m: the time of a
/// step's middle), the one whose largest step, the middle one of 0.7985, is smallest; solved to 40 digits.
struct Rattle6 {
    static constexpr Method method{"rattle6", "RATTLE composed to order 6", 6, false,
                                   "keeps rods; symplectic and time-reversible without friction"};
    static constexpr std::array<std::string_view, 4> fractions{
        "0.3921614440073141392756553300383809325954", "0.3325991367893594386042721253257905699416",
        "-0.7062461725576393598098453372227639944854", "0.08221359629355080023044270533411341434285"};
    template <Unstabilised Model>
    using Stepper = RattleStepper<Model, Rattle6>;
};

}  // namespace doppel
