#include "base/error.hpp"
#include "physics/mechanism.hpp"
#include "scene/captions.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace doppel {
namespace {

std::pair<Model, std::string> chosen_model(const SideSpec& spec, const MethodEntry& method) {
    if (spec.model != ModelChoice::automatic) return {value_named<Model>(name_of(spec.model)), "the preset selects it"};
    if (!spec.particles.empty())
        return {Model::mechanism, "particles, constraints and forces need the general mechanism"};
    if (spec.is_mechanism())
        return {Model::mechanism, "a chain with further constraints or forces needs the general mechanism"};
    if (!spec.physical.is_none())
        return {Model::angles,
                fmt::format("{}: rigid bodies with angles as coordinates, cost O(N)", physical_words(spec.physical))};
    if (!method.angles)
        return {Model::constraints, fmt::format("\"{}\" integrates particles with constraints", method.name)};
    if (spec.stabilise != Stabilise::none) return {Model::constraints, "only constraints can be stabilised"};
    if (spec.links() == 2)
        return {Model::angles, "two links and no further forces: the closed form with angles is the smallest model"};
    return {Model::angles, fmt::format("a chain of {} and no further forces: angles, cost O(N)",
                                       spec.links() == 1 ? "one link" : fmt::format("{} links", spec.links()))};
}

/// The mass at the end of each link for drawing, kg; a rigid body has less than its whole mass there.
std::vector<double> end_masses(const SideSpec& spec) {
    std::vector<double> masses;
    for (std::size_t i = 0; i < spec.links(); ++i) {
        const bool is_body = !spec.physical.center_m.empty() || spec.physical.inertia_kg_m2[i] != 0;
        masses.push_back(is_body ? 0 : static_cast<double>(spec.mass_kg[i]));
    }
    return masses;
}

/// Sets the quantities by which pictures and errors are scaled, in double.
void measure(const SideSpec& spec, Side& side) {
    if (side.motion.chain) {
        const auto chain = side.motion.chain->cast<double>();
        side.mass = end_masses(spec);
        side.gravity = chain.gravity;
        side.energy_unit = chain.potential_range();
        side.reach = chain.reach();
        side.lines = lines_of(chain);
    }
    side.has_angles = side.motion.chain.has_value();
    if (side.motion.physical) {
        const auto physical = side.motion.physical->cast<double>();
        side.energy_unit = physical.potential_range();
        side.has_work = !physical.conserves_energy();
        side.pivot_reach = std::hypot(physical.pivot.x, physical.pivot.y);
        constexpr float heavy = 3.2f;  // width of a rod with mass
        double mass = 0;
        for (const double of_link : physical.chain.mass) mass += of_link;
        side.lowest_potential = -mass * side.gravity * std::abs(physical.pivot.y);
        for (std::size_t i = 0; i < side.lines.size(); ++i)
            if (physical.chain.mass[i] > side.mass[i]) side.lines[i].width = heavy;
    }
    if (side.has_angles) side.lowest_potential -= side.energy_unit / 2;
    if (!side.motion.parts) return;
    const auto parts = side.motion.parts->cast<double>();
    try {
        check(parts);
    } catch (const ConstraintError& error) {  // the constraints of a chain come first
        const auto first = spec.particles.empty() ? spec.links() : 0;
        if (error.constraint < first) throw;
        throw PlacedError(error, "constraint", error.constraint - first);
    }
    side.lines = lines_of(parts);
    side.has_energy_error = parts.conserves_energy();
    if (side.has_angles) return;
    // a mechanism: the energy of falling by its size, and that of its start
    side.reach = size_of(parts);
    for (const auto& force : parts.forces)
        if (const auto* gravity = std::get_if<Gravity<double>>(&force)) side.gravity = gravity->g;
    const Mechanism<double> mechanism(parts);
    const auto start = Mechanism<double>::start(parts);
    const auto bobs = mechanism.bobs(start);
    double mass = 0;
    for (const auto& bob : bobs) mass += side.mass.emplace_back(bob.mass);
    side.energy_unit =
        std::max({2 * mass * side.gravity * side.reach, std::abs(mechanism.energy(start)), kinetic_energy(bobs)});
    if (!(side.energy_unit > 0)) side.energy_unit = 1;
}

Place<Quad> place(const QuadPair& xy) {
    return {xy[0], xy[1]};
}

/// Adds a constraint or a force to an assembly, whose particles have these numbers.
void add(const PartSpec& part, const std::map<std::string, std::size_t>& numbers, Assembly<Quad>& to) {
    using enum PartKind;
    using std::sqrt;
    const auto constant = part.constant_m3_per_kg_s2.value_or(newton_constant<Quad>());
    if (part.kind == droplet)
        return to.forces.push_back(Droplet<Quad>{place(*part.position_m), part.mass_kg, constant});
    const auto end = [&](const EndSpec& spec) -> End<Quad> {
        if (const auto* name = std::get_if<std::string>(&spec)) return numbers.at(*name);
        return place(std::get<QuadPair>(spec));
    };
    const auto start = [&](const End<Quad>& of) {
        const auto* particle = std::get_if<std::size_t>(&of);
        return particle ? to.particles[*particle].place : std::get<Place<Quad>>(of);
    };
    const bool has_ends = part.kind == rod || part.kind == spring || part.kind == attraction;
    auto first = end(has_ends ? *part.from : part.particle), b = has_ends ? end(*part.to) : first;
    if (!std::holds_alternative<std::size_t>(first)) std::swap(first, b);  // a fixed end comes second
    const auto a = std::get<std::size_t>(first);
    const auto at = part.position_m && !has_ends ? place(*part.position_m) : start(b);
    const Place<Quad> r = start(a) - at;
    const Quad distance = sqrt(Quad(r[0] * r[0] + r[1] * r[1])), length = part.length_m.value_or(distance);
    switch (part.kind) {
        case anchor:
            return to.constraints.push_back(Anchor<Quad>{a, at});
        case rod:
            return to.constraints.push_back(Rod<Quad>{a, b, length});
        case slot_line:
            return to.constraints.push_back(SlotLine<Quad>{a, at, place(part.direction)});
        case slot_circle:
            return to.constraints.push_back(SlotCircle<Quad>{a, at, part.radius_m.value_or(distance)});
        case spring:
            return to.forces.push_back(Spring<Quad>{a, b, part.stiffness_N_per_m, length, part.damping_N_s_per_m});
        default:
            return to.forces.push_back(Attraction<Quad>{a, std::get<std::size_t>(b), constant});
    }
}

}  // namespace

