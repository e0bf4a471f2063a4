#include "embedded/scene.hpp"
#include "output/written.hpp"
#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace doppel {
namespace {

/// The keys of a chain, which particles exclude.
constexpr std::array<std::string_view, 5> chain_keys{"links", "mass_kg", "length_m", "angle_deg", "omega_deg_per_s"};

/// Whether an accuracy replaces integrator, step size and tolerance. An accuracy from the command line replaces those
/// of the preset, and vice versa. Both in the same place are an error.
bool read_accuracy(TomlReader& table, SideSpec& side) {
    constexpr std::array<std::string_view, 3> conflicts{"integrator", "step_s", "tolerance"};
    const std::string_view* conflict = nullptr;
    for (const auto& key : conflicts)
        if (table.has(key) && !conflict) conflict = &key;
    if (table.has("accuracy")) {
        const bool ours = table.from_command_line("accuracy"), theirs = conflict && table.from_command_line(*conflict);
        if (conflict && ours == theirs)
            table.refuse(table.error("accuracy", "chooses integrator, step and tolerance; remove it, or {}", *conflict)
                             .with(table.beside(*conflict)));
        if (theirs) {
            side.accuracy.reset();
            return false;
        }
        table(accuracy_field, side.accuracy);
        side.accuracy_from_command_line = ours;
    } else if (conflict && !(side.accuracy_from_command_line && !table.from_command_line(*conflict))) {
        side.accuracy.reset();
    }
    if (!side.accuracy) return false;
    side.step_s.reset();
    side.tolerance.reset();
    return true;
}

/// Reads torques, particles, constraints and forces. An entry with the name of an existing one changes it; others are
/// added. read(entry, spec, is_new) returns whether the entry's kind is known, and so its allowed keys.
template <class Spec, class Read>
void read_entries(TomlReader& table, std::string_view key, SideSpec& side, std::vector<Spec>& entries,
                  const Read& read) {
    std::set<std::string> given;
    std::map<std::string, std::size_t> indices;  // of named entries
    for (std::size_t i = 0; i < entries.size(); ++i)
        if (!entries[i].name.empty()) indices.emplace(entries[i].name, i);
    for (auto& entry : table.entries(key)) {
        std::string name;
        entry({.key = "name"}, name);
        if (!name.empty() && !given.insert(name).second)
            entry.refuse(entry.error("name", "must be unique; \"{}\" is used already", name));
        const auto same = indices.find(name);
        const bool is_new = same == indices.end();
        const auto number = is_new ? entries.size() : same->second;
        if (is_new) entries.push_back({.name = name});
        side.places[{std::string(key), number}] = entry.place_of(entry.has("kind") ? "kind" : "name").first;
        if (read(entry, entries[number], is_new)) entry.finish();
    }
}

bool read_particle(TomlReader& entry, ParticleSpec& particle, bool) {
    entry.check_together([&] {
        if (particle.name.empty())
            throw entry.error("name", "is missing; constraints and forces refer to a particle by it");
        entry.require_drawable("name", particle.name);
    });
    part_fields(entry, particle);
    return true;
}

bool read_part(TomlReader& entry, PartSpec& part, bool is_new, std::span<const std::string_view> kinds) {
    const bool has_kind = entry.has("kind");
    if (is_new && !has_kind) {
        entry.refuse(entry.error("kind", "is missing; there is \"{}\"", fmt::join(kinds, "\", \"")).with({}));
        return false;
    }
    std::string name(has_kind ? "" : name_of(part.kind));
    entry({.key = "kind", .names = kinds}, name);
    if (name.empty()) return false;
    // members common to both kinds are kept
    if (const auto kind = value_named<PartKind>(name); kind != part.kind)
        part = {part.name, kind, part.particle, part.from, part.to, part.position_m};
    part_fields(entry, part);
    const auto is_fixed = [](const auto& end) { return end && std::holds_alternative<QuadPair>(*end); };
    if (part.kind == PartKind::attraction) {
        for (const auto& [key, end] : {std::pair("from", part.from), {"to", part.to}})
            if (is_fixed(end))
                entry.refuse(entry.error(key, "must name a particle; for a fixed body use a \"droplet\""));
    } else if (is_fixed(part.from) && is_fixed(part.to)) {
        entry.refuse(entry.error("to", "must name a particle, because from is a fixed place"));
    }
    return true;
}

void read_physical_chain(TomlReader& table, SideSpec& side) {
    const bool has_rods =
        table.has("rod_mass_kg") || !table.elements_of("rod_mass_kg").empty() || !is_zero(side.physical.rod_mass_kg);
    chain_fields(table, side, has_rods ? not_negative : positive);
    if (table.has("center_m")) side.physical.center_m.resize(side.links());
    physical_fields(table, side.physical);
    read_entries(table, "torque", side, side.physical.torques, [&](TomlReader& entry, TorqueSpec& torque, bool is_new) {
        part_fields(entry, torque);
        entry.check_together([&] {
            for (const auto* key : {"frequency_hz", "phase_deg", "joint"})
                if (is_new && !entry.has("amplitude_N_m") && entry.has(key))
                    throw entry.error(key, "has no effect without amplitude_N_m");
            if (static_cast<std::size_t>(torque.joint) > side.links())
                throw entry.error("joint", "must be 1 to {}, the number of links; it is {}", side.links(),
                                  torque.joint);
        });
        return true;
    });
}

void read_mechanism(TomlReader& table, SideSpec& side) {
    read_entries(table, "particle", side, side.particles, read_particle);
    const auto kinds = std::span(names_of<PartKind>);
    const auto read_of = [](std::span<const std::string_view> some) {
        return [=](TomlReader& entry, PartSpec& part, bool is_new) { return read_part(entry, part, is_new, some); };
    };
    read_entries(table, "constraint", side, side.constraints, read_of(kinds.first(constraint_kinds)));
    read_entries(table, "force", side, side.forces, read_of(kinds.subspan(constraint_kinds)));
    if (side.particles.empty()) return;
    for (const auto& key : chain_keys)
        if (table.has(key))
            table.refuse(
                table
                    .error(key,
                           "describes a chain, but [[system.particle]] describes another system; remove one of them")
                    .with(table.beside("particle")));
}

void check_masses(TomlReader& table, const SideSpec& side) {
    for (std::size_t i = 0; i < side.links(); ++i)
        if (side.mass_kg[i] + side.physical.rod_mass_kg[i] == 0)
            throw table.error("mass_kg", "of link {} and its rod_mass_kg are both 0; one must be > 0", i + 1);
}

void check_physical(TomlReader& table, const SideSpec& side) {
    const auto& physical = side.physical;
    if (physical.is_none()) return;
    if (side.is_mechanism())
        throw table.error(!side.forces.empty()        ? "force"
                          : !side.constraints.empty() ? "constraint"
                                                      : "particle",
                          "cannot be combined with links with mass, friction or a drive, which need a plain chain");
    constexpr std::string_view why = "links with mass, friction or a drive need angles";
    if (side.model == ModelChoice::mechanism || side.model == ModelChoice::constraints)
        throw table.error("model", "\"{}\" does not support this chain: {}", name_of(side.model), why);
    if (side.stabilise != Stabilise::none) throw table.error("stabilise", "is for constraints; {}", why);
    const auto& method = *find_method(side.integrator);
    if (!side.accuracy && !method.angles)
        throw table.error("integrator", "\"{}\" needs model = \"constraints\"; {}", side.integrator, why);
    if (!side.accuracy && physical.has_coulomb() && !method.stabilised)
        throw table.error("integrator", "\"{}\" does not support Coulomb friction (joint_coulomb_N_m)",
                          side.integrator);
    check_masses(table, side);
}

void check_choices(TomlReader& table, const SideSpec& side) {
    check_physical(table, side);
    if (side.is_mechanism() && side.model != ModelChoice::automatic && side.model != ModelChoice::mechanism)
        throw table.error("model",
                          "must be \"mechanism\" or \"auto\" with particles, constraints or forces; it is \"{}\"",
                          name_of(side.model));
    if (side.stabilise != Stabilise::none && side.model == ModelChoice::angles)
        throw table.error("stabilise", "is for constraints; with angles as coordinates rods have constant length");
    if (side.accuracy) return;
    const auto& method = *find_method(side.integrator);
    const auto models = models_of(method);
    if (side.is_mechanism() && !method.mechanism)
        throw table.error("integrator", "\"{}\" supports {}, not a mechanism", side.integrator,
                          fmt::join(models, " and "));
    if (side.model != ModelChoice::automatic && std::ranges::find(models, name_of(side.model)) == models.end())
        throw table.error(table.has("integrator") ? "integrator" : "model", "\"{}\" supports {}, not model = \"{}\"",
                          side.integrator, fmt::join(models, " and "), name_of(side.model));
    if (side.stabilise == Stabilise::baumgarte && method.name == "taylor")
        throw table.error("stabilise",
                          "\"baumgarte\" adds terms without a Taylor series; use \"projection\" or another "
                          "integrator than \"taylor\"");
    if (side.stabilise != Stabilise::none && !method.angles)
        throw table.error("stabilise", "is not needed with \"{}\", which keeps the constraints itself",
                          side.integrator);
}

/// Reads the file relative to the preset, to the current folder, or the built-in one.
void read_file(TrackSpec& spec, const std::string& preset_path, bool from_command_line) {
    const auto path = path_beside(preset_path, spec.file, from_command_line);
    const auto built_in = std::find_if(scene_files().begin(), scene_files().end(),
                                       [&](const EmbeddedFile& file) { return file.name == spec.file; });
    std::error_code ignored;
    const bool is_built_in = built_in != scene_files().end() && !std::filesystem::exists(path, ignored);
    if (!is_built_in) spec.file = path;
    const auto text = is_built_in ? std::string(built_in->contents) : text_of_track(path);
    spec.sha256 = sha256_of_text(text);
    spec.track = std::make_shared<const Track>(tracks_of_texts({spec.file}, {text}));
}

/// Reads the file of a side's track, if it has one. Throws Error or records it, as the reader of its table does. Keys of
/// a simulation have no effect then; in a file they may be those of a resolved preset, which has them all.
void load_track(TomlReader& side_table, SideSpec& side) {
    if (side.track.is_none()) return;
    for (const auto* key : {"angle_deg", "omega_deg_per_s", "model", "integrator", "step_s", "tolerance", "accuracy",
                            "precision", "stabilise"}) {
        auto typed = side_table.elements_of(key);
        if (side_table.from_command_line(key)) typed.emplace_back(key, 0);
        for (const auto& [name, element] : typed)
            side_table.refuse(side_table.error(name, "has no effect, because the side shows a measured track"));
    }
    auto table = side_table.inner("track");
    const bool is_read = table.guarded("file", [&] {
        if (!side.particles.empty() || side.links() != 2)
            throw bad_input("is of two links; the side has {}",
                            side.particles.empty()
                                ? fmt::format("{} link{}", side.links(), side.links() == 1 ? "" : "s")
                                : "particles");
        read_file(side.track, table.path(), table.from_command_line("file"));
    });
    if (is_read) table.guarded("start_s", [&] { replay_of(side.track); });
}

/// Throws if a constraint or force of a table names a particle that the side does not have.
void check_ends(const SideSpec& side, TomlReader& table) {
    std::vector<TomlReader> parts = table.entries("constraint"), forces = table.entries("force");
    std::ranges::move(forces, std::back_inserter(parts));
    if (parts.empty()) return;
    const auto all = particle_names(side);
    const std::set<std::string_view> names(all.begin(), all.end());
    for (auto& part : parts)
        for (const auto* key : {"particle", "from", "to"}) {
            std::optional<EndSpec> end;
            part({.key = key}, end);
            const auto* name = end ? std::get_if<std::string>(&*end) : nullptr;
            if (name && !names.contains(*name))
                throw part.error(key, "must name a particle; there is no \"{}\"{}", *name,
                                 did_you_mean("; ", *name, {all.begin(), all.end()}));
        }
}

/// Where keys of pivots are given: a table [system.pivot], [a.pivot] or [b.pivot], or the axis of a grid that varies
/// the key `varied`.
struct PivotKeys {
    TomlReader table;
    std::string_view sides;  // that they are about
    std::string varied = {};

