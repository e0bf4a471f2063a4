#pragma once

#include "numeric/ball.hpp"
#include "numeric/rational.hpp"
#include "physics/force.hpp"
#include "physics/pendulum.hpp"

#include <functional>
#include <tuple>
#include <vector>

namespace doppel {

/// Two ideal links and attracting bodies.
template <class Scalar>
struct LinksAndDroplets {
    Pendulum<Scalar> chain;
    std::vector<Droplet<Scalar>> droplets = {};

    auto members() const { return std::tie(chain, droplets); }
};
/// By balls that contain its numbers.
using EnclosedSystem = LinksAndDroplets<Ball<Wide>>;

/// Scales of what an enclosure counts; all 1 for a proof. Tests leave parts out to see that they are needed.
struct EnclosureCount {
    double truncation = 1, rounding = 1, nonlinearity = 1, earlier_boxes = 1;
};

struct EnclosureSpec {
    Rational interval{1, 120};    // between samples, s
    long samples = 0;             // 0 … samples
    double largest_radius = 0.5;  // of angles, rad, and rates, rad/s: it ends beyond
    double tolerance = 0.25;      // last terms of a series, in units of rounding
    EnclosureCount counted = {};
    long most_edges = 20'000;   // four more a step; then the smaller half becomes a box
    long most_steps = 300'000;  // it ends there
};

/// θ1, θ2 (rad), ω1, ω2 (rad/s)
template <class Scalar>
using EnclosedState = State<Ball<Scalar>, 4>;

/// Called often, several times in a long step, with the number of samples done; may throw.
using Watch = std::function<void(long samples)>;

/// Sets that contain the true states at samples 0, 1 … for all systems and starts in the balls; fewer than required
/// where the proof ends.
///
/// The set is c + e, with e in a zonotope: the sum of edges g_j b_j, |b_j| ≤ 1. A step of length h uses
///     φ(c + e) ∈ p(1) + r + J e
/// with the Taylor polynomial p(τ) of the motion from c, τ = t/h, its remainder r, and a Jacobian J of the flow over the
/// hull of the set (Lohner's mean-value form). With the centre M of J, g_j becomes M g_j; four more edges, a box, contain
/// r, the roundings and (J − M) e. Boxes are not turned into others, so that the set grows as the tangents do; only of
/// more than `most_edges` edges, a box around the smaller half replaces it.
/// Source  Lohner 1987; Nedialkov, Jackson & Corliss 1999, Appl. Math. Comput. 105:21; for zonotopes Kühn 1998,
///         Computing 61:47.
template <class Scalar>
std::vector<EnclosedState<Scalar>> enclosures(const EnclosedSystem& system, const EnclosureSpec& spec,
                                              const Watch& watch);

}  // namespace doppel
