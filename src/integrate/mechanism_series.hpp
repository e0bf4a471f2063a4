#pragma once

#include "integrate/force_series.hpp"
#include "integrate/rod_bundle.hpp"
#include "integrate/stabilise.hpp"
#include "integrate/taylor_series.hpp"
#include "numeric/subnormals.hpp"
#include "physics/mechanism.hpp"
#include "physics/rod_chain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace doppel {

/// The Taylor series of a mechanism, from products of series. With c_k for the coefficient of (t − t_0)^k of each c,
/// and A for the accelerations,
///     A_k = (M⁻¹ F)_k + M⁻¹ Σ_{j=0}^k J_jᵀ λ_{k−j} .
/// J is that of rods, r, and of straight slots and anchors, constant: J_j = 0 for j > 0. |r|² is constant too, and so
///     J_0 A_k = −½ (k + 1)(k + 2) Σ_{j=1}^{k+1} r_j · r_{k+2−j} ,   or 0 ,
/// which gives λ_k, with the same matrix J_0 M⁻¹ J_0ᵀ at every order.
/// Lengths are what they are in the state: nothing pulls the rods back.
/// Errors  those of the mechanism, wherever a singular configuration lies on the way that move() goes.
/// Source  recurrences of this kind: Jorba & Zou 2005, Experimental Mathematics 14:99, §2.
///         The motion: that of Mechanism.
template <class S>
class MechanismSeries {
public:
    using Scalar = S;
    using Model = Mechanism<Scalar>;
    using State = typename Model::State;
    using Half = typename Model::Half;

    MechanismSeries(const Model& model, int order)
        : order_(order),
          model_(model),
          places_(static_cast<std::size_t>(order + 2), Half::Zero(2 * model_.masses_.m.size())),
          rates_(static_cast<std::size_t>(order + 1), places_[0]),
          here_(places_[0]),
          gradients_(model_.set_.blank_gradients()),
          checked_gradients_(gradients_),
          ahead_(gradients_),
          rods_(order) {
        for (int k = 0; k < order + 2; ++k) inverse_.push_back(Scalar(1) / Scalar(std::max(k, 1)));
        for (std::size_t i = 0; i < model_.forces_.size(); ++i)
            std::visit([&](const auto& force) { add(force, name_of(model_.forces_, i)); }, model_.forces_[i]);
        for (Eigen::Index row = 0; row < model_.set_.rows(); ++row) {
            const auto& constraint = model_.set_[model_.set_.owner(row)];
            if (const auto* rod = std::get_if<Rod<Scalar>>(&constraint)) add(*rod, row);
            if (const auto* slot = std::get_if<SlotCircle<Scalar>>(&constraint)) add(slot->rod(), row);
        }
        if (reach_ > 0) longest_ = std::min(longest_, longest_chain_step(reach_, plain_value(gravity_)));
    }

    template <class Y>
    void expand(const Y& y) {
        const NoSubnormals here;
        const auto n = here_.size();
        places_[0] = y.head(n);
        places_[1] = rates_[0] = y.tail(n);
        rods_.start(places_[0]);
        for (auto& force : forces_) force.start(places_[0]);
        take(1);
        model_.set_.update(places_[0], gradients_);
        if (const auto row = factor(gradients_, gradients_); row < model_.set_.rows()) model_.fail(places_[0], row);
        for (int k = 0; k < order_; ++k) next(k);
        find_amount();
        checked_ = Scalar(0);
        checked_gradients_ = gradients_;
    }

    template <class Y>
    void move(const Scalar& h, Y& change) {
        const NoSubnormals here;
        check_path(h);
        const auto n = here_.size();
        auto moved = change.head(n), faster = change.tail(n);
        sum_up(places_, h, moved);
        sum_up(rates_, h, faster);
    }

