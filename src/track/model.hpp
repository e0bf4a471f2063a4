#pragma once

#include "numeric/dual.hpp"
#include "numeric/sin_cos.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string_view>

namespace doppel {

/// What the angles of a double pendulum can tell of it. With
///     A = I1 + m1 a1² + m2 L1²,   B = I2 + m2 a2²,   C = m2 L1 a2,   D1 = (m1 a1 + m2 L1) g,   D2 = m2 a2 g
/// (a: joint to centre of mass, I: about the centre of mass) they tell these over B, never B itself; and what the
/// encoders add.
enum class FitParameter : std::size_t {
    inertia,      // A/B
    coupling,     // C/B
    gravity_1,    // D1/B, 1/s²
    gravity_2,    // D2/B, 1/s²
    viscous_1,    // torque at the pivot per rate, over B, 1/s; ≥ 0, as all friction
    viscous_2,    // at the middle joint
    coulomb_1,    // dry friction at the pivot, over B, 1/s²
    coulomb_2,    // at the middle joint
    quadratic_1,  // drag of the first arm per squared rate, over B
    quadratic_2,  // of the second
    offset_1,     // of the encoders, rad: what they show at rest
    offset_2,
    lag,      // s, by which the second encoder is ahead of the first
    scale_1,  // radians shown for a radian turned
    scale_2,
};
constexpr std::size_t parameter_count = 15, dynamic_count = 10;  // the first ten move the arms, the others read them
using Parameters = std::array<double, parameter_count>;

constexpr std::size_t index_of(FitParameter parameter) {
    return static_cast<std::size_t>(parameter);
}
constexpr bool is_dynamic(FitParameter parameter) {
    return index_of(parameter) < dynamic_count;
}
constexpr bool is_friction(FitParameter parameter) {
    return parameter >= FitParameter::viscous_1 && parameter <= FitParameter::quadratic_2;
}

struct ParameterWords {
    std::string_view key, symbol, unit;
};
inline constexpr std::array<ParameterWords, parameter_count> parameter_words{{
    {"inertia_ratio", "A/B", ""},
    {"coupling_ratio", "C/B", ""},
    {"gravity_1_per_s2", "D1/B", "1/s²"},
    {"gravity_2_per_s2", "D2/B", "1/s²"},
    {"viscous_1_per_s", "b1/B", "1/s"},
    {"viscous_2_per_s", "b2/B", "1/s"},
    {"coulomb_1_per_s2", "c1/B", "1/s²"},
    {"coulomb_2_per_s2", "c2/B", "1/s²"},
    {"quadratic_1", "k1/B", ""},
    {"quadratic_2", "k2/B", ""},
    {"offset_1_rad", "offset 1", "rad"},
    {"offset_2_rad", "offset 2", "rad"},
    {"lag_s", "lag", "s"},
    {"scale_1", "scale 1", ""},
    {"scale_2", "scale 2", ""},
}};
constexpr const ParameterWords& words_of(FitParameter parameter) {
    return parameter_words[index_of(parameter)];
}

/// On which speed the quadratic drag of the second arm acts.
enum class Drag {
    own,      // its own rate ω2, as if the middle joint stood still
    carried,  // what its air meets: u = ω2 + (C/B) cos(θ1 − θ2) ω1, the joint's motion added
};

/// How dry friction turns over where a joint does.
enum class DryLaw {
    smooth,  // within some degrees a second
    sharp,   // at once: c sign(ω), and a joint that has come to rest stays where c holds it, as `simulate` has it
};
inline constexpr double coulomb_width_deg_per_s = 5, coulomb_width = coulomb_width_deg_per_s * std::numbers::pi / 180;

template <class Scalar>
using ArmState = std::array<Scalar, 4>;  // θ1, θ2 from the downward vertical, rad; ω1, ω2, rad/s

/// Two stiff bodies on joints with friction, in a vertical plane, divided by B.
///
///     A θ1″ + C cosδ θ2″ + C sinδ ω2² + D1 sinθ1 = −Q1,   δ = θ1 − θ2
///     θ2″ + C cosδ θ1″ − C sinδ ω1² + D2 sinθ2 = −Q2
///     Q1 = j1 − j2 + k1 |ω1| ω1 [+ C cosδ k2 |u| u],   Q2 = j2 + k2 |u| u,   u = ω2, or of drag that is carried as above
///     j = b ω + c f(ω/width),   f(x) = x/√(1 + x²),   with the joint's own rate, ω1 or ω2 − ω1
///
/// Of the sharp law f is the joint's mode, ±1 or 0, until the next event (fit/flow.hpp): at 0 the joint is held.
///
/// Source  Landau & Lifshitz, Mechanics, §5 problem 1 and §25; the carried drag: a point of the second arm at the
///         distance B/(m2 a2) of its centre of oscillation moves through the air with that distance times u.
template <class Scalar>
struct Arms {
    std::array<Scalar, dynamic_count> p;
    Drag drag = Drag::own;
    bool has_friction = true;
    DryLaw dry = DryLaw::smooth;
    std::array<int, 2> modes{1, 1};  // of the sharp law: signs of the joints' rates, 0 where one is held

