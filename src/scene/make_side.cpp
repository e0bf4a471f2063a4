#include "base/error.hpp"
#include "base/text.hpp"
#include "physics/mechanism.hpp"
#include "scene/captions.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <map>

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
    if (!spec.physical.is_none())
        return {Model::angles, fmt::format("{}: rigid bodies in angles, at a cost that grows with the links",
                                           physical_words(spec.physical))};
    if (!method.angles) return {Model::constraints, fmt::format("\"{}\" steps particles on their rods", method.name)};
    if (spec.stabilise != Stabilise::none) return {Model::constraints, "only constraints can be stabilised"};
    if (spec.links() == 2)
        return {Model::angles,
                "two links and no further forces: the closed form in angles is the smallest model that serves"};
    return {Model::angles,
            fmt::format("a chain of {} and no further forces: angles, at a cost that grows with the links",
                        spec.links() == 1 ? "one link" : fmt::format("{} links", spec.links()))};
}

/// What of each link's mass is at its end, kg: that of a body is along it.
std::vector<double> end_masses(const SideSpec& spec) {
    const auto& physical = spec.physical;
    const bool is_physical = !physical.is_none(), has_centers = !physical.center_m.empty();
    std::vector<double> masses;
    for (std::size_t i = 0; i < spec.links(); ++i) {
        const bool is_body = is_physical && (has_centers || physical.inertia_kg_m2[i] != 0);
        masses.push_back(is_body ? 0 : static_cast<double>(spec.mass_kg[i]));
    }
    return masses;
}

/// What pictures and errors are measured by, in double.
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
        constexpr float heavy = 3.2f;  // a body is drawn as broad as that
        for (std::size_t i = 0; i < side.lines.size(); ++i)
            if (physical.chain.mass[i] > side.mass[i]) side.lines[i].width = heavy;
    }
    if (!side.motion.parts) return;
    const auto parts = side.motion.parts->cast<double>();
    check(parts);
    side.lines = lines_of(parts);
    side.has_energy_error = parts.conserves_energy();
    if (side.has_angles) return;
    // no chain: its energies are those of falling as far as it is large, and those of its start
    side.reach = size_of(parts);
    for (const auto& force : parts.forces)
        if (const auto* gravity = std::get_if<Gravity<double>>(&force)) side.gravity = gravity->g;
    const Mechanism<double> mechanism(parts);
    const auto start = Mechanism<double>::start(parts);
    const auto bobs = mechanism.bobs(start);
    double mass = 0;
    for (const auto& bob : bobs) {
        side.mass.push_back(bob.mass);
        mass += bob.mass;
    }
    side.energy_unit =
        std::max({2 * mass * side.gravity * side.reach, std::abs(mechanism.energy(start)), kinetic_energy(bobs)});
    if (!(side.energy_unit > 0)) side.energy_unit = 1;
}

/// A track, and the pendulum that it is taken for.
Side make_measured_side(const SideSpec& spec, const Rational& sample_hz) {
    Side side;
    side.why = "a measured swing, which nothing steps";
    side.motion.sample_interval = *quotient({1, 1}, sample_hz);
    side.motion.chain = chain_of(spec);
    if (!spec.physical.is_none()) side.motion.physical = physical_of(spec);
    measure(spec, side);
    side.replay = replay_of(spec.track);
    side.has_energy_error = side.has_work = false;
    return side;
}

}  // namespace

Side make_side(const SideSpec& spec, const Rational& sample_hz) {
    if (!spec.track.is_none()) return make_measured_side(spec, sample_hz);
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
    if (!spec.physical.is_none()) motion.physical = physical_of(spec);
    if (motion.model == Model::mechanism) motion.parts = assembly_of(spec);
    measure(spec, side);
    return side;
}

namespace {

Place<Quad> place(const QuadPair& xy) {
    return {xy[0], xy[1]};
}

/// What parts call the particles, and where those are at the start.
class ParticleNames {
public:
    ParticleNames(std::vector<std::string> names, const Assembly<Quad>& assembly)
        : names_(std::move(names)), assembly_(assembly) {
        for (std::size_t i = 0; i < names_.size(); ++i) indices_.emplace(names_[i], i);
    }