    /// The forces count as well: at the end of a straight way into its other end a spring turns over, and nothing else
    /// tells.
    double size(int k) const {
        double most = greatest(k);
        for (const auto& force : forces_)
            if (k > 0) most = greater(most, force.strength(k - 1) / k);
        return amount_ == 0 ? 0 : most / amount_;
    }

    /// That of a chain of all rods; half a period of any spring.
    double longest_step() const { return longest_; }

private:
    using Gradients = typename Model::Gradients;
    using Central = CentralForceSeries<Scalar>;

    void add(const Rod<Scalar>& rod, Eigen::Index row) {
        const auto& w = model_.masses_.w;
        rods_.add(rod.a, rod.b, w[static_cast<Eigen::Index>(rod.a)], share_of(rod.b, w), row);
        reach_ += plain_value(rod.length);
    }

    void add(const Gravity<Scalar>& force, const std::string&) { gravity_ += force.g; }
    void add(const Spring<Scalar>& force, const std::string& name) {
        const auto& w = model_.masses_.w;
        const Scalar one = w[static_cast<Eigen::Index>(force.a)], other = share_of(force.b, w);
        const Scalar pull = -(force.stiffness * force.length);
        forces_.emplace_back(name, typename Central::Law{force.stiffness, pull, false, force.damping}, force.a, force.b,
                             one, other, order_);
        const double square = plain_value(Scalar(force.stiffness * (one + other)));  // of its angular frequency
        longest_ = std::min(longest_, pi / std::sqrt(square));
    }
    void add(const Attraction<Scalar>& force, const std::string& name) {
        const auto& m = model_.masses_.m;
        forces_.emplace_back(name, typename Central::Law{Scalar(0), force.constant, true, Scalar(0)}, force.a,
                             End<Scalar>(force.b), m[static_cast<Eigen::Index>(force.b)],
                             m[static_cast<Eigen::Index>(force.a)], order_);
    }
    void add(const Droplet<Scalar>& force, const std::string& name) {
        const Scalar pull = force.constant * force.mass;
        for (Eigen::Index i = 0; i < model_.masses_.m.size(); ++i)
            forces_.emplace_back(name, typename Central::Law{Scalar(0), pull, true, Scalar(0)},
                                 static_cast<std::size_t>(i), End<Scalar>(force.place), Scalar(1), Scalar(0), order_);
    }

    /// λ_k, q′_{k+1} and q_{k+2} from all before.
    void next(int k) {
        const auto n = static_cast<std::size_t>(k);
        Half& a = rates_[n + 1];
        a.setZero();
        if (k == 0)
            for (Eigen::Index y = 1; y < a.size(); y += 2) a[y] = -gravity_;
        for (auto& force : forces_) force.accelerate(k, a);
        auto& lambda = model_.lambda_;
        lambda.setZero();
        rods_.multiply(k, a, lambda);

        model_.set_.add_constraint_velocity(gradients_, a, lambda);
        lambda = -lambda;
        model_.matrix_.solve(lambda);
        model_.set_.add_pull(gradients_, model_.masses_.w, lambda, a);
        rods_.pull(k, lambda);

        a *= inverse_[n + 1];
        places_[n + 2] = a * inverse_[n + 2];
        if (k + 1 < order_) take(k + 2);
    }

    /// Coefficient k of all places, in rods and forces too
    void take(int k) {
        rods_.take(k, places_[static_cast<std::size_t>(k)]);
        for (auto& force : forces_) force.take(k, places_[static_cast<std::size_t>(k)]);
    }

    /// Finds out whether a singular configuration lies on the way to h: no series notices it where the motion could go on
    /// smoothly. From one place to another so near that no gradient has turned far, the volume that the gradients span
    /// must not turn over; where it seems to, somewhere between them, until they are all but the same.
    void check_path(const Scalar& h) {
        if (checked_gradients_.empty()) return;
        if (h < checked_) {
            checked_ = Scalar(0);
            checked_gradients_ = gradients_;
        }
        while (checked_ < h) {
            Scalar reached = h;
            for (int halvings = 0; !is_clear(reached, halvings == most_halvings); ++halvings)
                reached = checked_ + (reached - checked_) * Scalar(0.5);
            checked_ = reached;
            checked_gradients_.swap(ahead_);
        }
    }

