#pragma once

#include "base/error.hpp"
#include "numeric/tridiagonal.hpp"
#include "physics/physical_pendulum.hpp"
#include "physics/rod_pulls.hpp"

#include <limits>
#include <vector>

namespace doppel {

/// The masses of a chain of rigid bodies, as the ends of its links move. A link (m, I about its centre, a from its joint
/// to the centre, length l) has, with s = a/l, the mass matrix
///     of its joint  m (1 − s)² + I/l² ,     of its end  m s² + I/l² ,     of both  m s (1 − s) − I/l²
/// (the same for x and y), exact while the ends are l apart: then |q′ − p′|² = l² ω². So the matrix of all, M, is constant
/// and tridiagonal. (Point masses that move like the body, three of them, would need constraints for that inside the rod,
/// whose gradients depend on those of its ends.)
///
/// The pivot, node 0, is led: what couples it to node 1 is a force there.
/// Errors  exit 2 where M is singular: an end moves without anything that has mass.
template <class S>
class EndMasses {
public:
    using Scalar = S;
    using Column = State<Scalar, Eigen::Dynamic>;
    using Vector = Planar<Scalar>;

    Column own, coupled;  // kg: of node k, and of nodes k − 1 and k (`coupled[0]` with the pivot)
    Column share;  // kg: of the momentum, Σ share_k v_k, and of the weight; that of the pivot's node is `at_pivot`
    Scalar at_pivot{0}, total{0};
    Column led;  // how much of the pivot's acceleration a free node takes the opposite of

    explicit EndMasses(const PhysicalPendulum<Scalar>& p)
        : own(Column::Zero(static_cast<Eigen::Index>(p.chain.links()))),
          coupled(own),
          share(own),
          led(own),
          matrix_(own.size()),
          x_(own),
          y_(own) {
        for (Eigen::Index k = 0; k < own.size(); ++k) add_link(p, k);
        matrix_.diagonal = own;
        for (Eigen::Index k = 1; k < own.size(); ++k) matrix_.upper[k - 1] = matrix_.lower[k - 1] = coupled[k];
        matrix_.factor();
        for (Eigen::Index k = 0; k < own.size(); ++k)
            if (!(matrix_.diagonal[k] * own[k] < most) || !(matrix_.diagonal[k] > Scalar(0)))
                throw bad_input(
                    "the end of link {} moves no mass; particles on rods cannot be computed so: give that link or the "
                    "next an inertia, or choose model = \"angles\"",
                    k + 1);
        led[0] = coupled[0];
        matrix_.solve(led);
    }

    Eigen::Index size() const { return own.size(); }

    /// v ← v + M⁻¹ f, where both are (x1, y1, x2, y2 …), v perhaps with more behind. Returns the momentum of what it adds.
    template <class Forces, class Values>
    Vector add_solved(const Forces& f, Values& v) {
        for (Eigen::Index k = 0; k < size(); ++k) {
            x_[k] = f[2 * k];
            y_[k] = f[2 * k + 1];
        }
        matrix_.solve(x_);
        matrix_.solve(y_);
        Vector momentum{Scalar(0), Scalar(0)};
        for (Eigen::Index k = 0; k < size(); ++k) {
            v[2 * k] += x_[k];
            v[2 * k + 1] += y_[k];
            momentum = momentum + Vector{x_[k], y_[k]} * share[k];
        }
        return momentum;
    }
    /// Σ share_k v_k over all nodes but the pivot.
    template <class Values>
    Vector momentum(const Values& v) const {
        Vector sum{Scalar(0), Scalar(0)};
        for (Eigen::Index k = 0; k < size(); ++k) sum = sum + Vector{v[2 * k], v[2 * k + 1]} * share[k];
        return sum;
    }

private:
    inline static const Scalar most = Scalar(1) / (Scalar(16) * std::numeric_limits<Scalar>::epsilon());

    void add_link(const PhysicalPendulum<Scalar>& p, Eigen::Index k) {
        const auto i = static_cast<std::size_t>(k);
        const Scalar m = p.chain.mass[i], l = p.chain.length[i];
        const Scalar s = p.center[i] / l, rest = Scalar(1) - s, turning = p.inertia[i] / (l * l);
        own[k] += m * s * s + turning;
        coupled[k] = m * s * rest - turning;
        share[k] += m * s;
        total += m;
        if (k == 0) {
            at_pivot = m * rest;
        } else {
            own[k - 1] += m * rest * rest + turning;
            share[k - 1] += m * rest;
        }
    }

