#pragma once

#include "numeric/state.hpp"

#include <array>
#include <concepts>
#include <cstddef>
#include <optional>
#include <string_view>
#include <variant>

namespace doppel {

/// A place in the plane, m: x to the right, y up. Also a velocity, m/s, or a direction.
template <class Scalar>
using Place = State<Scalar, 2>;

/// Where a rod or a spring ends: on a particle (its index, from 0) or at a fixed place.
template <class Scalar>
using End = std::variant<std::size_t, Place<Scalar>>;

/// The share that `particle` has in (x1, y1, x2, y2 …).
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

template <class To, class Scalar>
End<To> cast_end(const End<Scalar>& end) {
    if (const auto* particle = std::get_if<std::size_t>(&end)) return *particle;
    return Place<To>(std::get<Place<Scalar>>(end).template cast<To>());
}

// Every constraint is a struct like these:
//
//     kind                 as presets name it
//     rows                 how many conditions C(q) = 0 it sets
//     value(q)             C
//     gradient(q, emit)    calls emit(row, particle, ∂C_row/∂q_particle) for every particle it ties, in one order
//     jdot_v(v)            J̇ v, the part of C″ that is there without any acceleration
//     error(q)             how far the particles are from where it wants them, m
//     cast<To>()           the same in another scalar

/// A particle held at a fixed place p.
///     C = q − p
template <class Scalar>
struct Anchor {
    static constexpr std::string_view kind = "anchor";
    static constexpr std::size_t rows = 2;

    std::size_t particle;
    Place<Scalar> place;  // m

    friend bool operator==(const Anchor&, const Anchor&) = default;

    template <class Vector>
    std::array<Scalar, rows> value(const Vector& q) const {
        const Place<Scalar> r = part_of(q, particle) - place;
        return {r[0], r[1]};
    }
    template <class Vector, class Emit>
    void gradient(const Vector&, Emit&& emit) const {
        emit(0, particle, Place<Scalar>(Scalar(1), Scalar(0)));
        emit(1, particle, Place<Scalar>(Scalar(0), Scalar(1)));
    }
    template <class Vector>
    std::array<Scalar, rows> jdot_v(const Vector&) const {
        return {Scalar(0), Scalar(0)};
    }
    template <class Vector>
    Scalar error(const Vector& q) const {
        using std::sqrt;
        const Place<Scalar> r = part_of(q, particle) - place;
        return sqrt(Scalar(r[0] * r[0] + r[1] * r[1]));
    }
    template <class To>
    Anchor<To> cast() const {
        return {particle, place.template cast<To>()};
    }
};

/// A massless rigid rod of length l.
///     C = ½ (|r|² − l²),   r = q_a − q_b
template <class Scalar>
struct Rod {
    static constexpr std::string_view kind = "rod";
    static constexpr std::size_t rows = 1;

    std::size_t a;
    End<Scalar> b;
    Scalar length;  // m, > 0

    friend bool operator==(const Rod&, const Rod&) = default;

    template <class Vector>
    std::array<Scalar, rows> value(const Vector& q) const {
        const Place<Scalar> r = along(q);
        return {(r[0] * r[0] + r[1] * r[1] - length * length) * Scalar(0.5)};
    }
    template <class Vector, class Emit>
    void gradient(const Vector& q, Emit&& emit) const {
        const Place<Scalar> r = along(q);
        emit(0, a, r);
        if (const auto* particle = std::get_if<std::size_t>(&b)) emit(0, *particle, Place<Scalar>(-r));
    }
    template <class Vector>
    std::array<Scalar, rows> jdot_v(const Vector& v) const {
        const Place<Scalar> u = part_of(v, a) - velocity_of(b, v);
        return {u[0] * u[0] + u[1] * u[1]};
    }
    template <class Vector>
    Scalar error(const Vector& q) const {
        using std::abs;
        using std::sqrt;
        const Place<Scalar> r = along(q);
        return abs(Scalar(sqrt(Scalar(r[0] * r[0] + r[1] * r[1])) - length));
    }
    template <class To>
    Rod<To> cast() const {
        return {a, cast_end<To>(b), static_cast<To>(length)};
    }

private:
    template <class Vector>
    Place<Scalar> along(const Vector& q) const {
        return part_of(q, a) - place_of(b, q);
    }
};

/// A straight slot, without friction or ends, that a particle slides in: the line through p along d of any length.
///     C = d × (q − p) = d_x (q_y − p_y) − d_y (q_x − p_x)
template <class Scalar>
struct SlotLine {
    static constexpr std::string_view kind = "slot-line";
    static constexpr std::size_t rows = 1;

