#pragma once

#include "physics/constraint.hpp"

namespace doppel {

/// The masses of the particles, as forces see them.
template <class Scalar>
struct Masses {
    State<Scalar, Eigen::Dynamic> m, w;  // kg, and 1/kg: the inverses
};

/// Newton's constant, m³/(kg s²), to the four digits that the study of the droplet uses.
template <class Scalar>
Scalar newton_constant() {
    return Scalar(6674) / Scalar(100'000'000'000'000.0);
}

// Every force is a struct like these:
//
//     kind                            as presets name it
//     accelerate(masses, q, v, a)     a ← a + M⁻¹ F(q, v)
//     energy(masses, q)               its potential, J; zero where it says
//     cast<To>()                      the same in another scalar

/// Uniform gravity, downwards. Energy: zero at y = 0.
template <class Scalar>
struct Gravity {
    static constexpr std::string_view kind = "gravity";

    Scalar g = Scalar(98) / Scalar(10);  // m/s²

    friend bool operator==(const Gravity&, const Gravity&) = default;

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
    template <class To>
    Gravity<To> cast() const {
        return {static_cast<To>(g)};
    }
};

/// A massless spring of stiffness k and rest length l, with damping c along it. Energy: zero at rest length.
///     F_a = −(k (|r| − l) + c |r|′) r/|r| ,   r = q_a − q_b ,   |r|′ = r·r′ / |r|
/// At |r| = 0 it has no direction, and pulls nowhere.
template <class Scalar>
struct Spring {
    static constexpr std::string_view kind = "spring";

    std::size_t a;
    End<Scalar> b;
    Scalar stiffness;            // N/m, > 0
    Scalar length;               // m, ≥ 0, at rest
    Scalar damping = Scalar(0);  // N s/m, ≥ 0

    friend bool operator==(const Spring&, const Spring&) = default;

    template <class Vector, class Sum>
    void accelerate(const Masses<Scalar>& masses, const Vector& q, const Vector& v, Sum& sum) const {
        const Place<Scalar> r = part_of(q, a) - place_of(b, q), u = part_of(v, a) - velocity_of(b, v);
        const auto pull_ends = [&](const Scalar& pull) {
            add(masses, a, Scalar(-pull), r, sum);
            if (const auto* particle = std::get_if<std::size_t>(&b)) add(masses, *particle, pull, r, sum);
        };
        if constexpr (requires { length.tape(); })  // there |r| has no series where it is 0
            if (!has_direction()) return pull_ends(stiffness);
        const Scalar now = norm(r);
        if (now == Scalar(0)) return;
        const Scalar stretching = (r[0] * u[0] + r[1] * u[1]) / now;
        pull_ends((stiffness * (now - length) + damping * stretching) / now);
    }
    /// Whether it needs one: without rest length and damping it is k r in any.
    bool has_direction() const { return length != Scalar(0) || damping != Scalar(0); }
    template <class Vector>
    Scalar energy(const Masses<Scalar>&, const Vector& q) const {
        const Scalar stretch = norm(part_of(q, a) - place_of(b, q)) - length;
        return Scalar(0.5) * stiffness * stretch * stretch;
    }
    template <class To>
    Spring<To> cast() const {
        return {a, cast_end<To>(b), static_cast<To>(stiffness), static_cast<To>(length), static_cast<To>(damping)};
    }

private:
    static Scalar norm(const Place<Scalar>& r) {
        using std::sqrt;
        return sqrt(Scalar(r[0] * r[0] + r[1] * r[1]));
    }
    /// The acceleration of `particle` by the force f r.
    template <class Sum>
    static void add(const Masses<Scalar>& masses, std::size_t particle, const Scalar& f, const Place<Scalar>& r,
                    Sum& sum) {
        const auto i = static_cast<Eigen::Index>(particle);
        sum[2 * i] += masses.w[i] * f * r[0];
        sum[2 * i + 1] += masses.w[i] * f * r[1];
    }
};

/// 1 / |r|³
template <class Scalar>
Scalar inverse_cube(const Place<Scalar>& r) {
    using std::sqrt;
    const Scalar square = r[0] * r[0] + r[1] * r[1];
    return Scalar(1) / (square * sqrt(square));
}

/// Two particles that attract each other (Newton). Energy: zero when infinitely far apart.
///     F_a = −G m_a m_b r/|r|³ = −F_b ,   r = q_a − q_b
template <class Scalar>
struct Attraction {
    static constexpr std::string_view kind = "attraction";