Side make_side(const SideSpec& spec, const Rational& sample_hz) {
    Side side;
    auto& motion = side.motion;
    motion.sample_interval = *quotient({1, 1}, sample_hz);
    if (spec.particles.empty()) motion.chain = chain_of(spec);
    if (!spec.physical.is_none()) motion.physical = physical_of(spec);
    if (!spec.track.is_none()) {  // the chain is the pendulum that the track is assumed to show
        side.why = "a measured track; no method integrates it";
        measure(spec, side);
        side.replay = replay_of(spec.track);
        side.has_energy_error = side.has_work = false;
        return side;
    }
    side.method = *find_method(spec.integrator);
    std::tie(motion.model, side.why) = chosen_model(spec, side.method);
    motion.method = spec.integrator;
    motion.precision = spec.precision;
    if (side.method.adaptive) {
        motion.tolerance = spec.allowed_error();
    } else {
        side.step = spec.step();
        motion.steps_per_sample = quotient(motion.sample_interval, side.step)->numerator;
    }
    motion.stabilise = spec.stabilise;
    motion.stabilise_rate = spec.stabilise_rate_per_s;
    if (motion.model == Model::mechanism) motion.parts = assembly_of(spec);
    measure(spec, side);
    return side;
}

std::vector<std::string> particle_names(const SideSpec& spec) {
    std::vector<std::string> names;
    for (const auto& particle : spec.particles) names.push_back(particle.name);
    for (std::size_t i = 1; spec.particles.empty() && i <= spec.links(); ++i) names.push_back(fmt::format("bob{}", i));
    return names;
}

