#pragma once

#include "numeric/dual.hpp"
#include "physics/physical_pendulum.hpp"

#include <functional>
#include <memory>
#include <utility>

namespace doppel {

/// Natural units of a pendulum's motion: the mean link length, and a typical time.
struct NaturalUnits {
    double length;  // m
    double time;    // s: 1 / √(g/l) or 1 / the largest initial rate, whichever is less; 1 if nothing moves

    /// A drive counts like gravity, by the largest acceleration of the pivot, and that of all masses by the joint
    /// torques.
    explicit NaturalUnits(const PhysicalPendulum<double>& p);
};

/// The number of parts of an interval, so that no tangent overflows in one part.
long parts_of(double seconds, const NaturalUnits& units);

/// A state y of a model in angles over Dual<double, D>, with D tangents, as plain numbers: y, then for each component
/// of y D numbers, one for each tangent. If y contains the time, its tangents are 0.
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

/// The state and its tangents as one system, so that error control applies to all of them:
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

/// Integrates state and tangents by dop853, with restarts. Error control is relative to the size of tangents, so they
/// must be neither huge nor tiny. The first `angles` numbers must not be many turns.
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