    std::size_t particle;
    Place<Scalar> point;      // m
    Place<Scalar> direction;  // not zero; a picture draws the slot from `point` to `point` + `direction`

    friend bool operator==(const SlotLine&, const SlotLine&) = default;

    template <class Vector>
    std::array<Scalar, rows> value(const Vector& q) const {
        const Place<Scalar> r = part_of(q, particle) - point;
        return {direction[0] * r[1] - direction[1] * r[0]};
    }
    template <class Vector, class Emit>
    void gradient(const Vector&, Emit&& emit) const {
        emit(0, particle, Place<Scalar>(Scalar(-direction[1]), direction[0]));
    }
    template <class Vector>
    std::array<Scalar, rows> jdot_v(const Vector&) const {
        return {Scalar(0)};
    }
    template <class Vector>
    Scalar error(const Vector& q) const {
        using std::abs;
        using std::sqrt;
        return abs(value(q)[0]) / sqrt(Scalar(direction[0] * direction[0] + direction[1] * direction[1]));
    }
    template <class To>
    SlotLine<To> cast() const {
        return {particle, point.template cast<To>(), direction.template cast<To>()};
    }
};

/// A circular slot that a particle slides in: what a rod from the centre would do, and so does this.
template <class Scalar>
struct SlotCircle {
    static constexpr std::string_view kind = "slot-circle";
    static constexpr std::size_t rows = 1;

    std::size_t particle;
    Place<Scalar> centre;  // m
    Scalar radius;         // m, > 0

    Rod<Scalar> rod() const { return {particle, centre, radius}; }

    friend bool operator==(const SlotCircle&, const SlotCircle&) = default;

    template <class Vector>
    std::array<Scalar, rows> value(const Vector& q) const {
        return rod().value(q);
    }
    template <class Vector, class Emit>
    void gradient(const Vector& q, Emit&& emit) const {
        rod().gradient(q, emit);
    }
    template <class Vector>
    std::array<Scalar, rows> jdot_v(const Vector& v) const {
        return rod().jdot_v(v);
    }
    template <class Vector>
    Scalar error(const Vector& q) const {
        return rod().error(q);
    }
    template <class To>
    SlotCircle<To> cast() const {
        return {particle, centre.template cast<To>(), static_cast<To>(radius)};
    }
};

/// Every kind of constraint there is. The list stands here and nowhere else.
template <class Scalar>
using Constraint = std::variant<Anchor<Scalar>, Rod<Scalar>, SlotLine<Scalar>, SlotCircle<Scalar>>;

/// The rod that a constraint is or acts as, a circular slot's from its centre; none where it is straight.
template <class Scalar>
std::optional<Rod<Scalar>> rod_of(const Constraint<Scalar>& constraint) {
    if (const auto* rod = std::get_if<Rod<Scalar>>(&constraint)) return *rod;
    if (const auto* slot = std::get_if<SlotCircle<Scalar>>(&constraint)) return slot->rod();
    return std::nullopt;
}

/// The fixed place that a constraint ties its particle to; none where it ties two particles.
template <class Scalar>
std::optional<Place<Scalar>> fixed_place_of(const Constraint<Scalar>& constraint) {
    if (const auto* anchor = std::get_if<Anchor<Scalar>>(&constraint)) return anchor->place;
    if (const auto* slot = std::get_if<SlotLine<Scalar>>(&constraint)) return slot->point;
    const auto end = rod_of(constraint)->b;
    if (const auto* place = std::get_if<Place<Scalar>>(&end)) return *place;
    return std::nullopt;
}

/// A first-order system y′ = f(y): what every method steps. rate() may use scratch space of the model: one model a
/// thread.
template <class M>
concept System = requires(M& model, const typename M::State& y, typename M::State& dydt) {
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