    Tridiagonal<Scalar, Eigen::Dynamic> matrix_;
    Column x_, y_;
};

/// Solves J1 M⁻¹ J0ᵀ λ = x of the rods of such a chain, r_k = q_k − q_{k−1}, in O(N), from its end to the pivot and back.
/// With w = M⁻¹ J0ᵀ λ and c_k for what couples k − 1 and k, rod k + 1 and all below leave of the equations
///     A w_k + c_k w_{k−1} + b = r0_k λ_k − u0 λ_{k+1} ,     e λ_{k+1} = z + u1·w_k ,     r1_k·(w_k − w_{k−1}) = x_k .
/// Without w_k, the second is, with d = e + u1·A⁻¹u0,
///     d λ_{k+1} = z − u1·A⁻¹b + (u1·A⁻¹r0) λ_k − c u1·A⁻¹w_{k−1} ,
/// and without λ_{k+1}, too, with B = A⁻¹ − (A⁻¹u0)(u1 A⁻¹) / d and f = A⁻¹b + A⁻¹u0 (z − u1·A⁻¹b) / d, next are
///     M_{k−1} − c² B ,  −c f ,  u0 = r0 + c B r0 ,  u1 = r1 + c Bᵀ r1 ,  e = r1·B r0 ,  z = x_k + r1·f .
/// In this order a light end between heavy ones costs no digits: A is nowhere greater than M, and of point masses (c = 0) it
/// is the elimination of RodChain. No pivoting: A, d and e are positive while q1 is near q0.
template <class S>
class RodPullsOfBodies {
public:
    using Scalar = S;
    using Vector = Planar<Scalar>;

    explicit RodPullsOfBodies(std::size_t links) : links_(links) {}

    /// rod(k) gives r0 and r1 of rod k.
    template <class Rod, class Multipliers>
    void solve(const EndMasses<Scalar>& masses, const Rod& rod, Multipliers& x) {
        const Vector none{Scalar(0), Scalar(0)};
        Matrix a = Matrix::of(masses.own[masses.size() - 1]);
        Vector b = none, u0 = none, u1 = none;
        Scalar e(1), z(0);
        for (Eigen::Index k = masses.size() - 1; k >= 0; --k) {
            auto& link = links_[static_cast<std::size_t>(k)];
            const auto [r0, r1] = rod(k);
            const Scalar& c = masses.coupled[k];
            const Matrix inverse = a.inverse();
            const Vector column = inverse.times(u0), row = inverse.transposed().times(u1), free = inverse.times(b);
            link.by_d = Scalar(1) / Scalar(e + dot(u1, column));
            link.z = z - dot(u1, free);
            link.by_rod = dot(row, r0);
            link.inverse = inverse;
            link.row = row;
            link.r0 = r0, link.u0 = u0, link.b = b;
            const Matrix rest = inverse.less(column * link.by_d, row);  // B
            const Vector f = free + column * Scalar(link.z * link.by_d);
            const Vector pulled = rest.times(r0);
            e = dot(r1, pulled);
            z = x[k] + dot(r1, f);
            if (k == 0) break;
            u0 = r0 + pulled * c;
            u1 = r1 + rest.transposed().times(r1) * c;
            b = f * Scalar(-c);
            a = rest.from(masses.own[k - 1], Scalar(c * c));
        }
        Vector w = none;
        x[0] = z / e;
        for (Eigen::Index k = 0; k + 1 < masses.size(); ++k) {
            const auto& link = links_[static_cast<std::size_t>(k)];
            const Vector led = w * masses.coupled[k];
            x[k + 1] = (link.z + link.by_rod * x[k] - dot(link.row, led)) * link.by_d;
            w = link.inverse.times(link.r0 * x[k] - link.u0 * x[k + 1] - led - link.b);
        }
    }

private:
    struct Matrix {
        Scalar xx, xy, yx, yy;
        static Matrix of(const Scalar& m) { return {m, Scalar(0), Scalar(0), m}; }
        Vector times(const Vector& v) const { return {xx * v.x + xy * v.y, yx * v.x + yy * v.y}; }
        Matrix transposed() const { return {xx, yx, xy, yy}; }
        Matrix inverse() const {
            const Scalar by_determinant = Scalar(1) / Scalar(xx * yy - xy * yx);
            return {yy * by_determinant, -(xy * by_determinant), -(yx * by_determinant), xx * by_determinant};
        }
        /// Less column rowᵀ.
        Matrix less(const Vector& column, const Vector& row) const {
            return {xx - column.x * row.x, xy - column.x * row.y, yx - column.y * row.x, yy - column.y * row.y};
        }
        /// m less factor times this.
        Matrix from(const Scalar& m, const Scalar& factor) const {
            return {m - factor * xx, -(factor * xy), -(factor * yx), m - factor * yy};
        }
    };
    struct Link {
        Matrix inverse{};               // A⁻¹
        Vector r0{}, u0{}, row{}, b{};  // row: u1 A⁻¹
        Scalar by_d{}, z{}, by_rod{};   // by_rod: u1·A⁻¹r0
    };
    std::vector<Link> links_;
};

}  // namespace doppel
