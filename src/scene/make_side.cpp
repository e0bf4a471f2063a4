#include "physics/mechanism.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// The smallest model that serves, and why.
std::pair<Model, std::string> chosen_model(const SideSpec& spec, const MethodEntry& method) {
    switch (spec.model) {
        case ModelChoice::angles:
            return {Model::angles, "the preset asks for it"};
        case ModelChoice::constraints:
            return {Model::constraints, "the preset asks for it"};
        case ModelChoice::mechanism:
            return {Model::mechanism, "the preset asks for it"};
        case ModelChoice::automatic:
            break;
    }
    if (!spec.particles.empty())
        return {Model::mechanism, "particles, constraints and forces of its own take the general mechanism"};
    if (spec.is_mechanism())
        return {Model::mechanism, "a chain with further constraints or forces takes the general mechanism"};
    if (!method.angles) return {Model::constraints, fmt::format("\"{}\" steps particles on their rods", method.name)};
    if (spec.stabilise != Stabilise::none) return {Model::constraints, "only constraints can be stabilised"};
    if (spec.links() == 2)
        return {Model::angles,
                "two links and no further forces: the closed form in angles is the smallest model that serves"};
    return {Model::angles,
            fmt::format("a chain of {} and no further forces: angles, at a cost that grows with the links",
                        spec.links() == 1 ? "one link" : fmt::format("{} links", spec.links()))};
}

/// Rod below rod, from the pivot.
std::vector<MechanismLine> lines_of(const Pendulum<double>& chain) {
    using Kind = MechanismLine::Kind;
    const End<double> pivot = Place<double>(0, 0);
    std::vector<MechanismLine> lines;
    for (std::size_t i = 0; i < chain.links(); ++i)
        lines.push_back({Kind::rod, i == 0 ? pivot : End<double>(i - 1), i});
    return lines;
}

/// What pictures and errors are measured by, in double.
void measure(Side& side) {
    if (side.motion.chain) {
        const auto chain = side.motion.chain->cast<double>();
        side.mass = chain.mass;
        side.gravity = chain.gravity;
        side.energy_unit = chain.potential_range();
        side.reach = chain.reach();
        side.lines = lines_of(chain);
    }
    side.has_angles = side.motion.chain.has_value();
    if (!side.motion.parts) return;
    const auto parts = side.motion.parts->cast<double>();
    check(parts);
    side.lines = lines_of(parts);
    side.conserves_energy = parts.conserves_energy();
    if (side.has_angles) return;
    // no chain: its energies are those of falling as far as it is large, and those of its start
    side.reach = size_of(parts);
    for (const auto& force : parts.forces)
        if (const auto* gravity = std::get_if<Gravity<double>>(&force)) side.gravity = gravity->g;
    const Mechanism<double> mechanism(parts);
    const auto start = Mechanism<double>::start(parts);
    const auto bobs = mechanism.bobs(start);
    double mass = 0, kinetic = 0;
    for (const auto& bob : bobs) {
        side.mass.push_back(bob.mass);
        mass += bob.mass;
        kinetic += 0.5 * bob.mass * (bob.vx * bob.vx + bob.vy * bob.vy);
    }
    side.energy_unit = std::max({2 * mass * side.gravity * side.reach, std::abs(mechanism.energy(start)), kinetic});
    if (!(side.energy_unit > 0)) side.energy_unit = 1;
}

}  // namespace

std::vector<MechanismLine> lines_of(const Assembly<double>& assembly) {
    using Kind = MechanismLine::Kind;
    std::vector<MechanismLine> lines;
    for (const auto& constraint : assembly.constraints) {
        if (const auto* anchor = std::get_if<Anchor<double>>(&constraint))
            lines.push_back({Kind::anchor, anchor->place, anchor->place});
        if (const auto* rod = std::get_if<Rod<double>>(&constraint)) lines.push_back({Kind::rod, rod->a, rod->b});
        if (const auto* slot = std::get_if<SlotLine<double>>(&constraint))
            lines.push_back({Kind::slot_line, slot->point, Place<double>(slot->point + slot->direction)});
        if (const auto* slot = std::get_if<SlotCircle<double>>(&constraint))
            lines.push_back({Kind::slot_circle, slot->centre, slot->centre, slot->radius});
    }
    for (const auto& force : assembly.forces)
        if (const auto* spring = std::get_if<Spring<double>>(&force))
            lines.push_back({Kind::spring, spring->a, spring->b});
    return lines;
}

Side make_side(const SideSpec& spec, const Rational& sample_hz) {
    Side side;
    side.method = *find_method(spec.integrator);
    auto& motion = side.motion;
    std::tie(motion.model, side.why) = chosen_model(spec, side.method);
    motion.method = spec.integrator;
    motion.precision = spec.precision;
    motion.sample_interval = *quotient({1, 1}, sample_hz);
    if (side.method.adaptive) {
        motion.tolerance =
            spec.tolerance.value_or(spec.precision == Precision::in_quad ? usual_quad_tolerance : usual_tolerance);
    } else {
        side.step = spec.step();
        motion.steps_per_sample = quotient(motion.sample_interval, side.step)->numerator;
    }
    motion.stabilise = spec.stabilise;
    motion.stabilise_rate = spec.stabilise_rate_per_s;

    if (spec.particles.empty()) motion.chain = chain_of(spec);
    if (motion.model == Model::mechanism) motion.parts = assembly_of(spec);
    measure(side);
    return side;
}

}  // namespace doppel
