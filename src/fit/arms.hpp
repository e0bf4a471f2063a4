#pragma once

#include "fit/parameters.hpp"
#include "numeric/dual.hpp"
#include "numeric/sin_cos.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace doppel {

template <class Scalar>
using ArmState = std::array<Scalar, 4>;  // θ1, θ2 from the downward vertical, rad; ω1, ω2, rad/s

/// The value alone of a number that may carry derivatives.
template <class Scalar>
double value_of(const Scalar& x) {
    if constexpr (requires { x.tangent; })
        return x.value;
    else
        return x;
}

/// Two rigid bodies on joints with friction, in a vertical plane, divided by B.
///
///     A θ1″ + C cosδ θ2″ + C sinδ ω2² + D1 sinθ1 = −Q1,   δ = θ1 − θ2
///     θ2″ + C cosδ θ1″ − C sinδ ω1² + D2 sinθ2 = −Q2
///     Q1 = j1 − j2 + k1 |ω1| ω1 [+ C cosδ k2 |u| u],   Q2 = j2 + k2 |u| u,   u = ω2, or of drag that is carried (Drag)
///     j = b ω + c s,   with the joint's own rate ω, ω1 or ω2 − ω1
///
/// s is the joint's mode, the sign of its rate, until the next event (fit/flow.hpp): at 0 the joint is held.
///
/// Source  Landau & Lifshitz, Mechanics, §5 problem 1 and §25; the carried drag: a point of the second arm at the
///         distance B/(m2 a2) of its centre of oscillation moves through the air with that distance times u.
template <class Scalar>
struct Arms {
    std::array<Scalar, dynamic_count> p;
    Drag drag = Drag::own;
    bool has_friction = true, has_coulomb = true;
    std::array<int, 2> modes{1, 1};

    /// The same in numbers with derivatives, which are 0, or without.
    template <class To>
    Arms<To> cast() const {
        Arms<To> to{.p = {}, .drag = drag, .has_friction = has_friction, .has_coulomb = has_coulomb};
        std::transform(p.begin(), p.end(), to.p.begin(), [](const Scalar& x) { return To(value_of(x)); });
        return to;
    }
    /// The modes of joints that turn as in this state.
    void take_modes(const ArmState<double>& y) { modes = {y[2] < 0 ? -1 : 1, y[3] < y[2] ? -1 : 1}; }
    bool is_held(std::size_t joint) const { return has_coulomb && modes[joint] == 0; }

    ArmState<Scalar> rate(const ArmState<Scalar>& y) const {
        const auto alpha = accelerations(sides(y));
        return {y[2], y[3], alpha[0], alpha[1]};
    }

    /// 0 or more while the joint keeps to its mode.
    double margin(std::size_t joint, const ArmState<double>& y) const requires std::same_as<Scalar, double> {
        if (modes[joint] == 0) return most_held(joint) - std::abs(holding(y)[joint]);
        return modes[joint] * (joint == 0 ? y[2] : y[3] - y[2]);
    }
    /// The mode in which a joint goes on that had an event: whether it was held before matters.
    void settle(std::size_t joint, ArmState<double> y) requires std::same_as<Scalar, double> {
        const bool was_held = std::exchange(modes[joint], 0) == 0;
        y[joint + 2] = joint == 0 ? 0 : y[2];
        if (is_held(1)) y[3] = y[2];
        const double torque = holding(y)[joint];
        if (was_held || std::abs(torque) > most_held(joint)) modes[joint] = torque < 0 ? -1 : 1;
    }

private:
    /// Both right sides, and the factor of the other arm's acceleration on both left.
    struct Sides {
        Scalar r1, r2, cosine;
    };
    const Scalar& of(FitParameter parameter) const { return p[index_of(parameter)]; }

    Sides sides(const ArmState<Scalar>& y) const {
        using enum FitParameter;
        const Scalar &w1 = y[2], &w2 = y[3];
        const SinCos<Scalar> between(Scalar(y[0] - y[1])), first(y[0]), second(y[1]);
        const Scalar cosine = of(coupling) * between.cos, sine = of(coupling) * between.sin;
        Sides result{-sine * (w2 * w2) - of(gravity_1) * first.sin, sine * (w1 * w1) - of(gravity_2) * second.sin,
                     cosine};
        if (has_friction) add_friction(w1, w2, result);
        return result;
    }

    void add_friction(const Scalar& w1, const Scalar& w2, Sides& to) const {
        using enum FitParameter;
        using std::abs;
        const Scalar between = w2 - w1;
        Scalar pivot = of(viscous_1) * w1, middle = of(viscous_2) * between;
        if (has_coulomb) pivot += modes[0] * of(coulomb_1), middle += modes[1] * of(coulomb_2);
        const Scalar u = drag == Drag::own ? w2 : Scalar(w2 + to.cosine * w1), torque = of(quadratic_2) * (abs(u) * u);
        to.r1 += middle - pivot - of(quadratic_1) * (abs(w1) * w1);
        to.r2 -= middle + torque;
        if (drag == Drag::carried) to.r1 -= to.cosine * torque;
    }

    /// Of A α1 + cosine α2 = r1 + torques that hold joints, cosine α1 + α2 = r2 + such.
    std::array<Scalar, 2> accelerations(const Sides& of_arms) const {
        const auto& [r1, r2, cosine] = of_arms;
        const Scalar& a = of(FitParameter::inertia);
        if (is_held(0)) return {Scalar(0), is_held(1) ? Scalar(0) : r2};
        if (is_held(1)) {
            const Scalar together = (r1 + r2) / (a + cosine + cosine + Scalar(1));
            return {together, together};
        }
        const Scalar inverse = Scalar(1) / (a - cosine * cosine);
        return {Scalar((r1 - cosine * r2) * inverse), Scalar((a * r2 - cosine * r1) * inverse)};
    }

    /// The torques over B that hold the held joints, > 0 against a joint that would turn forwards.
    std::array<double, 2> holding(const ArmState<double>& y) const requires std::same_as<Scalar, double> {
        const auto right = sides(y);
        const auto alpha = accelerations(right);
        const double middle = right.r2 - right.cosine * alpha[0] - alpha[1];
        return {right.r1 - of(FitParameter::inertia) * alpha[0] - right.cosine * alpha[1] + middle, middle};
    }
    double most_held(std::size_t joint) const {
        constexpr double rounding = 1e-12;
        return value_of(p[index_of(FitParameter::coulomb_1) + joint]) * (1 + rounding);
    }
};

inline Arms<double> arms_of(const ModelSpec& model, const Parameters& parameters) {
    const auto all = completed(model, parameters);
    const auto has_any = [&](FitParameter first, FitParameter last) {
        for (auto k = index_of(first); k <= index_of(last); ++k)
            if (all[k] != 0 || model.fits(static_cast<FitParameter>(k))) return true;
        return false;
    };
    using enum FitParameter;
    Arms<double> arms{.p = {},
                      .drag = model.drag,
                      .has_friction = has_any(viscous_1, quadratic_2),
                      .has_coulomb = has_any(coulomb_1, coulomb_2)};
    std::copy_n(all.begin(), dynamic_count, arms.p.begin());
    return arms;
}

}  // namespace doppel
