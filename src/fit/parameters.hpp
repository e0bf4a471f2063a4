#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

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
    coulomb_1,    // Coulomb friction at the pivot, over B, 1/s²
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
    {"offset_1_rad", "offset 1", "rad"},
    {"offset_2_rad", "offset 2", "rad"},
    {"lag_s", "lag", "s"},
    {"scale_1", "scale 1", ""},
    {"scale_2", "scale 2", ""},
}};
constexpr const ParameterWords& words_of(FitParameter parameter) {
    return parameter_words[index_of(parameter)];
}

/// On which speed the quadratic drag of the second arm acts.
enum class Drag {
    own,      // its own rate ω2, as if the middle joint stood still
    carried,  // relative to the air: u = ω2 + (C/B) cos(θ1 − θ2) ω1, the joint's motion added
};

/// Which numbers of a model are fitted, and what it is like otherwise.
struct ModelSpec {
    bool point_masses = false;  // then D1 = A D2/C, and gravity_1 is not among `fitted`
    Drag drag = Drag::own;
    std::vector<FitParameter> fitted;  // those that move the arms first
    bool may_gain = false;             // friction may be negative

    /// Whether it is friction that must not be negative.
    bool is_bounded(FitParameter parameter) const { return is_friction(parameter) && !may_gain; }
    bool fits(FitParameter parameter) const {
        for (const auto one : fitted)
            if (one == parameter) return true;
        return false;
    }
};

/// The parameters with those that follow from others.
inline Parameters completed(const ModelSpec& model, Parameters parameters) {
    using enum FitParameter;
    const auto of = [&](FitParameter parameter) -> double& { return parameters[index_of(parameter)]; };
    if (model.point_masses) of(gravity_1) = of(inertia) * of(gravity_2) / of(coupling);
    return parameters;
}

}  // namespace doppel
