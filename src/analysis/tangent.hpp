#pragma once

#include "numeric/dual.hpp"
#include "physics/physical_pendulum.hpp"

#include <functional>
#include <memory>
#include <utility>

namespace doppel {

/// What a pendulum's own motion is measured in: the mean link, and the time it takes for anything to happen.
struct NaturalUnits {
    double length;  // m
    double time;    // s: 1 / √(g/l) or 1 / the greatest rate at the release, whichever is less; 1 where nothing moves

    /// The drive counts as gravity: the greatest acceleration of the pivot, and that of all masses by the motors.
    explicit NaturalUnits(const PhysicalPendulum<double>& p);
};

/// Into how many parts to cut an interval, so that no tangent outgrows its numbers within one.
long parts_of(double seconds, const NaturalUnits& units);

/// A state y of a model in angles over Dual<double, D>, and D tangents to it, as plain numbers: y, then D numbers for each
/// component of y, one of each tangent. Time, where it is part of y, has no tangents: they stay 0.
using TangentState = State<double, Eigen::Dynamic>;

template <class DualState>
void to_dual(const TangentState& all, DualState& y) {
    constexpr Eigen::Index directions = DualState::Scalar::Tangent::RowsAtCompileTime;
    for (Eigen::Index i = 0; i < y.size(); ++i) {
        y[i].value = all[i];
        y[i].tangent = all.segment<directions>(y.size() + i * directions);
    }
}

template <class DualState>
void from_dual(const DualState& y, TangentState& all) {
    constexpr Eigen::Index directions = DualState::Scalar::Tangent::RowsAtCompileTime;
    all.resize(y.size() * (1 + directions));
    for (Eigen::Index i = 0; i < y.size(); ++i) {
        all[i] = y[i].value;
        all.segment<directions>(y.size() + i * directions) = y[i].tangent;
    }
}

/// The state and its tangents as one system, so that a method's control of its error sees them all:
///     y′ = f(y) ,    δ′ = Df(y) δ
/// both from one evaluation of f in dual numbers.
/// Source  Benettin, Galgani, Giorgilli & Strelcyn 1980, Meccanica 15:9.
struct TangentFlow {
    using Scalar = double;
    using State = TangentState;

    std::function<void(const TangentState& all, TangentState& rates)> rate;
    TangentState start;
};

template <class Model>
TangentFlow tangent_flow(Model model, const typename Model::State& start) {
    TangentFlow flow;
    from_dual(start, flow.start);
    flow.rate = [model = std::move(model), y = start, rate = start](const TangentState& all,
                                                                    TangentState& rates) mutable {
        to_dual(all, y);
        model.rate(y, rate);
        from_dual(rate, rates);
    };
    return flow;
}

/// Both by dop853, from where they are set down again and again: error control knows only the size of tangents, so these
/// are to be neither huge nor tiny, and the first `angles` numbers not many turns.
class TangentMotion {
public:
    TangentMotion(TangentFlow flow, std::size_t angles, double tolerance);
    ~TangentMotion();

    void restart(TangentState y);
    const TangentState& advance(double seconds);

private:
    struct Stepper;
    std::unique_ptr<Stepper> stepper_;
};

}  // namespace doppel
