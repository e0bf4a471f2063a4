#pragma once

#include "base/error.hpp"
#include "physics/angle_chain.hpp"
#include "physics/physical_chain.hpp"

#include <limits>
#include <vector>

namespace doppel {

/// Sine and cosine of an angle that is evaluated repeatedly with small changes, as in an iteration. Near the angle a of
/// the last full evaluation they are rotated by the small angle d,
///     sin(a + d) = sin a + (cos d − 1) sin a + sin d cos a ,
///     cos(a + d) = cos a + (cos d − 1) cos a − sin d sin a ,
/// with Taylor sums up to d⁵ and d⁶. The limit of d makes d⁷/7! far smaller than rounding. This error is systematic:
/// with a limit of ε/16 it already made the energy drift by 4e-17 J per second, instead of a random walk.
template <class Scalar>
class CachedSinCos {
public:
    SinCos<Scalar> at(const Scalar& angle) {
        const Scalar d = angle - angle_;
        if (!(d < reach && -d < reach)) {
            angle_ = angle;
            return exact_ = SinCos<Scalar>(angle);
        }
        const Scalar d2 = d * d;
        const Scalar s = d - d * d2 * (sixth - d2 * (sixth * twentieth));
        const Scalar v = d2 * (half - d2 * (half * twelfth - d2 * (half * twelfth * thirtieth)));
        SinCos<Scalar> turned = exact_;
        turned.sin += exact_.cos * s - exact_.sin * v;
        turned.cos -= exact_.sin * s + exact_.cos * v;
        return turned;
    }

private:
    static Scalar part(int n) { return Scalar(1) / Scalar(n); }
    /// The limit of d: d⁷/7! = 10⁻⁹ ε.
    static Scalar largest_angle() {
        using std::pow;
        return pow(Scalar(5040) / Scalar(1'000'000'000) * std::numeric_limits<Scalar>::epsilon(), part(7));
    }
    inline static const Scalar half = part(2), sixth = part(6), twelfth = part(12), twentieth = part(20),
                               thirtieth = part(30), reach = largest_angle();

    Scalar angle_ = Scalar(0);
    SinCos<Scalar> exact_{angle_};
};

/// The Hamiltonian form of a model in angles: y = (θ, ω) becomes z = (θ, p), p = ∂L/∂ω in N m s, with
///     θ′ = ∂H/∂p = M⁻¹ p ,     p′ = −∂H/∂θ = ∂L/∂θ .
/// Symplectic methods are symplectic in these variables, not in (θ, ω). There is one specialisation for each model.
template <class Model>
struct Canonical;

template <class M>
concept Hamiltonian = requires(M& model, Canonical<M> form, typename Canonical<M>::Angles angles,
                               const typename M::State& from, typename M::State& to) {
    Canonical<M>(model);
    form.momenta(from, to);       // (θ, ω) → (θ, p)
    form.velocities(from, to);    // (θ, p) → (θ, ω)
    form.rate(from, angles, to);  // (θ, p) → (θ′, p′); each series of calls has its own memory in `angles`
};

/// With P_i = Σ_{k≥i} m_k v_k the momentum of all below rod i, μ_i its mass, n = (sinθ, −cosθ) along the rod,
/// t = (cosθ, sinθ) across it and dt/dθ = −n:
///     p_i = l_i t_i·P_i ,     p_i′ = −l_i ω_i n_i·P_i − g l_i μ_i sinθ_i .
/// The model's solve_mass() computes ω and n_i·P_i together, in O(N).
template <class S, int N>
struct Canonical<AngleChain<S, N>> {
    using Scalar = S;
    using Model = AngleChain<S, N>;
    using State = typename Model::State;
    using Half = typename Model::Half;
    struct Angles {};

    Model& model;
    Half mass;          // μ, kg
    Half p, omega;      // N m s, rad/s
    Half sin, cos;      // of the angles
    Half above, below;  // m/s and N s: of the velocities v, of the momenta P, by component

    explicit Canonical(Model& chain)
        : model(chain),
          mass(chain.w),
          p(chain.w),
          omega(chain.w),
          sin(chain.w),
          cos(chain.w),
          above(chain.w),
          below(chain.w) {
        Scalar sum(0);
        for (Eigen::Index k = mass.size() - 1; k >= 0; --k) mass[k] = sum += chain.pendulum.mass[at(k)];
    }

    void momenta(const State& y, State& z) {
        const auto n = mass.size();
        update(y);
        z.head(n) = y.head(n);
        z.tail(n).setZero();
        for (const Half* t : {&cos, &sin}) {
            Scalar v(0), sum(0);
            for (Eigen::Index k = 0; k < n; ++k) above[k] = v += length(k) * y[n + k] * (*t)[k];
            for (Eigen::Index k = n - 1; k >= 0; --k) {
                sum += model.pendulum.mass[at(k)] * above[k];
                z[n + k] += length(k) * (*t)[k] * sum;
            }
        }
    }

    void velocities(const State& z, State& y) {
        const auto n = mass.size();
        solve(z);
        y.head(n) = z.head(n);
        y.tail(n) = omega;
    }

    void rate(const State& z, Angles&, State& dzdt) {
        const auto n = mass.size();
        solve(z);
        for (Eigen::Index k = 0; k < n; ++k) {
            dzdt[k] = omega[k];
            dzdt[n + k] = -length(k) * (omega[k] * model.tension[k] + model.pendulum.gravity * mass[k] * sin[k]);
        }
    }

private:
    static std::size_t at(Eigen::Index k) { return static_cast<std::size_t>(k); }
    const Scalar& length(Eigen::Index k) const { return model.pendulum.length[at(k)]; }

    void update(const State& y) {
        model.update(y);
        sin[0] = model.sin[0];
        cos[0] = model.cos[0];
        for (Eigen::Index k = 1; k < mass.size(); ++k) {
            sin[k] = sin[k - 1] * model.cos[k] + cos[k - 1] * model.sin[k];
            cos[k] = cos[k - 1] * model.cos[k] - sin[k - 1] * model.sin[k];
        }
    }

    void solve(const State& z) {
        update(z);
        p = z.tail(mass.size());
        model.solve_mass(p, omega);
    }
};

/// With D = θ1 − θ2, m = m1 + m2 and n = m1 + m2 sin²D:
///     p1 = l1 (m l1 ω1 + m2 l2 ω2 cosD)        ω1 = (p1 / l1 − p2 / l2 cosD) / (l1 n)
///     p2 = m2 l2 (l2 ω2 + l1 ω1 cosD)          ω2 = (m / m2 p2 / l2 − p1 / l1 cosD) / (l2 n)
///     p1′ = −m2 l1 l2 ω1 ω2 sinD − m g l1 sinθ1 ,     p2′ = m2 l1 l2 ω1 ω2 sinD − m2 g l2 sinθ2
template <class S>
struct Canonical<DoublePendulum<S>> {
    using Scalar = S;
    using Model = DoublePendulum<S>;
    using State = typename Model::State;
    struct Angles {
        CachedSinCos<Scalar> one, two;
    };

    explicit Canonical(const Model& d)
        : m1_(d.m1),
          m2_(d.m2),
          l1_(d.l1),
          l2_(d.l2),
          ratio_((d.m1 + d.m2) / d.m2),
          inverse_l1_(Scalar(1) / d.l1),
          inverse_l2_(Scalar(1) / d.l2),
          coupling_(d.m2 * d.l1 * d.l2),
          weight1_((d.m1 + d.m2) * d.g * d.l1),
          weight2_(d.m2 * d.g * d.l2) {}

    void momenta(const State& y, State& z) const {
        const Scalar c = SinCos<Scalar>(Scalar(y[0] - y[1])).cos;
        const Scalar v1 = l1_ * y[2], v2 = l2_ * y[3];
        z << y[0], y[1], l1_ * ((m1_ + m2_) * v1 + m2_ * v2 * c), m2_ * l2_ * (v2 + v1 * c);
    }

    void velocities(const State& z, State& y) const {
        Angles angles;
        State dzdt(4);
        rate(z, angles, dzdt);
        y << z[0], z[1], dzdt[0], dzdt[1];
    }

    void rate(const State& z, Angles& angles, State& dzdt) const {
        const SinCos<Scalar> one = angles.one.at(z[0]), two = angles.two.at(z[1]);
        const Scalar s = one.sin * two.cos - one.cos * two.sin;
        const Scalar c = one.cos * two.cos + one.sin * two.sin;
        const Scalar inverse_n = Scalar(1) / (m1_ + m2_ * s * s);
        const Scalar u1 = z[2] * inverse_l1_, u2 = z[3] * inverse_l2_;
        const Scalar w1 = (u1 - u2 * c) * inverse_n * inverse_l1_;
        const Scalar w2 = (ratio_ * u2 - u1 * c) * inverse_n * inverse_l2_;
        const Scalar twist = coupling_ * w1 * w2 * s;
        dzdt << w1, w2, -twist - weight1_ * one.sin, twist - weight2_ * two.sin;
    }

private:
    Scalar m1_, m2_, l1_, l2_;
    Scalar ratio_;                    // (m1 + m2) / m2
    Scalar inverse_l1_, inverse_l2_;  // 1/m
    Scalar coupling_;                 // m2 l1 l2, kg m²
    Scalar weight1_, weight2_;        // (m1 + m2) g l1 and m2 g l2, J
};

/// The Hamiltonian form of rigid bodies, with the joint of link i at j_i, P_i the momentum of link i and all below, and
/// S_i = m_i a_i + l_i Σ_{k>i} m_k:
///     p_i  = (I_i + m_i a_i²) ω_i + t_i·(m_i a_i j_i′ + l_i P_{i+1}) = Σ_k M_ik ω_k + S_i t_i·j_1′
///     p_i′ = −ω_i n_i·(m_i a_i j_i′ + l_i P_{i+1}) − g S_i sinθ_i + Q_i
/// Q_i is the torque on the link plus l_i t_i·(Σ_{k≥i} drag_k). j_1′ is the velocity of the pivot, a function of time.
/// Time and work are as in (θ, ω). Without friction the flow is symplectic in (θ, p); with friction methods are of
/// their order.
/// Errors  exit 2 with Coulomb friction, whose joints come to rest at the end of steps.
template <class S>
struct Canonical<PhysicalChain<S>> {
    using Scalar = S;
    using Model = PhysicalChain<S>;
    using State = typename Model::State;
    using Half = typename Model::Half;
    using Vector = Planar<Scalar>;
    struct Angles {};

    Model& model;
    Half first;                       // S, kg m
    Half p, omega;                    // N m s, rad/s
    std::vector<Vector> joint, push;  // m/s: velocity of each link's joint; N s: m a j′ + l P_{i+1}

    explicit Canonical(Model& chain)
        : model(chain),
          first(Half::Zero(chain.layout.coordinates)),
          p(first),
          omega(first),
          joint(chain.bodies().size(), Vector{Scalar(0), Scalar(0)}),
          push(joint) {
        if (!chain.pendulum.friction.coulomb.empty())
            throw bad_input("Gauss collocation does not support Coulomb friction; choose another method");
        Scalar below(0);
        for (std::size_t i = joint.size(); i-- > 0;) {
            const auto& link = chain.bodies()[i];
            first[row(i)] = link.first + link.length * below;
            below += link.mass;
        }
    }

    void momenta(const State& y, State& z) {
        const auto n = model.layout.coordinates, half = model.layout.half;
        model.take_angles(y);
        omega = y.segment(half, n);
        take_momenta(pivot_at(y).velocity);
        z = y;
        for (std::size_t i = 0; i < joint.size(); ++i) {
            const auto& link = model.bodies()[i];
            z[half + row(i)] = link.second * omega[row(i)] + dot(link.across, push[i]);
        }
    }

    void velocities(const State& z, State& y) {
        solve(z, pivot_at(z).velocity);
        y = z;
        y.segment(model.layout.half, model.layout.coordinates) = omega;
    }

    void rate(const State& z, Angles&, State& dzdt) {
        const auto half = model.layout.half;
        const auto pivot = pivot_at(z);
        solve(z, pivot.velocity);
        take_momenta(pivot.velocity);
        const auto& forces = model.forces_at(omega, model.layout.time_of(z), pivot.velocity);
        Vector drag{Scalar(0), Scalar(0)};
        for (std::size_t i = joint.size(); i-- > 0;) {
            const auto& link = model.bodies()[i];
            const auto k = row(i);
            dzdt[k] = omega[k];
            dzdt[half + k] = forces.torque[k] - (omega[k] * dot(link.along, push[i]) +
                                                 model.pendulum.chain.gravity * first[k] * link.along.x);
            if (forces.drag.empty()) continue;
            drag = drag + forces.drag[i];
            dzdt[half + k] += link.length * dot(link.across, drag);
        }
        Scalar power = forces.power;
        if (model.pendulum.pivot.moves()) power += dot(model.pivot_force(pivot.acceleration), pivot.velocity);
        model.layout.rate(z, power, dzdt);
    }

private:
    static Eigen::Index row(std::size_t i) { return static_cast<Eigen::Index>(i); }

    PivotPlace<Scalar> pivot_at(const State& z) const { return {model.pendulum.pivot, model.layout.time_of(z)}; }

    /// ω
    void solve(const State& z, const Vector& pivot_velocity) {
        model.take_angles(z);
        p = z.segment(model.layout.half, model.layout.coordinates);
        if (model.pendulum.pivot.moves())
            for (std::size_t i = 0; i < joint.size(); ++i)
                p[row(i)] -= first[row(i)] * dot(model.bodies()[i].across, pivot_velocity);
        model.solve_mass(p, omega);
    }

    /// Computes joint and push from ω.
    void take_momenta(const Vector& pivot_velocity) {
        Vector v = pivot_velocity;
        for (std::size_t i = 0; i < joint.size(); ++i) {
            const auto& link = model.bodies()[i];
            joint[i] = v;
            v = v + link.across * Scalar(link.length * omega[row(i)]);
        }
        Vector below{Scalar(0), Scalar(0)};  // P_{i+1}
        for (std::size_t i = joint.size(); i-- > 0;) {
            const auto& link = model.bodies()[i];
            push[i] = joint[i] * link.first + below * link.length;
            below = below + joint[i] * link.mass + link.across * Scalar(link.first * omega[row(i)]);
        }
    }
};

}  // namespace doppel
