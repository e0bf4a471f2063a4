#pragma once

#include "numeric/state.hpp"

#include <cmath>
#include <concepts>
#include <optional>
#include <string_view>

namespace doppel {

/// A position in the plane, m: x to the right, y up. Also a velocity, m/s, or a direction.
template <class Scalar>
using Place = State<Scalar, 2>;

template <class Scalar>
Scalar inner(const Place<Scalar>& a, const Place<Scalar>& b) {
    return a[0] * b[0] + a[1] * b[1];
}
template <class Scalar>
Scalar length_of(const Place<Scalar>& r) {
    using std::sqrt;
    return sqrt(inner(r, r));
}

/// An end of a rod or spring: a particle (its index, from 0) or a fixed position.
template <class Scalar>
using End = std::variant<std::size_t, Place<Scalar>>;

/// The two components of `particle` in (x1, y1, x2, y2 …).
template <class Vector>
Place<typename Vector::Scalar> part_of(const Vector& all, std::size_t particle) {
    return all.template segment<2>(2 * static_cast<Eigen::Index>(particle));
}

template <class Scalar, class Vector>
Place<Scalar> place_of(const End<Scalar>& end, const Vector& q) {
    const auto* particle = std::get_if<std::size_t>(&end);
    return particle ? part_of(q, *particle) : std::get<Place<Scalar>>(end);
}

template <class Scalar, class Vector>
Place<Scalar> velocity_of(const End<Scalar>& end, const Vector& v) {
    const auto* particle = std::get_if<std::size_t>(&end);
    return particle ? part_of(v, *particle) : Place<Scalar>(Scalar(0), Scalar(0));
}

// Every constraint has a `kind`, its name in presets.

/// A particle held at a fixed position.
template <class Scalar>
struct Anchor {
    static constexpr std::string_view kind = "anchor";

    std::size_t particle;
    Place<Scalar> place;  // m

    auto members() const { return std::tie(particle, place); }
};

/// A massless rigid rod.
template <class Scalar>
struct Rod {
    static constexpr std::string_view kind = "rod";

    std::size_t a;
    End<Scalar> b;
    Scalar length;  // m, > 0

    auto members() const { return std::tie(a, b, length); }
};

/// A straight slot without friction or ends, in which a particle slides: the line through a point.
template <class Scalar>
struct SlotLine {
    static constexpr std::string_view kind = "slot-line";

    std::size_t particle;
    Place<Scalar> point;      // m
    Place<Scalar> direction;  // not zero; a picture draws the slot from `point` to `point` + `direction`

    auto members() const { return std::tie(particle, point, direction); }
};

/// A circular slot in which a particle slides; equivalent to a rod from its centre.
template <class Scalar>
struct SlotCircle {
    static constexpr std::string_view kind = "slot-circle";

    std::size_t particle;
    Place<Scalar> centre;  // m
    Scalar radius;         // m, > 0

    auto members() const { return std::tie(particle, centre, radius); }
};

/// All kinds of constraints. This is the only list.
template <class Scalar>
using Constraint = std::variant<Anchor<Scalar>, Rod<Scalar>, SlotLine<Scalar>, SlotCircle<Scalar>>;

/// The equivalent rod of a constraint; a circular slot's begins at its centre. None for straight ones.
template <class Scalar>
std::optional<Rod<Scalar>> rod_of(const Constraint<Scalar>& constraint) {
    if (const auto* rod = std::get_if<Rod<Scalar>>(&constraint)) return *rod;
    if (const auto* slot = std::get_if<SlotCircle<Scalar>>(&constraint))
        return Rod<Scalar>{slot->particle, slot->centre, slot->radius};
    return std::nullopt;
}

/// A condition C(q) = 0 that relates a particle to another or to a fixed position. With r = q_a − q_b:
///     C = ½ (|r|² − l²)     for a rod
///     C = n·r               for a straight slot
template <class Scalar>
struct ConstraintRow {
    std::size_t a;
    End<Scalar> b;
    bool is_straight;
    Scalar length;         // l, m, for a rod
    Place<Scalar> normal;  // n, for a straight slot

