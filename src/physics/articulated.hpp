#pragma once

#include "physics/physical_pendulum.hpp"
#include "physics/rod_multipliers.hpp"

#include <array>
#include <type_traits>
#include <vector>

namespace doppel {

/// The accelerations of a chain of rigid bodies in O(N), from its end to the pivot and back (articulated-body
/// algorithm).
///
/// With n = (sinθ, −cosθ) along a link, t = (cosθ, sinθ) across it, joint at p, centre at p + a n, end at p + l n and
/// J = I + m a² about the joint: the rest of the chain at the end takes the force A p″ + b, if p is the end. Then
///     d θ″ = c − h·p″ ,     d = J + l² t·At ,     h = m a t + l A t ,     c = l² ω² t·An − l t·b + τ ,
/// and the chain from the joint on takes the force A₊ p″ + b₊ at p,
///     A₊ = m + A − h hᵀ / d ,     b₊ = b + h c / d − ω² (m a n + l A n) .
/// Gravity is equivalent to an upward acceleration of the pivot.
/// A massless link transmits no force across itself, so that subtraction in A₊ and b₊ would lose all digits. They are
/// stored by components across and along the link, and det A. These are sums of products in which those of a light link
/// do not cancel.
/// Source  Featherstone 2008, Rigid Body Dynamics Algorithms, §7.2, in the plane.
template <class S, int N = Eigen::Dynamic>
class ArticulatedBodies {
public:
    using Scalar = S;
    using Half = State<Scalar, N>;
    using Vector = Planar<Scalar>;

    explicit ArticulatedBodies(const PhysicalPendulum<Scalar>& p)
        : still_(Half::Zero(static_cast<Eigen::Index>(p.chain.links()))) {
        if constexpr (N == Eigen::Dynamic) links_.resize(p.chain.links());
        for (std::size_t i = 0; i < links_.size(); ++i) {
            auto& link = links_[i];
            const Scalar beyond = p.chain.length[i] - p.center[i];
            link.mass = p.chain.mass[i];
            link.length = p.chain.length[i];
            link.inertia = p.inertia[i];
            link.first = link.mass * p.center[i];
            link.second = link.inertia + link.first * p.center[i];
            link.rest = link.inertia - link.first * beyond;
            link.at_end = link.mass * beyond * beyond;
        }
    }

    /// From sines and cosines of θ_1 and the differences θ_k − θ_{k−1}; the sine of a small difference keeps more
    /// digits than a difference of products.
    void factor(const Half& sin, const Half& cos) {
        for (std::size_t i = 0; i < links_.size(); ++i) {
            auto& link = links_[i];
            const Scalar &s = sin[static_cast<Eigen::Index>(i)], &c = cos[static_cast<Eigen::Index>(i)];
            if (i == 0) {
                link.across = {c, s};
            } else {
                auto& above = links_[i - 1];
                above.sin = s;
                above.cos = c;
                link.across = {above.across.x * c - above.across.y * s, above.across.y * c + above.across.x * s};
            }
            link.along = {link.across.y, Scalar(-link.across.x)};
        }
        Matrix a{Scalar(0), Scalar(0), Scalar(0), Scalar(0)};
        for (std::size_t i = links_.size(); i-- > 0;) {
            auto& link = links_[i];
            if (i + 1 < links_.size()) {
                const Scalar &s = link.sin, &c = link.cos;
                const Scalar sc = s * c, ss = s * s, cc = c * c, twice = Scalar(2) * sc * a.mixed;
                a = {a.along * ss + twice + a.across * cc, (a.along - a.across) * sc + a.mixed * (cc - ss),
                     a.along * cc - twice + a.across * ss, a.determinant};
            }
            link.a = a;
            link.h_across = link.first + link.length * a.across;
            link.h_along = link.length * a.mixed;
            link.by_d = Scalar(1) / Scalar(link.second + link.length * link.length * a.across);
            link.carried = (a.along * link.second + link.length * link.length * a.determinant) * link.by_d;
            const Scalar& m = link.mass;
            const Scalar whole = m * (m + a.along + a.across) + a.determinant;  // det (m + A)
            a = {(m * link.inertia + a.across * (link.inertia + link.at_end)) * link.by_d,
                 a.mixed * link.rest * link.by_d, m + link.carried,
                 (link.inertia * whole + link.at_end * (m * a.across + a.determinant)) * link.by_d};
        }
        whole_ = a;
    }

