#pragma once

#include "physics/constraint.hpp"

namespace doppel {

/// The masses of the particles.
template <class Scalar>
struct Masses {
    State<Scalar, Eigen::Dynamic> m, w;  // kg; inverses, 1/kg
};

/// Newton's constant, m³/(kg s²), with the four digits used in the droplet study.
template <class Scalar>
Scalar newton_constant() {
    return Scalar(6674) / Scalar(100'000'000'000'000.0);
}

// Every force is a struct with these members:
//
//     kind                            its name in presets
//     accelerate(masses, q, v, a)     a ← a + M⁻¹ F(q, v)
//     energy(masses, q)               its potential energy, J; each states its zero

/// Uniform gravity, downwards. Energy: zero at y = 0.
template <class Scalar>
struct Gravity {
    static constexpr std::string_view kind = "gravity";

    Scalar g = Scalar(98) / Scalar(10);  // m/s²

    auto members() const { return std::tie(g); }

    template <class Vector, class Sum>
    void accelerate(const Masses<Scalar>& masses, const Vector&, const Vector&, Sum& a) const {
        for (Eigen::Index i = 0; i < masses.m.size(); ++i) a[2 * i + 1] -= g;
    }
    template <class Vector>
    Scalar energy(const Masses<Scalar>& masses, const Vector& q) const {
        Scalar sum(0);
        for (Eigen::Index i = 0; i < masses.m.size(); ++i) sum += masses.m[i] * g * q[2 * i + 1];
        return sum;
    }
};

/// A massless spring of stiffness k and rest length l, with damping c along it. Energy: zero at rest length.
///     F_a = −(k (|r| − l) + c |r|′) r/|r| ,   r = q_a − q_b ,   |r|′ = r·r′ / |r|
/// At |r| = 0 the direction is undefined, and the force is taken as zero.
template <class Scalar>
struct Spring {
    static constexpr std::string_view kind = "spring";

    std::size_t a;
    End<Scalar> b;
    Scalar stiffness;            // N/m, > 0
    Scalar length;               // m, ≥ 0, at rest
    Scalar damping = Scalar(0);  // N s/m, ≥ 0

    auto members() const { return std::tie(a, b, stiffness, length, damping); }

    template <class Vector, class Sum>
    void accelerate(const Masses<Scalar>& masses, const Vector& q, const Vector& v, Sum& sum) const {
        const Place<Scalar> r = part_of(q, a) - place_of(b, q), u = part_of(v, a) - velocity_of(b, v);
        const auto add_force = [&](std::size_t particle, const Scalar& f) {
            const auto i = static_cast<Eigen::Index>(particle);
            for (Eigen::Index axis = 0; axis < 2; ++axis) sum[2 * i + axis] += masses.w[i] * f * r[axis];
        };
        const auto add_forces = [&](const Scalar& f) {
            add_force(a, Scalar(-f));
            if (const auto* particle = std::get_if<std::size_t>(&b)) add_force(*particle, f);
        };
        if constexpr (requires { length.tape(); })  // |r| has no Taylor series at 0
            if (!has_direction()) return add_forces(stiffness);
        const Scalar now = length_of(r);
        if (now == Scalar(0)) return;
        add_forces((stiffness * (now - length) + damping * Scalar(inner(r, u) / now)) / now);
    }
    /// Whether the direction matters: without rest length and damping, the force is just k r.
    bool has_direction() const { return length != Scalar(0) || damping != Scalar(0); }
    template <class Vector>
    Scalar energy(const Masses<Scalar>&, const Vector& q) const {
        const Scalar stretch = length_of(Place<Scalar>(part_of(q, a) - place_of(b, q))) - length;
        return Scalar(0.5) * stiffness * stretch * stretch;
    }
};

/// 1 / |r|³
template <class Scalar>
Scalar inverse_cube(const Place<Scalar>& r) {
    using std::sqrt;
    const Scalar square = inner(r, r);
    return Scalar(1) / (square * sqrt(square));
}

/// Two particles that attract each other (Newton). Energy: zero at infinite distance.
///     F_a = −G m_a m_b r/|r|³ = −F_b ,   r = q_a − q_b
template <class Scalar>
struct Attraction {
    static constexpr std::string_view kind = "attraction";

    std::size_t a, b;
    Scalar constant = newton_constant<Scalar>();  // G, m³/(kg s²)

    auto members() const { return std::tie(a, b, constant); }

    template <class Vector, class Sum>
    void accelerate(const Masses<Scalar>& masses, const Vector& q, const Vector&, Sum& sum) const {
        const auto i = static_cast<Eigen::Index>(a), j = static_cast<Eigen::Index>(b);
        const Place<Scalar> r = part_of(q, a) - part_of(q, b);
        const Scalar factor = constant * inverse_cube(r);
        for (Eigen::Index axis = 0; axis < 2; ++axis) {
            sum[2 * i + axis] -= factor * masses.m[j] * r[axis];
            sum[2 * j + axis] += factor * masses.m[i] * r[axis];
        }
    }
    template <class Vector>
    Scalar energy(const Masses<Scalar>& masses, const Vector& q) const {
        const auto i = static_cast<Eigen::Index>(a), j = static_cast<Eigen::Index>(b);
        return -(constant * masses.m[i] * masses.m[j]) / length_of(Place<Scalar>(part_of(q, a) - part_of(q, b)));
    }
};

/// A fixed body of mass M that attracts every particle. Energy: zero at infinite distance.
///     F = −G m M r/|r|³ ,   r = q − p
template <class Scalar>
struct Droplet {
    static constexpr std::string_view kind = "droplet";

    Place<Scalar> place;                          // p, m
    Scalar mass;                                  // M, kg, > 0
    Scalar constant = newton_constant<Scalar>();  // G, m³/(kg s²)

    auto members() const { return std::tie(place, mass, constant); }

    template <class Vector, class Sum>
    void accelerate(const Masses<Scalar>& masses, const Vector& q, const Vector&, Sum& sum) const {
        for (Eigen::Index i = 0; i < masses.m.size(); ++i) {
            const Place<Scalar> r = part_of(q, static_cast<std::size_t>(i)) - place;
            const Scalar factor = constant * mass * inverse_cube(r);
            for (Eigen::Index axis = 0; axis < 2; ++axis) sum[2 * i + axis] -= factor * r[axis];
        }
    }
    template <class Vector>
    Scalar energy(const Masses<Scalar>& masses, const Vector& q) const {
        Scalar sum(0);
        for (Eigen::Index i = 0; i < masses.m.size(); ++i)
            sum -= constant * masses.m[i] * mass /
                   length_of(Place<Scalar>(part_of(q, static_cast<std::size_t>(i)) - place));
        return sum;
    }
};

/// All kinds of forces. This is the only list.
template <class Scalar>
using Force = std::variant<Gravity<Scalar>, Spring<Scalar>, Attraction<Scalar>, Droplet<Scalar>>;

}  // namespace doppel
