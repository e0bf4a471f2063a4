#pragma once

#include "analysis/work_precision.hpp"
#include "figure/experiment.hpp"
#include "integrate/methods.hpp"
#include "integrate/motion.hpp"
#include "scene/field_table.hpp"
#include "scene/preset_fields.hpp"
#include "scene/scene.hpp"

#include <memory>
#include <optional>
#include <span>
#include <string_view>

namespace doppel {

/// Reads the table that is a kind's own, and keeps what it read as TOML, defaults included: reader(field, member).
class SettingsReader : public TomlReader {
public:
    explicit SettingsReader(TomlReader table) : TomlReader(std::move(table)) {}

    template <class T>
    void operator()(const Field& field, T& into) {
        TomlReader::operator()(field, into);
        if constexpr (!std::is_same_v<T, Rational>)
            writer_(field, into);
        else if (field.only.holds)
            writer_.add(field.key, toml_text(into.text()));
    }

    /// The keys of [NAME.key], and no others.
    template <class Visit>
    void table(std::string_view key, const Visit& visit) {
        SettingsReader inside(inner(read_table(key), fmt::format("[{}.{}]", bare_name(), key)));
        visit(inside);
        const auto text = inside.finish();
        if (!inside.writer_.text().empty()) tables_ += text;
    }

    /// "[table]" and its keys, then the tables inside it. Throws as TomlReader::finish() does.
    std::string finish() const {
        TomlReader::finish();
        return fmt::format("\n[{}]\n{}{}", bare_name(), writer_.text(), tables_);
    }

private:
    TomlWriter writer_;
    std::string tables_;
};

/// A preset being read: each kind of figure takes the tables that are its own.
struct FigureReader {
    std::string name;  // of the preset
    const TomlDocument& document;
    TomlReader &top, &scene, &chart;  // of [chart], a kind may take keys of its own
    std::span<const ExternalMethod> external_methods = {};
    const std::atomic<bool>& stop = never_stopped;

    /// The kind's own table, all of its fields read.
    template <class Kind>
    SettingsReader settings(Kind& kind) {
        SettingsReader table(document.table(top, Kind::table_key));
        kind.fields(table);
        return table;
    }
    /// The pair that [scene], [system], [a] and [b] describe, with `more` levels on top (scene/preset_fields.hpp).
    Preset pair(const std::vector<TomlReader*>& more = {});
    /// The keys of such a pair, without looking at what they say together.
    Preset read_pair(const std::vector<TomlReader*>& more = {});
    /// The tables of [[key]].
    std::vector<TomlReader> entries(std::string_view key);
    /// The chain that [system] describes, where the figure itself knows how to step it; `physical`: with links that have
    /// mass, friction and drives.
    SideSpec release(bool physical = false);
};

/// Whether the method can step the model.
inline bool serves(const MethodEntry& method, Model model) {
    return model == Model::angles ? method.angles : model == Model::constraints ? method.constraints : method.mechanism;
}

/// Throws Error (exit 2) where no method has that name, one of `methods`.
const MethodEntry& method_named(const TomlReader& table, const std::string& name);

/// The film of that name or path, `scene` of the table. Throws Error (exit 2).
Preset film_named(const std::string& name, const TomlReader& table);

/// As lines of a comment in TOML: what numbers depend on and no key says, such as what is in a film's file.
std::string commented(std::string_view text);

/// Throws Error (exit 2) where one of the names of a key is there twice.
void check_distinct(const TomlReader& table, std::string_view key, const std::vector<std::string>& names);

/// Whether both sides are released alike: then their distance at the start is 0.
bool released_alike(const SideSpec& a, const SideSpec& b);

/// Whether both sides are one system, released and integrated alike: they move identically.
bool are_one(const Scene& scene);

/// An entry of the list of kinds.
struct FigureKind {
    enum class System { none, release, pair };  // what moves
    std::string_view name;                      // of [scene] kind
    System system;
    std::shared_ptr<const Experiment> (*read)(FigureReader&);
    void (*read_keys)(FigureReader&, System);  // each by itself, so that all their faults are found
    std::vector<FieldTable> (*tables)();       // its own, with their defaults
};

/// A kind is a class that is made of a FigureReader. If it has keys of its own, `table_key` names their table, and
/// fields(visit) visits each with its member, as the lists of scene/preset_fields.hpp do; other_table() lists further
/// ones, and read_others() reads them.
template <class Kind>
void read_keys_of(FigureReader& reader, FigureKind::System system) {
    if (system == FigureKind::System::pair) reader.read_pair();
    if (system == FigureKind::System::release) reader.release();
    if constexpr (requires { Kind::table_key; }) {
        Kind kind;
        reader.settings(kind).finish();
    }
    if constexpr (requires { Kind::read_others(reader); }) Kind::read_others(reader);
}

template <class Kind>
constexpr FigureKind kind_of(std::string_view name, FigureKind::System system) {
    return {name, system,
            [](FigureReader& reader) -> std::shared_ptr<const Experiment> { return std::make_shared<Kind>(reader); },
            read_keys_of<Kind>,
            [] {
                std::vector<FieldTable> tables;
                if constexpr (requires { Kind::table_key; })
                    Kind().fields(tables.emplace_back(FieldTable{fmt::format("[{}]", Kind::table_key)}));
                if constexpr (requires { Kind::other_table(); }) tables.push_back(Kind::other_table());
                return tables;
            }};
}

/// All of them; the list stands in figure/kinds.cpp and its names in scene/preset_fields.hpp.
std::span<const FigureKind> figure_kinds();

// One file each.
extern const FigureKind grid_kind, series_kind, section_kind, work_precision_kind;

}  // namespace doppel