    /// θ″ for torques τ on the links, forces on their ends (none if empty), gravity g, rates ω, and the acceleration of
    /// the pivot. Returns the force of the pivot on the chain, N.
    template <class Rates>
    Vector accelerate(const Half& torque, const std::vector<Vector>& on_ends, const Rates& omega, const Scalar& gravity,
                      const Vector& pivot, Half& alpha) {
        Scalar across(0), along(0);  // b
        for (std::size_t i = links_.size(); i-- > 0;) {
            const auto& link = links_[i];
            const auto k = static_cast<Eigen::Index>(i);
            if (i + 1 < links_.size()) {
                const Scalar turned = link.sin * along + link.cos * across;
                along = link.cos * along - link.sin * across;
                across = turned;
            }
            if (!on_ends.empty()) {
                across -= dot(link.across, on_ends[i]);
                along -= dot(link.along, on_ends[i]);
            }
            const Scalar square = omega[k] * omega[k], l_square = link.length * square;
            const Scalar force_across = across - l_square * link.a.mixed;
            alpha[k] = (torque[k] - link.length * force_across) * link.by_d;
            along += link.h_along * ((torque[k] - link.length * across) * link.by_d) - square * link.first -
                     l_square * link.carried;
            across = (force_across * link.rest + link.h_across * torque[k]) * link.by_d;
        }
        const auto& top = links_[0];
        const Vector lifted{pivot.x, Scalar(pivot.y + gravity)};
        Scalar p_across = dot(top.across, lifted), p_along = dot(top.along, lifted);  // p″
        const Vector force = top.across * Scalar(whole_.across * p_across + whole_.mixed * p_along + across) +
                             top.along * Scalar(whole_.mixed * p_across + whole_.along * p_along + along);
        for (std::size_t i = 0; i < links_.size(); ++i) {
            const auto& link = links_[i];
            const auto k = static_cast<Eigen::Index>(i);
            const Scalar led = alpha[k] - link.h_along * p_along * link.by_d;
            alpha[k] = led - link.h_across * p_across * link.by_d;
            const Scalar end_across = p_across * link.rest * link.by_d + link.length * led;
            const Scalar end_along = p_along - link.length * (omega[k] * omega[k]);
            p_across = link.cos * end_across - link.sin * end_along;
            p_along = link.cos * end_along + link.sin * end_across;
        }
        return force;
    }

    /// a ← M⁻¹ f: rates from momenta f, or accelerations from torques f alone.
    void solve_mass(const Half& f, Half& a) { accelerate(f, {}, still_, Scalar(0), {Scalar(0), Scalar(0)}, a); }

    /// A symmetric 2×2 matrix by its components across and along a link, kg.
    struct Matrix {
        Scalar across, mixed, along, determinant;  // t·At, t·An, n·An
    };
    struct Link {
        Scalar mass, length, inertia, first, second;  // m, l, I, m a, J
        Scalar rest, at_end;                          // J − m a l, m (l − a)²
        Vector along, across;                         // n, t
        Scalar sin{0}, cos{0};                        // of the angle to the next link
        Matrix a;
        Scalar h_across, h_along, by_d;  // of h; 1/d
        Scalar carried;                  // n·A₊n − m
    };
    using Links =
        std::conditional_t<N == Eigen::Dynamic, std::vector<Link>, std::array<Link, N == Eigen::Dynamic ? 0 : N>>;
    const Links& links() const { return links_; }

private:
    Links links_;
    Matrix whole_;  // A₊ of the first link
    Half still_;    // zero rates
};

}  // namespace doppel
