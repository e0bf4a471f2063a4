#pragma once

#include "numeric/state.hpp"

#include <concepts>

namespace doppel {

/// A first-order system y′ = f(y): what every method steps. rate() may use scratch space of the model: one model a
/// thread.
template <class M>
concept System = requires(M model, const typename M::State& y, typename M::State& dydt) {
    typename M::Scalar;
    model.rate(y, dydt);
};

/// A system of particles under constraints C(q) = 0 that a method can hold itself: J = ∂C/∂q, masses M, forces F.
/// The state is (q, v), both of type Half.
template <class M>
concept Constrained = System<M> && requires(M model, const typename M::Half& q, typename M::Half& v,
                                            const typename M::Multipliers& lambda, typename M::Multipliers& c) {
    { model.constraints() } -> std::convertible_to<Eigen::Index>;
    model.free_acceleration(q, q, v);    // v ← M⁻¹ F(q, v)
    model.residual(q, c);                // c ← C(q)
    model.constraint_velocity(q, q, c);  // c ← J(q) v
    model.jdot_v(q, q, c);               // c ← J̇(q, v) v
    model.pull(q, lambda, v);            // v ← v + M⁻¹ Jᵀ(q) λ
    model.solve(q, q, c);                // c ← (J(q1) M⁻¹ Jᵀ(q0))⁻¹ c
    model.rounding(q, c);                // c ← what C changes by where every coordinate is off by ε of the largest
};

/// The same, where nothing else holds the constraints (integrate/stabilise.hpp).
template <class M>
concept Unstabilised = Constrained<M> && !requires {
    M::is_stabilised;
};

}  // namespace doppel
