#pragma once

namespace doppel {

/// A plane vector.
template <class Scalar>
struct Planar {
    Scalar x, y;

    [[gnu::always_inline]] friend Scalar dot(const Planar& a, const Planar& b) { return a.x * b.x + a.y * b.y; }
    [[gnu::always_inline]] friend Planar operator*(const Planar& a, const Scalar& b) { return {a.x * b, a.y * b}; }
    [[gnu::always_inline]] friend Planar operator+(const Planar& a, const Planar& b) { return {a.x + b.x, a.y + b.y}; }
    [[gnu::always_inline]] friend Planar operator-(const Planar& a, const Planar& b) { return {a.x - b.x, a.y - b.y}; }
};

/// The forces of two or three rods on the particles, with one division. With r_k = q_k − q_{k−1}, u_k = r_k′,
/// α_k = |r_k|², β_k = r_k·r_{k+1} and ρ_k = m_1/m_k, the unknowns x_k = λ_k ρ_{k−1} / m_1 (ρ_0 = 1) solve a
/// system with 1 before each β, the rows of that for λ (physics/rod_chain.hpp) divided by ρ_{k−1}:
///     | α1      −β1            |                     κ_2 = 1 + ρ_2
///     | −β1   κ_2 α2    −β2    | x = s,              κ_3 = (ρ_2 + ρ_3) / ρ_2²
///     |         −β2    κ_3 α3  |                     s = (g r_1y − |u_1|², −|u_2|², −|u_3|² / ρ_2),
/// by its adjugate, where r_3 and u_3 are divided by ρ_2. With p_k = x_k r_k the accelerations are
///     q_1″ = p_1 − p_2 − g ŷ,     q_2″ = ρ_2 p_2 − p_3 − g ŷ,     q_3″ = (m_2/m_3) p_3 − g ŷ .
template <class Scalar>
struct RodMultipliers {
    using Vector = Planar<Scalar>;

    Scalar gravity{0};            // g, m/s²
    Scalar rho2{0}, below{0};     // ρ_2, m_2/m_3
    Scalar kappa2{0}, kappa3{0};  // as above

    RodMultipliers() = default;
    template <class Masses>
    RodMultipliers(const Masses& w, const Scalar& g) : gravity(g), rho2(w[1] / w[0]), kappa2(Scalar(1) + rho2) {
        if (w.size() == 2) return;
        below = w[2] / w[1];
        kappa3 = (rho2 + w[2] / w[0]) / (rho2 * rho2);
    }

    [[gnu::always_inline]] void find(const Vector (&r)[2], const Vector (&u)[2], Vector (&p)[2]) const {
        const Scalar a1 = dot(r[0], r[0]), b1 = dot(r[0], r[1]), a2 = dot(r[1], r[1]) * kappa2;
        const Scalar inverse = Scalar(1) / (a1 * a2 - b1 * b1);
        const Scalar s1 = first(r, u), s2 = dot(u[1], u[1]);  // −s_2
        p[0] = r[0] * ((a2 * s1 - b1 * s2) * inverse);
        p[1] = r[1] * ((b1 * s1 - a1 * s2) * inverse);
    }

    [[gnu::always_inline]] void find(const Vector (&r)[3], const Vector (&u)[3], Vector (&p)[3]) const {
        const Scalar a1 = dot(r[0], r[0]), a2 = dot(r[1], r[1]) * kappa2, a3 = dot(r[2], r[2]) * kappa3;
        const Scalar b1 = dot(r[0], r[1]), b2 = dot(r[1], r[2]);
        const Scalar m23 = a2 * a3 - b2 * b2, square1 = b1 * b1, m12 = a1 * a2 - square1;
        const Scalar inverse = Scalar(1) / (a1 * m23 - square1 * a3);
        const Scalar s1 = first(r, u), s2 = dot(u[1], u[1]), s3 = dot(u[2], u[2]);  // −s_2, −s_3
        const Scalar lower = a3 * s2 + b2 * s3, upper = b1 * s1;
        p[0] = r[0] * ((m23 * s1 - b1 * lower) * inverse);
        p[1] = r[1] * ((a3 * upper - a1 * lower) * inverse);
        p[2] = r[2] * ((b2 * (upper - a1 * s2) - m12 * s3) * inverse);
    }

private:
    template <int N>
    [[gnu::always_inline]] Scalar first(const Vector (&r)[N], const Vector (&u)[N]) const {
        return (gravity * r[0].y - u[0].x * u[0].x) - u[0].y * u[0].y;
    }
};

}  // namespace doppel