    bool has(std::string_view key) {
        return varied.empty() ? table.has(key) : varied.ends_with(fmt::format(".pivot.{}", key));
    }
};

/// Refuses keys of pivots that have no effect, because no table and no axis gives their amplitude.
void check_pivots(std::vector<PivotKeys> given, TomlReader top) {
    auto grid = top.inner("grid");
    for (const auto* role : {"x", "y", "color", "panel"}) {
        PivotKeys axis{grid.inner(role), "ab"};
        axis.table({.key = "key"}, axis.varied);
        for (const auto* side : {"a", "b"})
            if (axis.varied.starts_with(fmt::format("{}.", side))) axis.sides = side;
        if (!axis.varied.empty()) given.push_back(axis);
    }
    std::string moving;  // sides
    for (auto& at : given)
        if (at.varied == "system" || at.has("amplitude_m")) moving += at.sides;
    for (auto& at : given)
        for (const auto* key : {"direction_deg", "frequency_hz", "phase_deg"})
            if (moving.find_first_of(at.sides) == std::string::npos && at.has(key))
                throw at.varied.empty() ? at.table.error(key, "has no effect without amplitude_m")
                                        : at.table.error("key", "\"{}\" has no effect without amplitude_m", at.varied);
}

/// Refuses particles of one side that would replace the chain of [system] without a word.
void check_chain_is_kept(TomlReader& side, TomlReader& system) {
    if (!side.has("particle") || system.has("particle")) return;
    for (const auto& key : chain_keys)
        if (system.has(key))
            return side.refuse(side.error("particle",
                                          "describes another system than the chain of [system] {}; remove one of "
                                          "them, or give that key in the other side",
                                          key)
                                   .with(std::string(key)));
}

/// Reads [system], [a] or [b]; `has_text` = including side_text_fields().
void read_side(TomlReader& table, SideSpec& side, bool has_text) {
    if (has_text) side_text_fields(table, side);
    read_physical_chain(table, side);
    read_mechanism(table, side);
    gravity_field(table, side);
    table(model_field, side.model);
    if (!read_accuracy(table, side)) {
        if (table.has("integrator")) side.integrator_from_command_line = table.from_command_line("integrator");
        method_fields(table, side);
    }
    precision_fields(table, side);
    table.finish();
    table.check_together([&] { check_choices(table, side); });
}

}  // namespace

