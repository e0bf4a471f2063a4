#pragma once

#include "figure/experiment.hpp"
#include "integrate/methods.hpp"
#include "integrate/motion.hpp"
#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

#include <memory>
#include <span>
#include <string_view>

namespace doppel {

/// The kind's own table with all its keys, TOML.
template <class Kind>
std::string settings_text(Kind& kind) {
    TomlWriter writer{std::string(Kind::table_key)};
    kind.fields(writer);
    return fmt::format("\n[{}]\n{}", Kind::table_key, writer.text());
}

/// A preset being read: each kind of figure reads its own tables.
struct FigureReader {
    std::string name;  // of the preset
    const TomlDocument& document;
    TomlReader &top, &scene, &chart;  // a kind may read further keys of [chart]
    const std::atomic<bool>& stop = never_stopped;
    bool only_keys = false;  // each key is read by itself, so that all errors are found, and nothing is checked further

    /// Reads all fields of the kind's own table.
    template <class Kind>
    TomlReader settings(Kind& kind) {
        auto table = document.table(top, Kind::table_key);
        kind.fields(table);
        table.finish();
        return table;
    }
    /// The pair described by [scene], [system], [a] and [b], with `more` levels on top (scene/preset_fields.hpp).
    Preset pair(const std::vector<TomlReader*>& more = {});
    std::vector<TomlReader> entries(std::string_view key);
    /// The chain that [system] describes, for figures that integrate it themselves. `physical`: links with mass,
    /// friction and drives are allowed.
    SideSpec release(bool physical = false);
};

/// Throws Error (exit 2) if a key lists a name twice.
void check_distinct(const TomlReader& table, std::string_view key, const std::vector<std::string>& names);

/// Whether both sides have the same release, so that their initial distance is 0.
bool have_same_release(const SideSpec& a, const SideSpec& b);

/// Whether both sides are the same system with the same release and integration: they move identically.
bool are_one(const Scene& scene);

/// An entry of the list of kinds.
struct FigureKind {
    std::string_view name;  // in [scene]
    std::shared_ptr<const Experiment> (*read)(FigureReader&);
    void (*list)(KeyVisitor&);  // visits the kind's own tables, with their defaults
};

/// A kind is a class constructed from a FigureReader; with only_keys, the constructor returns when it has read all keys.
/// `table_key` is the name of the table with its own keys. fields(visit) visits each with its member, as in
/// scene/preset_fields.hpp; further_fields(visit), those that it has in [chart].
template <class Kind>
constexpr FigureKind kind_of(std::string_view name) {
    return {name,
            [](FigureReader& reader) -> std::shared_ptr<const Experiment> { return std::make_shared<Kind>(reader); },
            [](KeyVisitor& visit) {
                Kind kind;
                visit.table(Kind::table_key, [&](KeyVisitor& table) { kind.fields(table); });
                if constexpr (requires { kind.further_fields(visit); })
                    visit.table("chart", [&](KeyVisitor& table) { kind.further_fields(table); });
            }};
}

/// The list is in figure/kinds.cpp, the names are in scene/preset_fields.hpp.
std::span<const FigureKind> figure_kinds();

// Each is defined in a file of its own.
extern const FigureKind grid_kind, series_kind, section_kind, work_precision_kind;

}  // namespace doppel