    template <class Vector>
    Place<Scalar> distance_of_ends(const Vector& q) const {
        return part_of(q, a) - place_of(b, q);
    }
    template <class Vector>
    Scalar value(const Vector& q) const {
        const auto r = distance_of_ends(q);
        return is_straight ? inner(normal, r) : Scalar((inner(r, r) - length * length) * Scalar(0.5));
    }
    /// ∂C/∂q_a; if b is a particle, ∂C/∂q_b is its negative.
    template <class Vector>
    Place<Scalar> gradient(const Vector& q) const {
        return is_straight ? normal : distance_of_ends(q);
    }
    /// J̇ v, the part of C″ without accelerations
    template <class Vector>
    Scalar jdot_v(const Vector& v) const {
        if (is_straight) return Scalar(0);
        const Place<Scalar> u = part_of(v, a) - velocity_of(b, v);
        return inner(u, u);
    }
    const std::size_t* other_particle() const { return std::get_if<std::size_t>(&b); }
};

/// One condition, or two for an anchor.
template <class Scalar>
std::vector<ConstraintRow<Scalar>> rows_of(const Constraint<Scalar>& constraint) {
    const Scalar zero(0), one(1);
    const auto straight = [&](std::size_t particle, const Place<Scalar>& at, const Scalar& x, const Scalar& y) {
        return ConstraintRow<Scalar>{particle, at, true, zero, Place<Scalar>(x, y)};
    };
    if (const auto rod = rod_of(constraint)) return {{rod->a, rod->b, false, rod->length, Place<Scalar>(zero, zero)}};
    if (const auto* slot = std::get_if<SlotLine<Scalar>>(&constraint))
        return {straight(slot->particle, slot->point, Scalar(-slot->direction[1]), slot->direction[0])};
    const auto& [particle, place] = std::get<Anchor<Scalar>>(constraint);
    return {straight(particle, place, one, zero), straight(particle, place, zero, one)};
}

/// The distance by which its particles violate a constraint, m.
template <class Scalar, class Vector>
Scalar error_of(const Constraint<Scalar>& constraint, const Vector& q) {
    using std::abs;
    const auto row = rows_of(constraint)[0];
    if (std::holds_alternative<Anchor<Scalar>>(constraint)) return length_of(row.distance_of_ends(q));
    if (row.is_straight) return abs(row.value(q)) / length_of(row.normal);
    return abs(Scalar(length_of(row.distance_of_ends(q)) - row.length));
}

/// A first-order system y′ = f(y), as required by every method. rate() may use scratch memory of the model, so each
/// thread needs its own model.
template <class M>
concept System = requires(M& model, const typename M::State& y, typename M::State& dydt) {
    typename M::Scalar;
    model.rate(y, dydt);
};

/// A system of particles with constraints C(q) = 0 that a method can enforce itself: J = ∂C/∂q, masses M, forces F. The
/// state is (q, v), both of type Half.
template <class M>
concept Constrained = System<M> && requires(M model, const typename M::Half& q, typename M::Half& v,
                                            const typename M::Multipliers& lambda, typename M::Multipliers& c) {
    { model.constraints() } -> std::convertible_to<Eigen::Index>;
    { model.depends_on_velocity() } -> std::convertible_to<bool>;  // whether forces do, as friction
    model.free_acceleration(q, q, v);                              // v ← M⁻¹ F(q, v)
    model.residual(q, c);                                          // c ← C(q)
    model.constraint_velocity(q, q, c);                            // c ← J(q) v
    model.jdot_v(q, q, c);                                         // c ← J̇(q, v) v
    model.apply_multipliers(q, lambda, v);                         // v ← v + M⁻¹ Jᵀ(q) λ
    model.solve(q, q, c);                                          // c ← (J(q1) M⁻¹ Jᵀ(q0))⁻¹ c
    model.rounding(q, c);  // c ← ε |q| Σ_j |J_ij|, with the largest coordinate: the rounding of C
};

/// The same, without stabilisation of its own (integrate/stabilise.hpp).
template <class M>
concept Unstabilised = Constrained<M> && !requires {
    M::is_stabilised;
};

}  // namespace doppel
