#pragma once

#include "numeric/dual.hpp"
#include "numeric/sin_cos.hpp"

#include <Eigen/Core>

#include <array>
#include <bitset>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace doppel {

/// The quantities of a double pendulum that its angles determine. With
///     A = I1 + m1 a1² + m2 L1²,   B = I2 + m2 a2²,   C = m2 L1 a2,   D1 = (m1 a1 + m2 L1) g,   D2 = m2 a2 g
/// (a: joint to centre of mass, I: about the centre of mass), the angles determine these divided by B, but not B
/// itself; also the errors of the encoders. Values are indices into Parameters.
enum FitParameter : std::size_t {
    inertia,      // A/B
    coupling,     // C/B
    gravity_1,    // D1/B, 1/s²
    gravity_2,    // D2/B, 1/s²
    viscous_1,    // torque at the pivot per rate, over B, 1/s; ≥ 0, as for all friction
    viscous_2,    // at the middle joint
    coulomb_1,    // Coulomb friction at the pivot, over B, 1/s²
    coulomb_2,    // at the middle joint
    quadratic_1,  // drag of the first link per squared rate, over B
    quadratic_2,  // of the second
    offset_1,     // of the encoders, rad: their reading at rest
    offset_2,
    lag,      // s, the time by which the second encoder is ahead of the first
    scale_1,  // measured radians per radian
    scale_2,
    parameter_count,
    dynamic_count = offset_1  // parameters before this affect the motion, the others its measurement
};
using Parameters = Eigen::Matrix<double, parameter_count, 1>;

constexpr bool is_friction(std::size_t parameter) {
    return parameter >= viscous_1 && parameter <= quadratic_2;
}

struct ParameterWords {
    std::string_view key, symbol, unit;
};
inline constexpr std::array<ParameterWords, parameter_count> parameter_words{{
    {"inertia_ratio", "A/B", ""},
    {"coupling_ratio", "C/B", ""},
    {"gravity_1_per_s2", "D1/B", " 1/s²"},
    {"gravity_2_per_s2", "D2/B", " 1/s²"},
    {"viscous_1_per_s", "b1/B", " 1/s"},
    {"viscous_2_per_s", "b2/B", " 1/s"},
    {"coulomb_1_per_s2", "c1/B", " 1/s²"},
    {"coulomb_2_per_s2", "c2/B", " 1/s²"},
    {"quadratic_1", "k1/B", ""},
    {"quadratic_2", "k2/B", ""},
    {"offset_1_rad", "offset 1", " rad"},
    {"offset_2_rad", "offset 2", " rad"},
    {"lag_s", "lag", " s"},
    {"scale_1", "scale 1", ""},
    {"scale_2", "scale 2", ""},
}};

/// The velocity that determines the quadratic drag of the second link.
enum class Drag {
    own,      // its own rate ω2, without the motion of the middle joint
    carried,  // relative to the air: u = ω2 + (C/B) cos(θ1 − θ2) ω1, including the motion of the joint
};

/// The parameters of a model that are fitted, and its options.
struct ModelSpec {
    bool point_masses = false;  // then D1 = A D2/C, and gravity_1 is not among `fitted`
    Drag drag = Drag::own;
    std::bitset<parameter_count> fitted;
    bool may_gain = false;  // friction may be negative

    /// The fitted parameters in order.
    std::vector<std::size_t> list() const {
        std::vector<std::size_t> all;
        for (std::size_t k = 0; k < parameter_count; ++k)
            if (fitted[k]) all.push_back(k);
        return all;
    }
};

/// The model with `friction`: 0 none, 1 viscous, 2 also Coulomb, 3 also quadratic drag; and `reading`: 0 offsets, 1
/// also a lag, 2 also scales.
ModelSpec model_of(bool point, int friction, Drag drag = Drag::own, int reading = 0);

using LinkState = Eigen::Vector4d;  // θ1, θ2 from the downward vertical, rad; ω1, ω2, rad/s

/// Two rigid bodies on joints with friction, in a vertical plane; all divided by B.
///
///     A θ1″ + C cosδ θ2″ + C sinδ ω2² + D1 sinθ1 = −Q1,   δ = θ1 − θ2
///     θ2″ + C cosδ θ1″ − C sinδ ω1² + D2 sinθ2 = −Q2
///     Q1 = j1 − j2 + k1 |ω1| ω1 [+ C cosδ k2 |u| u],   Q2 = j2 + k2 |u| u,   u = ω2, or that of Drag::carried
///     j = b ω + c s,   with the rate ω of the joint, ω1 or ω2 − ω1
///
/// s is the mode of the joint, the sign of its rate, until the next event (fit/flow.hpp); at 0 the joint is held.
///
/// Source  Landau & Lifshitz, Mechanics, §5 problem 1 and §25; Drag::carried: the centre of oscillation of the second
///         link, B/(m2 a2) from its joint, moves through the air with that distance times u.
template <class Scalar>
struct LinkPair {
    std::array<Scalar, dynamic_count> p;
    Drag drag = Drag::own;
    bool has_coulomb = false;
    std::array<int, 2> modes{1, 1};

