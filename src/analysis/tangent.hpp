#pragma once

#include "integrate/dormand_prince.hpp"
#include "numeric/dual.hpp"
#include "physics/physical_canonical.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace doppel {

/// kg
inline double mass_of(const Pendulum<double>& p) {
    double sum = 0;
    for (const double mass : p.mass) sum += mass;
    return sum;
}

/// What a pendulum's own motion is measured in: the mean link, and the time it takes for anything to happen.
struct NaturalUnits {
    double length;  // m
    double time;    // s: 1 / √(g/l) or 1 / the greatest rate at the release, whichever is less; 1 where nothing moves

    explicit NaturalUnits(const Pendulum<double>& p) : NaturalUnits(p, std::abs(p.gravity)) {}
    /// The drive counts as gravity: the greatest acceleration of the pivot, and that of all masses by the motors.
    explicit NaturalUnits(const PhysicalPendulum<double>& p)
        : NaturalUnits(p.chain, std::abs(p.chain.gravity) + driven_acceleration(p)) {}

private:
    NaturalUnits(const Pendulum<double>& p, double acceleration) : length(p.reach() / static_cast<double>(p.links())) {
        double fastest = std::sqrt(acceleration / length);
        for (const double rate : p.rate) fastest = std::max(fastest, std::abs(rate));
        time = fastest > 0 ? 1 / fastest : 1;
    }
    static double driven_acceleration(const PhysicalPendulum<double>& p) {
        const double nu = p.pivot.frequency,
                     unit = mass_of(p.chain) * p.chain.reach() / static_cast<double>(p.chain.links());
        double sum = nu * nu * std::hypot(p.pivot.x, p.pivot.y);
        for (const auto& motor : p.torques) sum += std::abs(motor.amplitude) / unit;
        return sum;
    }
};

/// A physical chain whose state leaves out the work done on it, which moves nothing: (θ, ω), and of a driven one the time.
template <class S>
class ChainWithoutWork : public PhysicalChain<S> {
public:
    using typename PhysicalChain<S>::State;
    explicit ChainWithoutWork(const PhysicalPendulum<S>& p) : PhysicalChain<S>(p, false) {}
    static State start(const PhysicalPendulum<S>& p) { return PhysicalChain<S>::start(p, false); }
};
template <class S>
struct Canonical<ChainWithoutWork<S>> : Canonical<PhysicalChain<S>> {
    using Canonical<PhysicalChain<S>>::Canonical;
};

inline std::size_t links_of(const Pendulum<double>& p) {
    return p.links();
}
inline std::size_t links_of(const PhysicalPendulum<double>& p) {
    return p.chain.links();
}

/// A model's state y and D tangents to it as one system of plain numbers, so that a method's control of its error sees
/// them all:
///     y′ = f(y) ,    δ′ = Df(y) δ
/// both from one evaluation of f in dual numbers. `Model` is one over Dual<double, D>. Time, where it is part of y, has no
/// tangents: they stay 0.
///
/// State   y, then D numbers for each component of y, one of each tangent.
/// Source  Benettin, Galgani, Giorgilli & Strelcyn 1980, Meccanica 15:9.
template <class Model>
class TangentFlow {
public:
    using Scalar = double;
    using DualState = typename Model::State;
    using Number = typename Model::Scalar;
    static constexpr int directions = Number::Tangent::RowsAtCompileTime;
    using State = doppel::State<double, times<1 + directions, DualState::RowsAtCompileTime>>;

    template <class Release>
    explicit TangentFlow(const Release& p)
        : model_(p.template cast<Number>()), y_(Model::start(p.template cast<Number>())), rate_(y_) {}

    void rate(const State& all, State& rates) {
        to_dual(all, y_);
        model_.rate(y_, rate_);
        from_dual(rate_, rates);
    }

    static void to_dual(const State& all, DualState& y) {
        const auto n = y.size();
        for (Eigen::Index i = 0; i < n; ++i) {
            y[i].value = all[i];
            for (Eigen::Index d = 0; d < directions; ++d) y[i].tangent[d] = all[n + i * directions + d];
        }
    }

    static void from_dual(const DualState& y, State& all) {
        const auto n = y.size();
        for (Eigen::Index i = 0; i < n; ++i) {
            all[i] = y[i].value;
            for (Eigen::Index d = 0; d < directions; ++d) all[n + i * directions + d] = y[i].tangent[d];
        }
    }

private:
    Model model_;
    DualState y_, rate_;
};

/// Into how many parts to cut an interval, so that no tangent outgrows its numbers within one.
inline long parts_of(double seconds, const NaturalUnits& units) {
    return std::max(1L, std::lround(std::ceil(seconds / (4 * units.time))));
}

/// The motion of a pendulum and its tangents by dop853, from where it is set down again and again: error control knows
/// only their size, so tangents are to be neither huge nor tiny, and angles not many turns.
template <class Model>
class TangentMotion {
public:
    using Flow = TangentFlow<Model>;
    using State = typename Flow::State;

    TangentMotion(const TangentMotion&) = delete;  // the stepper knows where the flow is
    template <class Release>
    TangentMotion(const Release& p, double tolerance)
        : flow_(p), tolerance_(tolerance), links_(static_cast<Eigen::Index>(links_of(p))) {}

    void restart(State y) {
        for (Eigen::Index i = 0; i < links_; ++i) y[i] = std::remainder(y[i], 2 * pi);
        if (stepper_)
            stepper_->reset(y);
        else
            stepper_.emplace(flow_, y, tolerance_);
    }
    void advance(double seconds) { stepper_->advance(seconds); }
    const State& state() const { return stepper_->state(); }

private:
    Flow flow_;
    double tolerance_;
    Eigen::Index links_;
    std::optional<Dop853::Stepper<Flow>> stepper_;
};

}  // namespace doppel