std::string place_of(const Preset& preset, char letter, const Error& error) {
    const auto* placed = dynamic_cast<const PlacedError*>(&error);
    if (!placed || !preset.document) return preset.name;
    if (placed->entry) return (letter == 'a' ? preset.a : preset.b).places.at({placed->key, *placed->entry});
    auto top = preset.document->top();
    auto system = top.inner("system"), side = top.inner(std::string_view(&letter, 1));
    return (side.has(placed->key) ? side : system).place_of(placed->key).first;
}

std::vector<std::string_view> models_of(const MethodEntry& method) {
    std::vector<std::string_view> models;
    for (const auto& [has, model] : {std::pair(method.angles, Model::angles),
                                     {method.constraints, Model::constraints},
                                     {method.mechanism, Model::mechanism}})
        if (has) models.push_back(name_of(model));
    return models;
}

void SideSpec::set_links(std::size_t links) {
    if (links == this->links()) return;
    mass_kg.assign(links, 1);
    length_m.assign(links, 1);
    angle_deg.assign(links, 90);
    omega_deg_per_s.assign(links, 0);
    for (const auto& property : PhysicalSpec::properties) (physical.*property.member).assign(links, 0);
    physical.center_m.clear();
}

bool is_zero(const std::vector<Quad>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](const Quad& value) { return value == 0; });
}