    /// The right sides of both equations, and the factor of the other link's acceleration on both left sides.
    struct Sides {
        Scalar r1, r2, cosine;
    };

    Sides sides(const Scalar& angle_1, const Scalar& angle_2, const Scalar& w1, const Scalar& w2) const {
        const SinCos<Scalar> between(Scalar(angle_1 - angle_2)), first(angle_1), second(angle_2);
        const Scalar cosine = p[coupling] * between.cos, sine = p[coupling] * between.sin;
        Sides to{-sine * (w2 * w2) - p[gravity_1] * first.sin, sine * (w1 * w1) - p[gravity_2] * second.sin, cosine};
        using std::abs;
        const Scalar relative = w2 - w1;
        Scalar pivot = p[viscous_1] * w1, middle = p[viscous_2] * relative;
        if (has_coulomb) pivot += modes[0] * p[coulomb_1], middle += modes[1] * p[coulomb_2];
        const Scalar u = drag == Drag::own ? w2 : Scalar(w2 + cosine * w1), torque = p[quadratic_2] * (abs(u) * u);
        to.r1 += middle - pivot - p[quadratic_1] * (abs(w1) * w1);
        to.r2 -= middle + torque;
        if (drag == Drag::carried) to.r1 -= cosine * torque;
        return to;
    }

    /// The solution of A α1 + cosine α2 = r1 + torque holding a joint, cosine α1 + α2 = r2 + such a torque.
    std::array<Scalar, 2> accelerations(const Sides& of_links) const {
        const auto& [r1, r2, cosine] = of_links;
        if (is_held(0)) return {Scalar(0), is_held(1) ? Scalar(0) : r2};
        if (is_held(1)) {
            const Scalar together = (r1 + r2) / (p[inertia] + cosine + cosine + Scalar(1));
            return {together, together};
        }
        const Scalar inverse = Scalar(1) / (p[inertia] - cosine * cosine);
        return {Scalar((r1 - cosine * r2) * inverse), Scalar((p[inertia] * r2 - cosine * r1) * inverse)};
    }

    bool is_held(std::size_t joint) const { return has_coulomb && modes[joint] == 0; }
};

/// The links of a model. The derivative by a fitted parameter is in direction 4 + its number, if that is carried.
template <class Scalar>
LinkPair<Scalar> link_pair_of(const ModelSpec& model, const Parameters& parameters) {
    LinkPair<Scalar> links{.p = {}, .drag = model.drag};
    for (std::size_t k = 0; k < dynamic_count; ++k) {
        links.p[k] = Scalar(parameters[k]);
        links.has_coulomb |= (k == coulomb_1 || k == coulomb_2) && (parameters[k] != 0 || model.fitted[k]);
        if constexpr (requires {
                          requires Scalar::Tangent::SizeAtCompileTime >
                          4;
                      })
            if (model.fitted[k]) links.p[k].tangent[4 + k] = 1;
    }
    if (model.point_masses) links.p[gravity_1] = links.p[inertia] * links.p[gravity_2] / links.p[coupling];
    return links;
}

// Joints with Coulomb friction: their mode at a state, and the end of that mode.

/// The modes of sliding joints at this state.
inline std::array<int, 2> turning(const LinkState& y) {
    return {y[2] < 0 ? -1 : 1, y[3] < y[2] ? -1 : 1};
}
/// 0 or more while the mode of the joint is valid.
double margin(const LinkPair<double>& links, std::size_t joint, const LinkState& y);
/// The modes after an event of this joint, which is now at rest. It matters whether it was held before.
std::array<int, 2> modes_after_event(LinkPair<double> links, std::size_t joint, const LinkState& y);

/// Quantities that angles cannot determine and that must be given.
struct Convention {
    double gravity = 9.8;      // m/s², > 0
    double second_mass = 1.0;  // kg, > 0
};

/// A pendulum that moves like the fitted links. The length of the first link follows from gravity (L1 = g C/D2). Angles
/// do not determine how the rest is divided into mass, centre and inertia. Both links are taken as uniform rods (I = m
/// a²/3, a to the centre of mass) or, if point masses were fitted, as points at their ends (I = 0). A second link that
/// is too light for this gets less inertia.
struct FittedPendulum {
    std::vector<std::pair<std::string, std::array<double, 2>>> links;  // values of both links for each key of a preset
    double gravity = 0, second_inertia = 0;  // m/s²; B, kg m², the factor that turns ratios into these values
    std::string rule;                        // a sentence with the rule that was applied
};
FittedPendulum fitted_pendulum(const Parameters& parameters, const ModelSpec& model, const Convention& convention);

}  // namespace doppel