    /// Whether nothing can be between the place last passed and that at time h. Throws if something seems to be and
    /// this is the last attempt.
    bool is_clear(const Scalar& h, bool last) {
        sum_up(places_, h, here_);
        here_ += places_[0];
        model_.set_.update(here_, ahead_);
        if (!Model::alike(ahead_, checked_gradients_)) return last;
        const auto row = factor(ahead_, checked_gradients_);
        if (last && row < model_.set_.rows()) model_.fail(here_, row);
        return row == model_.set_.rows();
    }

    /// Factors J1 M⁻¹ J0ᵀ, and finds the first row that depends on others there or has turned over.
    Eigen::Index factor(const Gradients& one, const Gradients& zero) {
        model_.set_.couple(one, zero, model_.masses_.w, model_.matrix_);
        const auto dependent = model_.matrix_.factor();
        return std::min(dependent, model_.matrix_.turned_over());
    }

    /// What the velocities amount to: those at the start, and what the accelerations make of rest over the mechanism's
    /// reach. An attracting body counts by its own pull, however far away it is. Without any reach the motion is
    /// linear, and longest_step() is enough.
    void find_amount() {
        const double acceleration = greatest(1);
        double length = reach_, square = 0;
        for (const auto& force : forces_)
            if (force.attracts())
                square = greater(square, force.strength(0) * force.distance());
            else
                length += force.distance();
        amount_ = greatest(0) + std::sqrt(greater(square, acceleration * length));
    }

    /// sum ← Σ_{k≥1} c_k h^k, a few components at a time: they stay in the cache.
    template <class Vector>
    static void sum_up(const std::vector<Half>& c, const Scalar& h, Vector& sum) {
        constexpr Eigen::Index some = 64;
        for (Eigen::Index first = 0; first < sum.size(); first += some) {
            auto part = sum.segment(first, std::min(some, sum.size() - first));
            part.setZero();
            for (std::size_t k = c.size() - 1; k > 0; --k) part = (part + c[k].segment(first, part.size())) * h;
        }
    }

    /// The greatest coefficient k of the velocities, m/s^(k+1).
    double greatest(int k) const {
        double most = 0;
        for (const Scalar& rate : rates_[static_cast<std::size_t>(k)])
            most = greater(most, std::abs(plain_value(rate)));
        return most;
    }

    static constexpr int most_halvings = 40;

    int order_;
    Model model_;
    std::vector<Half> places_, rates_;  // q_k and q′_k, order by order
    std::vector<Scalar> inverse_;       // 1/k
    std::vector<Central> forces_;
    Scalar gravity_ = Scalar(0);
    double reach_ = 0;  // m, of all rods in a line
    double longest_ = std::numeric_limits<double>::max();
    double amount_ = 0;                                // of the velocities, m/s
    Scalar checked_ = Scalar(0);                       // how far the way has been checked, s
    Half here_;                                        // q there
    Gradients gradients_, checked_gradients_, ahead_;  // J at the start, at checked_, further on
    RodBundle<Scalar> rods_;
};

template <class Scalar>
struct SeriesOf<Mechanism<Scalar>> {
    using type = MechanismSeries<Scalar>;
};
/// A chain of particles on rods is the mechanism of its parts.
template <class Scalar, int N>
struct SeriesOf<RodChain<Scalar, N>> {
    struct type : MechanismSeries<Scalar> {
        type(const RodChain<Scalar, N>& model, int order)
            : MechanismSeries<Scalar>(Mechanism<Scalar>(parts_of(model.pendulum)), order) {}
    };
};
/// Projected after every step, the motion is the same.
template <HasSeries Model>
struct SeriesOf<Projected<Model>> : SeriesOf<Model> {};

}  // namespace doppel
