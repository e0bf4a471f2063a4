#pragma once

#include "base/error.hpp"
#include "integrate/stepper.hpp"

#include <limits>

namespace doppel {

/// Moves positions onto their constraints along M⁻¹Jᵀ by Newton's method for the multipliers:
///     C(q + M⁻¹Jᵀ(q0) λ) = 0 ,     λ ← λ − (J(q) M⁻¹ Jᵀ(q0))⁻¹ C(q) .
/// It ends at the limit of rounding: all constraints hold as well as rounded positions allow, a correction no longer
/// changes a position, or corrections no longer help and the rest is rounding. At least one correction is made, so that
/// no error below a tolerance remains. For scalars that can be compared.
template <Constrained Model>
class Newton {
public:
    using Scalar = typename Model::Scalar;
    using Half = typename Model::Half;
    using Multipliers = typename Model::Multipliers;

    static constexpr int limit = 50;  // corrections; four are typical
    static constexpr int many = 8;    // corrections after which the rest may be rounding

    Multipliers lambda;  // of the last call
    long solves = 0;     // number of linear systems solved

    Newton(Model& model, const Half& q)
        : lambda(Multipliers::Zero(model.constraints())), c_(lambda), floor_(lambda), rounding_(lambda), move_(q) {
        model.rounding(q, floor_);
        floor_ *= Scalar(0.5);  // positions are rounded by half of ε
    }

    /// Sets q to a point on the constraints; returns true if one is found. q0 may be q itself: then the directions
    /// follow it.
    bool project_positions(Model& model, const Half& q0, Half& q) {
        lambda.setZero();
        for (int i = 0; i < limit; ++i) {
            model.residual(q, c_);
            if (i > 0 && within(floor_)) return true;
            if (i >= many) {  // is it within four times its rounding, where corrections oscillate?
                model.rounding(q, rounding_);
                rounding_ *= Scalar(4);
                if (within(rounding_)) return true;
            }
            correct(model, q0, q);
            if (i > 0 && move_.cwiseAbs().maxCoeff() <= Scalar(2) * epsilon * q.cwiseAbs().maxCoeff()) return true;
        }
        model.residual(q, c_);
        return false;
    }

    /// v ← v + M⁻¹Jᵀ(q) λ such that J v = 0.
    void project_velocities(Model& model, const Half& q, Half& v) {
        model.constraint_velocity(q, v, c_);
        model.solve(q, q, c_);
        lambda = -c_;
        model.apply_multipliers(q, lambda, v);
        ++solves;
    }

    /// The largest |C| left if no point was found.
    double remained() const { return static_cast<double>(Scalar(c_.cwiseAbs().maxCoeff())); }

private:
    inline static const Scalar epsilon = std::numeric_limits<Scalar>::epsilon();

    bool within(const Multipliers& bounds) const {
        for (Eigen::Index i = 0; i < c_.size(); ++i)
            if (!(c_[i] <= bounds[i] && -c_[i] <= bounds[i])) return false;
        return true;
    }

    void correct(Model& model, const Half& q0, Half& q) {
        model.solve(q, q0, c_);
        c_ = -c_;
        move_.setZero();
        model.apply_multipliers(q0, c_, move_);
        lambda += c_;
        add(q, Scalar(1), move_);
        ++solves;
    }

    Multipliers c_;      // C, then the change of λ
    Multipliers floor_;  // rounding error of C at the start
    Multipliers rounding_;
    Half move_;
};

/// A model that projects positions onto the constraints after every step of any method, then velocities onto their
/// tangents. Both are done to rounding and along M⁻¹Jᵀ, the shortest way in the metric of the masses.
/// Errors  exit 3 if no point on the constraints is found.
/// Source  Hairer & Wanner, Solving Ordinary Differential Equations II, §VII.2.
template <Constrained Model>
class Projected : public Model {
public:
    static constexpr bool is_stabilised = true;

    using Scalar = typename Model::Scalar;
    using State = typename Model::State;
    using Half = typename Model::Half;

    template <class Description>
    explicit Projected(const Description& description)
        : Model(description), q_(half_of(Model::start(description))), v_(q_), newton_(*this, q_) {}

    void project(State& y) {
        const auto n = q_.size();
        q_ = y.head(n);
        v_ = y.tail(n);
        if (!newton_.project_positions(*this, q_, q_))
            throw method_failed(
                "projection: the constraints still have an error of {:.2g} after {} corrections; choose a smaller "
                "step_s",
                newton_.remained(), newton_.limit);
        newton_.project_velocities(*this, q_, v_);
        y.head(n) = q_;
        y.tail(n) = v_;
    }

private:
    static Half half_of(const State& start) { return start.head(start.size() / 2); }

    Half q_, v_;
    Newton<Model> newton_;
};

/// A model with constraint stabilisation: the constraint error behaves as a critically damped oscillator with rate α,
/// 1/s:
///     C″ = −2α C′ − α² C ,     (J M⁻¹ Jᵀ) λ = −J̇ v − J M⁻¹ F − 2α J v − α² C .
/// Stability of explicit methods for this limits the step: α dt < 2 (Euler), < 2.785 (Runge–Kutta 4).
/// Source  Baumgarte 1972, Stabilization of constraints and integrals of motion in dynamical systems.
template <Constrained Model>
class Baumgarte : public Model {
public:
    static constexpr bool is_stabilised = true;

    using Scalar = typename Model::Scalar;
    using State = typename Model::State;
    using Half = typename Model::Half;

    /// `description`: as for the model; α in 1/s, ≥ 0.
    template <class Description>
    Baumgarte(const Description& description, const Scalar& alpha)
        : Model(description),
          alpha_(alpha),
          q_(Half::Zero(Model::start(description).size() / 2)),
          v_(q_),
          a_(q_),
          lambda_(Model::Multipliers::Zero(Model::constraints())),
          c_(lambda_) {}

    void rate(const State& y, State& dydt) {
        const auto n = q_.size();
        q_ = y.head(n);
        v_ = y.tail(n);
        this->free_acceleration(q_, v_, a_);
        this->jdot_v(q_, v_, lambda_);
        this->constraint_velocity(q_, a_, c_);
        lambda_ += c_;
        this->constraint_velocity(q_, v_, c_);
        lambda_ += (Scalar(2) * alpha_) * c_;
        this->residual(q_, c_);
        lambda_ = -(lambda_ + (alpha_ * alpha_) * c_);
        this->solve(q_, q_, lambda_);
        this->apply_multipliers(q_, lambda_, a_);
        dydt.head(n) = v_;
        dydt.tail(n) = a_;
    }

private:
    Scalar alpha_;
    Half q_, v_, a_;
    typename Model::Multipliers lambda_, c_;
};

}  // namespace doppel