bool PhysicalSpec::has(const Property& property) const {
    const auto& values = this->*property.member;
    return property.absent.empty() ? !is_zero(values) : !values.empty();
}

bool PhysicalSpec::is_none() const {
    return torques.empty() && pivot.amplitude_m == 0 &&
           std::ranges::none_of(properties, [&](const Property& property) { return has(property); });
}

bool differ_in_kind(const SideSpec& a, const SideSpec& b) {
    return a.particles.empty() != b.particles.empty() || a.masses() != b.masses();
}

void read_release(TomlReader& table, SideSpec& side, bool is_physical) {
    if (is_physical)
        read_physical_chain(table, side);
    else
        chain_fields(table, side);
    gravity_field(table, side);
    table.finish();
    if (is_physical) table.check_together([&] { check_masses(table, side); });
}

void read_sides(const std::vector<TomlReader*>& levels, Preset& preset, bool is_film) {
    std::vector<TomlReader> systems;
    std::vector<PivotKeys> pivots;
    for (auto* level : levels) {
        read_side(systems.emplace_back(level->inner("system")), preset.a, false);
        pivots.push_back({systems.back().inner("pivot"), "ab"});
    }
    preset.b = preset.a;
    for (auto* level : levels) {
        auto a = level->inner("a"), b = level->inner("b");
        for (auto& system : systems) {
            check_chain_is_kept(a, system);
            check_chain_is_kept(b, system);
        }
        read_side(a, preset.a, is_film);
        read_side(b, preset.b, is_film);
        load_track(a, preset.a);
        load_track(b, preset.b);
        pivots.push_back({a.inner("pivot"), "a"});
        pivots.push_back({b.inner("pivot"), "b"});
        b.check_together([&] {
            for (auto& system : systems)
                for (const auto* side : {&preset.a, &preset.b}) check_ends(*side, system);
            check_ends(preset.a, a);
            check_ends(preset.b, b);
            if (level == levels.back()) check_pivots(pivots, *levels.front());
            if (!is_film && preset.a.links() != preset.b.links())
                throw b.error("links",
                              "must be that of the other side, so that the two can be compared; they are {} and {}",
                              preset.a.links(), preset.b.links());
            const bool is_chain_a = preset.a.particles.empty(), is_chain_b = preset.b.particles.empty();
            if ((is_chain_a && is_chain_b) || (is_film && is_chain_a != is_chain_b)) return;
            if (const auto of_a = particle_names(preset.a), of_b = particle_names(preset.b); of_a != of_b)
                throw b.error("particle", "must be those of side a in their order, {}, to be compared; they are {}",
                              fmt::join(of_a, ", "), fmt::join(of_b, ", "));
        });
    }
}

}  // namespace doppel