Assembly<Quad> assembly_of(const SideSpec& spec) {
    Assembly<Quad> assembly;
    if (spec.particles.empty()) assembly = parts_of(chain_of(spec));
    for (const auto& particle : spec.particles)
        assembly.particles.push_back({particle.mass_kg, place(particle.position_m), place(particle.velocity_m_per_s)});
    if (!spec.particles.empty() && spec.gravity_m_per_s2 != 0)
        assembly.forces.push_back(Gravity<Quad>{spec.gravity_m_per_s2});
    std::map<std::string, std::size_t> numbers;
    for (const auto& name : particle_names(spec)) numbers.emplace(name, numbers.size());
    for (const auto* parts : {&spec.constraints, &spec.forces})
        for (const auto& part : *parts) add(part, numbers, assembly);
    return assembly;
}

Pendulum<Quad> chain_of(const SideSpec& spec) {
    Pendulum<Quad> chain{spec.mass_kg, spec.length_m, {}, {}, spec.gravity_m_per_s2};
    for (std::size_t i = 0; i < chain.links(); ++i) chain.mass[i] += spec.physical.rod_mass_kg[i];
    const Quad degree = pi_of<Quad>() / 180;
    for (const auto& angle : spec.angle_deg) chain.angle.push_back(angle * degree);
    for (const auto& rate : spec.omega_deg_per_s) chain.rate.push_back(rate * degree);
    return chain;
}

PhysicalPendulum<Quad> physical_of(const SideSpec& spec) {
    const auto& from = spec.physical;
    const Quad degree = pi_of<Quad>() / 180, turn = 2 * pi_of<Quad>();
    auto made = doppel::physical(chain_of(spec));
    for (std::size_t i = 0; i < made.chain.links(); ++i) {
        // body and rod as one rigid body, about their common centre of mass
        const auto &body = spec.mass_kg[i], &rod = from.rod_mass_kg[i], &length = spec.length_m[i];
        const Quad at = from.center_m.empty() ? length : from.center_m[i], middle = length / 2;
        const Quad center = (body * at + rod * middle) / (body + rod);
        made.center[i] = center;
        made.inertia[i] = from.inertia_kg_m2[i] + body * (at - center) * (at - center) + rod * length * length / 12 +
                          rod * (middle - center) * (middle - center);
    }
    const auto given = [](const std::vector<Quad>& list) { return is_zero(list) ? std::vector<Quad>() : list; };
    made.friction = {given(from.joint_viscous_N_m_s),       given(from.joint_coulomb_N_m),
                     given(from.arm_drag_linear_N_m_s),     given(from.arm_drag_quadratic_N_m_s2),
                     given(from.air_drag_quadratic_N_m_s2), given(from.drag_linear_N_s_per_m),
                     given(from.drag_quadratic_N_s2_per_m2)};
    if (from.pivot.amplitude_m != 0) {
        const SinCos<Quad> direction(Quad(from.pivot.direction_deg * degree));
        made.pivot = {from.pivot.amplitude_m * direction.cos, from.pivot.amplitude_m * direction.sin,
                      from.pivot.frequency_hz * turn, from.pivot.phase_deg * degree};
    }
    for (const auto& motor : from.torques)
        made.torques.push_back({static_cast<std::size_t>(motor.joint) - 1, motor.amplitude_N_m,
                                motor.frequency_hz * turn, motor.phase_deg * degree});
    return made;
}

std::vector<MechanismLine> lines_of(const Pendulum<double>& chain) {
    using Kind = MechanismLine::Kind;
    const End<double> pivot = Place<double>(0, 0);
    std::vector<MechanismLine> lines;
    for (std::size_t i = 0; i < chain.links(); ++i)
        lines.push_back({Kind::rod, i == 0 ? pivot : End<double>(i - 1), i});
    return lines;
}

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

Replay replay_of(const TrackSpec& spec) {
    const Quad degree = pi_of<Quad>() / 180;
    const auto offset = [&](std::size_t i) { return static_cast<double>(Quad(spec.offset_deg[i] * degree)); };
    std::optional<double> start;
    if (spec.start_s) start = static_cast<double>(*spec.start_s);
    return replay_from(spec.track, start, {offset(0), offset(1)});
}

Rational longest_duration(const Replay& replay, const Rational& sample_hz) {
    constexpr double rounding = 1e-9;  // s
    const auto samples = static_cast<long>(std::floor((replay.length() + rounding) * sample_hz.value()));
    return *quotient({samples, 1}, sample_hz);
}

}  // namespace doppel