    /// Of the particle that an entry, `what`, names.
    std::size_t index(const std::string& what, const std::string& name) const {
        if (const auto found = indices_.find(name); found != indices_.end()) return found->second;
        const auto meant = nearest(name, std::vector<std::string_view>(names_.begin(), names_.end()));
        throw bad_input("{} names the particle \"{}\", which is not there{}", what, name,
                        meant ? fmt::format("; did you mean \"{}\"?", *meant) : "");
    }
    End<Quad> end(const std::string& what, const EndSpec& spec) const {
        if (const auto* name = std::get_if<std::string>(&spec)) return index(what, *name);
        return place(std::get<QuadPair>(spec));
    }
    Place<Quad> start(const End<Quad>& end) const {
        const auto* particle = std::get_if<std::size_t>(&end);
        return particle ? assembly_.particles[*particle].place : std::get<Place<Quad>>(end);
    }
    Quad apart(const End<Quad>& one, const End<Quad>& other) const {
        using std::sqrt;
        const Place<Quad> r = start(one) - start(other);
        return sqrt(Quad(r[0] * r[0] + r[1] * r[1]));
    }

private:
    std::vector<std::string> names_;
    std::map<std::string, std::size_t> indices_;  // by name
    const Assembly<Quad>& assembly_;
};

/// Makes one constraint or force of what a preset says of it.
struct PartBuilder {
    const ParticleNames& by_name;
    std::string_view kind;
    std::string what;  // kind and name, for errors

    /// From a particle to whatever is at the other end; a fixed end goes second.
    std::pair<std::size_t, End<Quad>> ends(const auto& part) const {
        auto from = by_name.end(what, *part.from), to = by_name.end(what, *part.to);
        if (!std::holds_alternative<std::size_t>(from)) std::swap(from, to);
        if (!std::holds_alternative<std::size_t>(from))
            throw bad_input("a {} joins two fixed places; at least one end must be a particle", kind);
        return {std::get<std::size_t>(from), to};
    }
    /// The particle, and where it is held.
    std::pair<std::size_t, Place<Quad>> held(const auto& part) const {
        const auto particle = by_name.index(what, part.particle);
        return {particle, part.position_m ? place(*part.position_m) : by_name.start(particle)};
    }

    Constraint<Quad> operator()(const AnchorSpec& part) const {
        const auto [particle, at] = held(part);
        return Anchor<Quad>{particle, at};
    }
    Constraint<Quad> operator()(const RodSpec& part) const {
        const auto [a, b] = ends(part);
        return Rod<Quad>{a, b, part.length_m ? *part.length_m : by_name.apart(a, b)};
    }
    Constraint<Quad> operator()(const SlotLineSpec& part) const {
        const auto [particle, at] = held(part);
        return SlotLine<Quad>{particle, at, place(part.direction)};
    }
    Constraint<Quad> operator()(const SlotCircleSpec& part) const {
        const auto [particle, at] = held(part);
        return SlotCircle<Quad>{particle, at, part.radius_m ? *part.radius_m : by_name.apart(particle, at)};
    }
    Force<Quad> operator()(const SpringSpec& part) const {
        const auto [a, b] = ends(part);
        return Spring<Quad>{a, b, part.stiffness_N_per_m, part.length_m ? *part.length_m : by_name.apart(a, b),
                            part.damping_N_s_per_m};
    }
    Force<Quad> operator()(const AttractionSpec& part) const {
        const auto [a, b] = ends(part);
        const auto* other = std::get_if<std::size_t>(&b);
        if (!other)
            throw bad_input("an attraction is between two particles; a body that stays in place is a \"droplet\"");
        return Attraction<Quad>{a, *other, part.constant_m3_per_kg_s2.value_or(newton_constant<Quad>())};
    }
    Force<Quad> operator()(const DropletSpec& part) const {
        return Droplet<Quad>{place(*part.position_m), part.mass_kg,
                             part.constant_m3_per_kg_s2.value_or(newton_constant<Quad>())};
    }
};

auto made(const ParticleNames& by_name, const auto& spec) {
    const auto kind = kind_name(spec);
    return std::visit(
        PartBuilder{by_name, kind,
                    fmt::format("{}{}", kind, spec.name.empty() ? "" : fmt::format(" \"{}\"", spec.name))},
        spec.part);
}

}  // namespace

Assembly<Quad> assembly_of(const SideSpec& spec) {
    Assembly<Quad> assembly;
    std::vector<std::string> names;
    if (spec.particles.empty()) {
        assembly = parts_of(chain_of(spec));
        for (std::size_t i = 1; i <= spec.links(); ++i) names.push_back(fmt::format("bob{}", i));
    }
    for (const auto& particle : spec.particles) {
        assembly.particles.push_back({particle.mass_kg, place(particle.position_m), place(particle.velocity_m_per_s)});
        names.push_back(particle.name);
    }
    const ParticleNames by_name(names, assembly);
    for (const auto& part : spec.constraints) assembly.constraints.push_back(made(by_name, part));
    if (!spec.particles.empty() && spec.gravity_m_per_s2 != 0)
        assembly.forces.push_back(Gravity<Quad>{spec.gravity_m_per_s2});
    for (const auto& part : spec.forces) assembly.forces.push_back(made(by_name, part));
    return assembly;
}

}  // namespace doppel