    /// The modes of joints that turn as in this state.
    void take_modes(double w1, double w2) { modes = {w1 < 0 ? -1 : 1, w2 < w1 ? -1 : 1}; }
    bool is_sharp() const { return has_friction && dry == DryLaw::sharp; }
    bool is_held(std::size_t joint) const { return is_sharp() && modes[joint] == 0; }

    ArmState<Scalar> rate(const ArmState<Scalar>& y) const {
        const auto [r1, r2, cosine] = sides(y);
        const auto alpha = accelerations(r1, r2, cosine);
        return {y[2], y[3], alpha[0], alpha[1]};
    }

    /// The torques over B that hold the held joints, > 0 against a joint that would turn forwards.
    std::array<Scalar, 2> holding(const ArmState<Scalar>& y) const {
        const auto [r1, r2, cosine] = sides(y);
        const auto alpha = accelerations(r1, r2, cosine);
        const Scalar middle = r2 - cosine * alpha[0] - alpha[1];
        return {Scalar(r1 - p[index_of(FitParameter::inertia)] * alpha[0] - cosine * alpha[1] + middle), middle};
    }

private:
    /// Both right sides, and the factor of the other arm's acceleration on both left.
    struct Sides {
        Scalar r1, r2, cosine;
    };
    Sides sides(const ArmState<Scalar>& y) const {
        const auto of = [&](FitParameter parameter) -> const Scalar& { return p[index_of(parameter)]; };
        const Scalar &w1 = y[2], &w2 = y[3];
        const SinCos<Scalar> between(Scalar(y[0] - y[1])), first(y[0]), second(y[1]);
        const Scalar cosine = of(FitParameter::coupling) * between.cos, sine = of(FitParameter::coupling) * between.sin;
        Scalar r1 = -sine * (w2 * w2) - of(FitParameter::gravity_1) * first.sin;
        Scalar r2 = sine * (w1 * w1) - of(FitParameter::gravity_2) * second.sin;
        if (has_friction) add_friction(w1, w2, cosine, r1, r2);
        return {r1, r2, cosine};
    }

    /// Of A α1 + cosine α2 = r1 + torques that hold joints, cosine α1 + α2 = r2 + such.
    std::array<Scalar, 2> accelerations(const Scalar& r1, const Scalar& r2, const Scalar& cosine) const {
        const Scalar& a = p[index_of(FitParameter::inertia)];
        if (is_held(0)) return {Scalar(0), is_held(1) ? Scalar(0) : r2};
        if (is_held(1)) {
            const Scalar together = (r1 + r2) / (a + Scalar(2) * cosine + Scalar(1));
            return {together, together};
        }
        const Scalar inverse = Scalar(1) / (a - cosine * cosine);
        return {Scalar((r1 - cosine * r2) * inverse), Scalar((a * r2 - cosine * r1) * inverse)};
    }

    void add_friction(const Scalar& w1, const Scalar& w2, const Scalar& cosine, Scalar& r1, Scalar& r2) const {
        using std::abs;
        const auto of = [&](FitParameter parameter) -> const Scalar& { return p[index_of(parameter)]; };
        const Scalar pivot = joint(0, w1, of(FitParameter::viscous_1), of(FitParameter::coulomb_1));
        const Scalar middle = joint(1, Scalar(w2 - w1), of(FitParameter::viscous_2), of(FitParameter::coulomb_2));
        r1 += middle - pivot - of(FitParameter::quadratic_1) * (abs(w1) * w1);
        r2 -= middle;
        if (drag == Drag::own) {
            r2 -= of(FitParameter::quadratic_2) * (abs(w2) * w2);
        } else {
            const Scalar u = w2 + cosine * w1, torque = of(FitParameter::quadratic_2) * (abs(u) * u);
            r1 -= cosine * torque;
            r2 -= torque;
        }
    }

    Scalar joint(std::size_t number, const Scalar& rate, const Scalar& viscous, const Scalar& coulomb) const {
        using std::sqrt;
        if (dry == DryLaw::sharp) return viscous * rate + coulomb * Scalar(modes[number]);
        const Scalar x = rate * Scalar(1 / coulomb_width);
        return viscous * rate + coulomb * (x / sqrt(Scalar(Scalar(1) + x * x)));
    }
};

}  // namespace doppel
