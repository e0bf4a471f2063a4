#include "scene/side_reader.hpp"

#include "integrate/methods.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string>

namespace doppel {
namespace {

using namespace std::string_view_literals;

constexpr std::array model_names{"auto"sv, "angles"sv, "constraints"sv, "mechanism"sv};
constexpr std::array precision_names{"double"sv, "quad"sv};
constexpr std::array stabilise_names{"none"sv, "baumgarte"sv, "projection"sv};
constexpr int most_links = 10'000;
constexpr int most_angle = 1'000'000;  // degrees

void read_chain(TomlReader& table, SideSpec& side) {
    int links = static_cast<int>(side.links());
    table.read_whole("links", links, 1, most_links);
    if (const auto n = static_cast<std::size_t>(links); n != side.links()) {
        side.mass_kg.assign(n, 1);
        side.length_m.assign(n, 1);
        side.angle_deg.assign(n, 90);
        side.omega_deg_per_s.assign(n, 0);
    }
    table.read_positives("mass_kg", side.mass_kg, "one a link");
    table.read_positives("length_m", side.length_m, "one a link");
    table.read_numbers("angle_deg", side.angle_deg, "one a link");
    for (const auto& angle : side.angle_deg)
        if (abs(angle) > most_angle)
            throw table.fault("angle_deg", "must be from -{0} to {0}: more leaves no digits to move by; one is {1}",
                              most_angle, text_of(angle));
    table.read_numbers("omega_deg_per_s", side.omega_deg_per_s, "one a link");
}

/// Whether an accuracy stands in place of integrator, step and tolerance: one from the command line for those of the
/// preset, or they, from the command line, for its accuracy. Rivals given side by side are an error.
bool read_accuracy(TomlReader& table, SideSpec& side) {
    constexpr std::array rivals{"integrator"sv, "step_s"sv, "tolerance"sv};
    const std::string_view* rival = nullptr;
    for (const auto& key : rivals)
        if (table.has(key) && !rival) rival = &key;
    if (table.has("accuracy")) {
        const bool ours = table.from_command_line("accuracy"), theirs = rival && table.from_command_line(*rival);
        if (rival && ours == theirs)
            throw table.fault("accuracy", "chooses integrator, step and tolerance itself; give it, or {}", *rival);
        if (theirs) {
            side.accuracy.reset();
            return false;
        }
        table.read_positive("accuracy", side.accuracy.emplace());
        if (*side.accuracy > 1)
            throw table.fault("accuracy", "must be at most 1 rad; it is {}", text_of(*side.accuracy));
        side.accuracy_from_command_line = ours;
    } else if (rival && !(side.accuracy_from_command_line && !table.from_command_line(*rival))) {
        side.accuracy.reset();
    }
    if (!side.accuracy) return false;
    side.step_s.reset();
    side.tolerance.reset();
    return true;
}

/// Integrator, and the step or the tolerance that it goes by. An integrator from the command line drops what the preset
/// says for another kind; rivals given side by side are an error.
void read_method(TomlReader& table, SideSpec& side) {
    std::vector<std::string_view> names;
    for (const auto& method : methods()) names.push_back(method.name);
    if (read_accuracy(table, side)) return;
    table.read_choice("integrator", side.integrator, names);
    if (table.has("integrator")) side.integrator_from_command_line = table.from_command_line("integrator");
    const bool adaptive = find_method(side.integrator)->adaptive;

    // true where the key counts
    const auto takes = [&](std::string_view key, bool serves, const char* what) {
        if (!table.has(key) || serves) return serves;
        if (side.integrator_from_command_line && !table.from_command_line(key)) return false;
        throw table.fault(key, "is for {}; \"{}\" goes by {}", what, side.integrator,
                          adaptive ? "tolerance" : "step_s");
    };
    if (!takes("step_s", !adaptive, "methods with a fixed step"))
        side.step_s.reset();
    else if (table.has("step_s"))
        table.read_positive_ratio("step_s", side.step_s.emplace());
    if (!takes("tolerance", adaptive, "adaptive methods"))
        side.tolerance.reset();
    else if (table.has("tolerance"))
        table.read_positive("tolerance", side.tolerance.emplace());
}

std::string served(const MethodEntry& method) {
    std::vector<std::string_view> models;
    if (method.angles) models.emplace_back("angles");
    if (method.constraints) models.emplace_back("constraints");
    if (method.mechanism) models.emplace_back("mechanism");
    return fmt::format("{}", fmt::join(models, " and "));
}

/// Particles, constraints and forces. An entry with the name of one that is there changes it; others are added.
template <class Spec, class Read>
void read_entries(TomlReader& table, std::string_view key, std::vector<Spec>& entries, const Read& read) {
    const auto tables = table.read_tables(key);
    std::set<std::string> given;
    for (std::size_t i = 0; i < tables.size(); ++i) {
        auto entry = table.inner(tables[i], fmt::format("[[{}.{}]] {}", table.bare_name(), key, i + 1));
        std::string name;
        entry.read_text("name", name);
        if (!name.empty() && !given.insert(name).second)
            throw entry.fault("name", "must differ from those before it; \"{}\" is there already", name);
        auto same = std::find_if(entries.begin(), entries.end(),
                                 [&](const Spec& spec) { return !name.empty() && spec.name == name; });
        if (same == entries.end()) same = entries.insert(entries.end(), Spec{.name = name});
        read(entry, *same);
        entry.finish();
    }
}

void read_particle(TomlReader& entry, ParticleSpec& particle) {
    if (particle.name.empty()) throw entry.fault("name", "is missing; constraints and forces call a particle by it");
    entry.demand_drawable("name", particle.name);
    entry.read_positive("mass_kg", particle.mass_kg);
    entry.read_pair("position_m", particle.position_m);
    entry.read_pair("velocity_m_per_s", particle.velocity_m_per_s);
}

void read_end(TomlReader& entry, std::string_view key, std::optional<EndSpec>& end) {
    if (!entry.has(key)) return;
    if (entry.is_text(key))
        entry.read_text(key, end.emplace().emplace<std::string>());
    else
        entry.read_pair(key, end.emplace().emplace<std::array<Quad, 2>>());
}

/// The keys of one constraint or force: those of its kind, and no others.
void read_part(TomlReader& entry, PartSpec& part, std::span<const std::string_view> kinds) {
    if (part.kind.empty() && !entry.has("kind"))
        throw entry.fault("kind", "is missing; there is \"{}\"", fmt::join(kinds, "\", \""));
    entry.read_choice("kind", part.kind, kinds);
    const auto is = [&](auto... names) { return ((part.kind == names) || ...); };
    const auto read_positive = [&](std::string_view key, std::optional<Quad>& into) {
        if (entry.has(key)) entry.read_positive(key, into.emplace());
    };
    const auto demand = [&](std::string_view key, bool given) {
        if (!given) throw entry.fault(key, "is missing; a {} needs it", part.kind);
    };
    if (is("anchor", "slot-line", "slot-circle")) {
        entry.read_text("particle", part.particle);
        demand("particle", !part.particle.empty());
    } else if (!is("droplet")) {
        read_end(entry, "from", part.from);
        read_end(entry, "to", part.to);
        demand("from", part.from.has_value());
        demand("to", part.to.has_value());
    }
    if (is("anchor", "slot-line", "slot-circle", "droplet")) {
        if (entry.has("position_m")) entry.read_pair("position_m", part.position_m.emplace());
        demand("position_m", part.position_m || is("anchor", "slot-line"));
    }
    if (is("slot-line")) entry.read_pair("direction", part.direction);
    if (is("rod")) read_positive("length_m", part.length_m);
    if (is("spring") && entry.has("length_m")) {
        entry.read_number("length_m", part.length_m.emplace());
        if (*part.length_m < 0) throw entry.fault("length_m", "must be ≥ 0; it is {}", text_of(*part.length_m));
    }
    if (is("slot-circle")) read_positive("radius_m", part.length_m);
    if (is("spring")) {
        entry.read_positive("stiffness_N_per_m", part.stiffness_N_per_m);
        entry.read_number("damping_N_s_per_m", part.damping_N_s_per_m);
        if (part.damping_N_s_per_m < 0)
            throw entry.fault("damping_N_s_per_m", "must be ≥ 0; it is {}", text_of(part.damping_N_s_per_m));
    }
    if (is("droplet")) entry.read_positive("mass_kg", part.mass_kg);
    if (is("attraction", "droplet")) read_positive("constant_m3_per_kg_s2", part.constant);
}

void read_mechanism(TomlReader& table, SideSpec& side) {
    static constexpr std::array constraint_kinds{"anchor"sv, "rod"sv, "slot-line"sv, "slot-circle"sv};
    static constexpr std::array force_kinds{"spring"sv, "attraction"sv, "droplet"sv};
    read_entries(table, "particle", side.particles, read_particle);
    read_entries(table, "constraint", side.constraints,
                 [](TomlReader& entry, PartSpec& part) { read_part(entry, part, constraint_kinds); });
    read_entries(table, "force", side.forces,
                 [](TomlReader& entry, PartSpec& part) { read_part(entry, part, force_kinds); });
    if (side.particles.empty()) return;
    for (const auto* key : {"links", "mass_kg", "length_m", "angle_deg", "omega_deg_per_s"})
        if (table.has(key))
            throw table.fault(key, "describes a chain, and [[system.particle]] another system; give one");
}

void read_gravity(TomlReader& table, SideSpec& side) {
    table.read_number("gravity_m_per_s2", side.gravity_m_per_s2);
    if (side.gravity_m_per_s2 < 0 || (side.gravity_m_per_s2 == 0 && !side.is_mechanism()))
        throw table.fault("gravity_m_per_s2", "must be > 0; it is {}", text_of(side.gravity_m_per_s2));
}

/// What the keys say together must be possible.
void check_choices(TomlReader& table, const SideSpec& side) {
    if (side.is_mechanism() && side.model != ModelChoice::automatic && side.model != ModelChoice::mechanism)
        throw table.fault("model",
                          "must be \"mechanism\" or \"auto\" with particles, constraints or forces; it is \"{}\"",
                          model_names[static_cast<std::size_t>(side.model)]);
    if (side.stabilise != Stabilise::none && side.model == ModelChoice::angles)
        throw table.fault("stabilise", "is for constraints; in angles the rods keep their length by themselves");
    if (side.accuracy) return;
    const auto& method = *find_method(side.integrator);
    if (side.is_mechanism() && !method.mechanism)
        throw table.fault("integrator", "\"{}\" serves {}, not a mechanism", side.integrator, served(method));
    const bool possible = side.model == ModelChoice::automatic ||
                          (side.model == ModelChoice::angles && method.angles) ||
                          (side.model == ModelChoice::constraints && method.constraints) ||
                          (side.model == ModelChoice::mechanism && method.mechanism);
    if (!possible)
        throw table.fault(table.has("integrator") ? "integrator" : "model", "\"{}\" serves {}, not model = \"{}\"",
                          side.integrator, served(method), model_names[static_cast<std::size_t>(side.model)]);
    if (side.stabilise != Stabilise::none && !method.angles)
        throw table.fault("stabilise", "is not for \"{}\", which keeps the constraints itself", side.integrator);
}

}  // namespace

void read_release(TomlReader& table, SideSpec& side) {
    read_chain(table, side);
    read_gravity(table, side);
    table.finish();
}

void read_side(TomlReader& table, SideSpec& side) {
    read_chain(table, side);
    read_mechanism(table, side);
    read_gravity(table, side);
    table.read_enumerated("model", side.model, model_names);
    read_method(table, side);
    table.read_enumerated("precision", side.precision, precision_names);
    table.read_enumerated("stabilise", side.stabilise, stabilise_names);
    table.read_positive("stabilise_rate_per_s", side.stabilise_rate_per_s);
    check_choices(table, side);
    table.finish();
}

}  // namespace doppel
