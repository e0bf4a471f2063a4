#pragma once

#include "physics/bob.hpp"
#include "physics/force.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace doppel {

/// A point mass and how it is released.
template <class Scalar>
struct Particle {
    Scalar mass;                                                   // kg, > 0
    Place<Scalar> place;                                           // m, at t = 0
    Place<Scalar> velocity = Place<Scalar>(Scalar(0), Scalar(0));  // m/s, at t = 0

    auto members() const { return std::tie(mass, place, velocity); }
};

/// What a mechanism is made of and how it is released. Constraints and forces name particles by their index, from 0;
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

    /// Whether the true motion keeps its energy: no spring is damped.
    bool conserves_energy() const {
        for (const auto& force : forces)
            if (const auto* spring = std::get_if<Spring<Scalar>>(&force); spring && spring->damping != Scalar(0))
                return false;
        return true;
    }
};

/// A chain as its parts: bobs, rods and gravity, where there is any.
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

/// "rod 2–4", "rod 2–fixed", "anchor of particle 1", "gravity": a part as messages call it.
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

/// "force 2 (spring 1–fixed)": the second of those that a preset lists, for gravity, which is there by itself, is not
/// counted.
template <class Scalar>
std::string name_of(const std::vector<Force<Scalar>>& forces, std::size_t index) {
    const auto is_listed = [](const auto& force) { return !std::holds_alternative<Gravity<Scalar>>(force); };
    const auto before = std::count_if(forces.begin(), forces.begin() + static_cast<std::ptrdiff_t>(index), is_listed);
    const auto words = std::visit([](const auto& part) { return words_for(part); }, forces[index]);
    return fmt::format("force {} ({})", before + 1, words);
}

/// What lengths of a mechanism are measured by, m: the distance from end to end of its particles at the start, or its
/// longest rod, radius or spring, or the way from a particle to the point of its slot, whichever is most. Where all
/// that is 0, the way to the nearest droplet; where there is none, 1.
double size_of(const Assembly<double>& assembly);

/// Whether an assembly can be built, and released as it says. Throws Error (exit 2) that names the part, the value and
/// what would be right:
/// a mass not > 0; a particle that does not exist, or is joined with itself; a rod or circle of length zero, a slot
/// without direction; a spring not stiff; a start that violates a constraint, in place or in velocity, by more than
/// 1e-9 of the mechanism's size or speed; a constraint that follows from those before it.
void check(const Assembly<double>& assembly);

}  // namespace doppel