    std::size_t a, b;
    Scalar constant = newton_constant<Scalar>();  // G, m³/(kg s²)

    friend bool operator==(const Attraction&, const Attraction&) = default;

    template <class Vector, class Sum>
    void accelerate(const Masses<Scalar>& masses, const Vector& q, const Vector&, Sum& sum) const {
        const auto i = static_cast<Eigen::Index>(a), j = static_cast<Eigen::Index>(b);
        const Place<Scalar> r = part_of(q, a) - part_of(q, b);
        const Scalar pull = constant * inverse_cube(r);
        for (Eigen::Index axis = 0; axis < 2; ++axis) {
            sum[2 * i + axis] -= pull * masses.m[j] * r[axis];
            sum[2 * j + axis] += pull * masses.m[i] * r[axis];
        }
    }
    template <class Vector>
    Scalar energy(const Masses<Scalar>& masses, const Vector& q) const {
        using std::sqrt;
        const Place<Scalar> r = part_of(q, a) - part_of(q, b);
        const auto i = static_cast<Eigen::Index>(a), j = static_cast<Eigen::Index>(b);
        return -(constant * masses.m[i] * masses.m[j]) / sqrt(Scalar(r[0] * r[0] + r[1] * r[1]));
    }
    template <class To>
    Attraction<To> cast() const {
        return {a, b, static_cast<To>(constant)};
    }
};

/// A body of mass M that stays where it is and attracts every particle. Energy: zero when infinitely far away.
///     F = −G m M r/|r|³ ,   r = q − p
template <class Scalar>
struct Droplet {
    static constexpr std::string_view kind = "droplet";

    Place<Scalar> place;                          // p, m
    Scalar mass;                                  // M, kg, > 0
    Scalar constant = newton_constant<Scalar>();  // G, m³/(kg s²)

    friend bool operator==(const Droplet&, const Droplet&) = default;

    template <class Vector, class Sum>
    void accelerate(const Masses<Scalar>& masses, const Vector& q, const Vector&, Sum& sum) const {
        for (Eigen::Index i = 0; i < masses.m.size(); ++i) {
            const Place<Scalar> r = part_of(q, static_cast<std::size_t>(i)) - place;
            const Scalar pull = constant * mass * inverse_cube(r);
            sum[2 * i] -= pull * r[0];
            sum[2 * i + 1] -= pull * r[1];
        }
    }
    template <class Vector>
    Scalar energy(const Masses<Scalar>& masses, const Vector& q) const {
        using std::sqrt;
        Scalar sum(0);
        for (Eigen::Index i = 0; i < masses.m.size(); ++i) {
            const Place<Scalar> r = part_of(q, static_cast<std::size_t>(i)) - place;
            sum -= constant * masses.m[i] * mass / sqrt(Scalar(r[0] * r[0] + r[1] * r[1]));
        }
        return sum;
    }
    template <class To>
    Droplet<To> cast() const {
        return {place.template cast<To>(), static_cast<To>(mass), static_cast<To>(constant)};
    }
};

/// Every kind of force there is. The list stands here and nowhere else.
template <class Scalar>
using Force = std::variant<Gravity<Scalar>, Spring<Scalar>, Attraction<Scalar>, Droplet<Scalar>>;

}  // namespace doppel
