#pragma once

#include "physics/physical_pendulum.hpp"
#include "physics/rod_pulls.hpp"

#include <vector>

namespace doppel {

/// The accelerations of a chain of rigid bodies in O(N), from its end to the pivot and back (the articulated-body method).
///
/// With n = (sinθ, −cosθ) along a link, t = (cosθ, sinθ) across it, joint at p, centre at p + a n, end at p + l n and
/// J = I + m a² about the joint, what hangs at the end takes the force A p″ + b of whatever moves the end. So
///     (J + l² t·At) θ″ = c − h·p″ ,     h = m a t + l A t ,     c = l² ω² t·An − l t·b + τ ,
/// and the whole takes the force A₊ p″ + b₊ at p, with d = J + l² t·At:
///     A₊ = m + A − h hᵀ / d ,     b₊ = b + h c / d − ω² (m a n + l A n) − m g⃗ .
/// Source  Featherstone 2008, Rigid Body Dynamics Algorithms, §7.2, in the plane.
template <class S>
class ArticulatedBodies {
public:
    using Scalar = S;
    using Half = State<Scalar, Eigen::Dynamic>;
    using Vector = Planar<Scalar>;

    explicit ArticulatedBodies(const PhysicalPendulum<Scalar>& p)
        : links_(p.chain.links()), still_(Half::Zero(static_cast<Eigen::Index>(p.chain.links()))) {
        for (std::size_t i = 0; i < links_.size(); ++i) {
            auto& link = links_[i];
            link.mass = p.chain.mass[i];
            link.length = p.chain.length[i];
            link.first = link.mass * p.center[i];
            link.second = p.inertia[i] + link.first * p.center[i];
        }
    }

    /// For the sines and cosines of the angles.
    void factor(const Half& sin, const Half& cos) {
        Scalar xx(0), xy(0), yy(0);  // A
        for (std::size_t i = links_.size(); i-- > 0;) {
            auto& link = links_[i];
            const auto k = static_cast<Eigen::Index>(i);
            link.along = {sin[k], Scalar(-cos[k])};
            link.across = {cos[k], sin[k]};
            const auto times_a = [&](const Vector& v) { return Vector{xx * v.x + xy * v.y, xy * v.x + yy * v.y}; };
            const Vector a_across = times_a(link.across);
            link.a_along = times_a(link.along);
            link.h = link.across * link.first + a_across * link.length;
            link.by_d = Scalar(1) / Scalar(link.second + link.length * link.length * dot(link.across, a_across));
            const Vector h_by_d = link.h * link.by_d;
            xx += link.mass - link.h.x * h_by_d.x;
            xy -= link.h.x * h_by_d.y;
            yy += link.mass - link.h.y * h_by_d.y;
        }
        xx_ = xx, xy_ = xy, yy_ = yy;
    }

    /// θ″ under torques τ on the links, forces on their ends (none where empty), gravity g, at rates ω, where the pivot is
    /// accelerated. Returns the force with which the pivot holds the chain, N.
    template <class Rates>
    Vector accelerate(const Half& torque, const std::vector<Vector>& on_ends, const Rates& omega, const Scalar& gravity,
                      const Vector& pivot, Half& alpha) {
        Vector b{Scalar(0), Scalar(0)};
        for (std::size_t i = links_.size(); i-- > 0;) {
            const auto& link = links_[i];
            const auto k = static_cast<Eigen::Index>(i);
            if (!on_ends.empty()) b = b - on_ends[i];
            const Scalar square = omega[k] * omega[k], l_square = link.length * square;
            const Scalar c = link.length * (l_square * dot(link.across, link.a_along) - dot(link.across, b)) +
                             torque[k] - link.first * gravity * link.along.x;
            alpha[k] = c * link.by_d;
            b = b + link.h * alpha[k] - link.along * Scalar(link.first * square) - link.a_along * l_square;
            b.y += link.mass * gravity;
        }
        Vector p = pivot;
        for (std::size_t i = 0; i < links_.size(); ++i) {
            const auto& link = links_[i];
            const auto k = static_cast<Eigen::Index>(i);
            alpha[k] -= dot(link.h, p) * link.by_d;
            p = p + link.across * Scalar(link.length * alpha[k]) -
                link.along * Scalar(link.length * (omega[k] * omega[k]));
        }
        return {xx_ * pivot.x + xy_ * pivot.y + b.x, xy_ * pivot.x + yy_ * pivot.y + b.y};
    }

    /// a ← M⁻¹ f: the rates that belong to momenta f, or the accelerations by torques f alone.
    void solve_mass(const Half& f, Half& a) { accelerate(f, {}, still_, Scalar(0), {Scalar(0), Scalar(0)}, a); }

    struct Link {
        Scalar mass, length, first, second;  // m, l, m a, J
        Vector along, across, a_along, h;    // n, t, A n, h
        Scalar by_d;                         // 1/d
    };
    const std::vector<Link>& links() const { return links_; }

private:
    std::vector<Link> links_;
    Half still_;  // no rates
    Scalar xx_{0}, xy_{0}, yy_{0};
};

}  // namespace doppel
