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
/// With w = M⁻¹ J0ᵀ λ, node k feels of all below it (c_k: what couples k − 1 and k)
///     A w_k + c_k w_{k−1} + b = r0 λ_k ,     r1·(w_k − w_{k−1}) = x_k ,
/// so that, with e = r1·A⁻¹ r0, g0 = r0 + c A⁻¹ r0, g1 = r1 + c A⁻ᵀ r1 and z = x_k + r1·A⁻¹ b,
///     λ_k = (z + g1·w_{k−1}) / e ,     w_k = A⁻¹ (r0 λ_k − c w_{k−1} − b) ,
/// and node k − 1 feels M_{k−1} − c² A⁻¹ + g0 g1ᵀ / e in place of A and g0 z / e − c A⁻¹ b in place of b.
/// No pivoting: while q1 is near q0, A and e are positive.
template <class S>
class RodPullsOfBodies {
public:
    using Scalar = S;
    using Vector = Planar<Scalar>;

    explicit RodPullsOfBodies(std::size_t links) : links_(links) {}

    /// rod(k) gives r0 and r1 of rod k.
    template <class Rod, class Multipliers>
    void solve(const EndMasses<Scalar>& masses, const Rod& rod, Multipliers& x) {
        Matrix a{masses.own[masses.size() - 1], Scalar(0), Scalar(0), masses.own[masses.size() - 1]};
        Vector b{Scalar(0), Scalar(0)};
        for (Eigen::Index k = masses.size() - 1; k >= 0; --k) {
            auto& link = links_[static_cast<std::size_t>(k)];
            const auto [r0, r1] = rod(k);
            const Scalar& c = masses.coupled[k];
            link.inverse = a.inverse();
            link.r0 = r0;
            link.b = b;
            const Vector b_free = link.inverse.times(b), pulled = link.inverse.times(r0);
            const Vector g0 = r0 + pulled * c;
            link.g1 = r1 + link.inverse.transposed().times(r1) * c;
            link.by_e = Scalar(1) / dot(r1, pulled);
            link.z = x[k] + dot(r1, b_free);
            if (k == 0) break;
            const Scalar& above = masses.own[k - 1];
            const Vector h = g0 * link.by_e;
            const Scalar c2 = c * c;
            a = {above - c2 * link.inverse.xx + h.x * link.g1.x, h.x * link.g1.y - c2 * link.inverse.xy,
                 h.y * link.g1.x - c2 * link.inverse.yx, above - c2 * link.inverse.yy + h.y * link.g1.y};
            b = h * link.z - b_free * c;
        }
        Vector w{Scalar(0), Scalar(0)};
        for (Eigen::Index k = 0; k < masses.size(); ++k) {
            const auto& link = links_[static_cast<std::size_t>(k)];
            x[k] = (link.z + dot(link.g1, w)) * link.by_e;
            w = link.inverse.times(link.r0 * x[k] - w * masses.coupled[k] - link.b);
        }
    }

private:
    struct Matrix {
        Scalar xx, xy, yx, yy;
        Vector times(const Vector& v) const { return {xx * v.x + xy * v.y, yx * v.x + yy * v.y}; }
        Matrix transposed() const { return {xx, yx, xy, yy}; }
        Matrix inverse() const {
            const Scalar by_determinant = Scalar(1) / Scalar(xx * yy - xy * yx);
            return {yy * by_determinant, -(xy * by_determinant), -(yx * by_determinant), xx * by_determinant};
        }
    };
    struct Link {
        Matrix inverse{};  // A⁻¹
        Vector r0{}, g1{}, b{};
        Scalar by_e{}, z{};
    };
    std::vector<Link> links_;
};

}  // namespace doppel
