#pragma once

#include "base/error.hpp"
#include "physics/bob.hpp"
#include "physics/force.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace doppel {

/// A point mass and its initial state.
template <class Scalar>
struct Particle {
    Scalar mass;                                                   // kg, > 0
    Place<Scalar> place;                                           // m, at t = 0
    Place<Scalar> velocity = Place<Scalar>(Scalar(0), Scalar(0));  // m/s, at t = 0

    auto members() const { return std::tie(mass, place, velocity); }
};

/// The parts of a mechanism and their initial states. Constraints and forces refer to particles by index from 0;
/// messages count from 1.
template <class Scalar>
struct Assembly {
    std::vector<Particle<Scalar>> particles;
    std::vector<Constraint<Scalar>> constraints;
    std::vector<Force<Scalar>> forces;

    auto members() const { return std::tie(particles, constraints, forces); }
    /// The same in another scalar.
    template <class To>
    Assembly<To> cast() const {
        return Cast<To>()(*this);
    }

    /// Whether energy is conserved: no spring is damped.
    bool conserves_energy() const {
        for (const auto& force : forces)
            if (const auto* spring = std::get_if<Spring<Scalar>>(&force); spring && spring->damping != Scalar(0))
                return false;
        return true;
    }
};

/// A chain as parts: bobs, rods and, if it is not zero, gravity.
template <class Scalar>
Assembly<Scalar> parts_of(const Pendulum<Scalar>& chain) {
    Assembly<Scalar> parts;
    End<Scalar> above = Place<Scalar>(Scalar(0), Scalar(0));
    for (const auto& bob : bobs_of_angles(chain, released_in_angles<Scalar, Eigen::Dynamic>(chain))) {
        const auto k = parts.particles.size();
        parts.particles.push_back({bob.mass, Place<Scalar>(bob.x, bob.y), Place<Scalar>(bob.vx, bob.vy)});
        parts.constraints.push_back(Rod<Scalar>{k, above, chain.length[k]});
        above = k;
    }
    if (chain.gravity != Scalar(0)) parts.forces.push_back(Gravity<Scalar>{chain.gravity});
    return parts;
}

/// The name of a part in messages: "rod 2–4", "rod 2–fixed", "anchor of particle 1", "gravity".
template <class Part>
std::string words_for(const Part& part) {
    if constexpr (requires { part.particle; }) {
        return fmt::format("{} of particle {}", Part::kind, part.particle + 1);
    } else if constexpr (requires { part.b; }) {
        const End<double> end = Cast<double>()(part.b);
        const auto* b = std::get_if<std::size_t>(&end);
        return fmt::format("{} {}–{}", Part::kind, part.a + 1, b ? fmt::to_string(*b + 1) : "fixed");
    } else {
        return std::string(Part::kind);
    }
}

/// "constraint 5 (rod 2–4)"
template <class Scalar>
std::string name_of(std::size_t index, const Constraint<Scalar>& constraint) {
    const auto words = std::visit([](const auto& part) { return words_for(part); }, constraint);
    return fmt::format("constraint {} ({})", index + 1, words);
}

/// "force 2 (spring 1–fixed)": the second of the forces in the preset; gravity is not in that list and not counted.
template <class Scalar>
std::string name_of(const std::vector<Force<Scalar>>& forces, std::size_t index) {
    const auto is_listed = [](const auto& force) { return !std::holds_alternative<Gravity<Scalar>>(force); };
    const auto before = std::count_if(forces.begin(), forces.begin() + static_cast<std::ptrdiff_t>(index), is_listed);
    const auto words = std::visit([](const auto& part) { return words_for(part); }, forces[index]);
    return fmt::format("force {} ({})", before + 1, words);
}

/// The unit of lengths of a mechanism, m: the largest of the initial extent of its particles, its longest rod, radius
/// or spring, and the distances of particles from the points of their slots. If these are all 0, the distance of the
/// nearest droplet, or 1 without droplets.
double size_of(const Assembly<double>& assembly);

/// An error in a constraint, numbered from 0.
struct ConstraintError : Error {
    ConstraintError(const Error& error, std::size_t of) : Error(error), constraint(of) {}
    std::size_t constraint;
};

/// Checks that an assembly can be built and released. Throws Error (exit 2) with the part, the value and what would be
/// right: a mass not > 0; a particle that does not exist, or is connected to itself; a rod or circle of length zero, a
/// slot without direction; a spring of zero stiffness; initial positions or velocities that violate a constraint by
/// more than 1e-9 of the size or speed; as ConstraintError, a constraint that depends on earlier ones.
void check(const Assembly<double>& assembly);

}  // namespace doppel
