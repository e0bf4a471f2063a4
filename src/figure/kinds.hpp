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

/// Reads the tables of one kind of figure, and keeps what it read as TOML including defaults: reader(field, member).
class SettingsReader : public TomlReader {
public:
    explicit SettingsReader(TomlReader table) : TomlReader(std::move(table)) {}

    template <class T>
    void operator()(const Field& field, T& into) {
        TomlReader::operator()(field, into);
        if constexpr (!std::is_same_v<T, Rational>)
            writer_(field, into);
        else if (field.only.applies)
            writer_.add(field.key, toml_text(into.text()));
    }

    /// Reads the keys of [NAME.key].
    template <class Visit>
    void table(std::string_view key, const Visit& visit) {
        SettingsReader inside(inner(read_table(key), fmt::format("[{}.{}]", bare_name(), key)));
        visit(inside);
        const auto text = inside.finish();
        if (!inside.writer_.text().empty()) tables_ += text;
    }

    /// Returns "[table]" and its keys, then the inner tables. Throws as TomlReader::finish() does.
    std::string finish() const {
        TomlReader::finish();
        return fmt::format("\n[{}]\n{}{}", bare_name(), writer_.text(), tables_);
    }

private:
    TomlWriter writer_;
    std::string tables_;
};

/// A preset being read: each kind of figure reads its own tables.
struct FigureReader {
    std::string name;  // of the preset
    const TomlDocument& document;
    TomlReader &top, &scene, &chart;  // a kind may read further keys of [chart]
    std::span<const ExternalMethod> external_methods = {};
    const std::atomic<bool>& stop = never_stopped;

    /// Reads all fields of the kind's own table.
    template <class Kind>
    SettingsReader settings(Kind& kind) {
        SettingsReader table(document.table(top, Kind::table_key));
        kind.fields(table);
        return table;
    }
    /// The pair described by [scene], [system], [a] and [b], with `more` levels on top (scene/preset_fields.hpp).
    Preset pair(const std::vector<TomlReader*>& more = {});
    /// Reads the keys of such a pair, without checking them together.
    Preset read_pair(const std::vector<TomlReader*>& more = {});
    std::vector<TomlReader> entries(std::string_view key);
    /// The chain that [system] describes, for figures that integrate it themselves. `physical`: links with mass,
    /// friction and drives are allowed.
    SideSpec release(bool physical = false);
};

inline bool supports(const MethodEntry& method, Model model) {
    return model == Model::angles ? method.angles : model == Model::constraints ? method.constraints : method.mechanism;
}

/// The method of that name; throws Error (exit 2) if there is none. The name is one of the key `methods`.
const MethodEntry& method_named(const TomlReader& table, const std::string& name);

/// The film preset of that name or path, given by the table's key `scene`. Throws Error (exit 2).
Preset film_named(const std::string& name, const TomlReader& table);

/// The text as TOML comments: data that the numbers depend on and no key contains, such as a film's file.
std::string commented(std::string_view text);

/// Throws Error (exit 2) if a key lists a name twice.
void check_distinct(const TomlReader& table, std::string_view key, const std::vector<std::string>& names);

/// Whether both sides have the same release, so that their initial distance is 0.
bool have_same_release(const SideSpec& a, const SideSpec& b);

/// Whether both sides are the same system with the same release and integration: they move identically.
bool are_one(const Scene& scene);

/// An entry of the list of kinds.
struct FigureKind {
    enum class System { none, release, pair };  // how the preset describes the system
    std::string_view name;                      // in [scene]
    System system;
    std::shared_ptr<const Experiment> (*read)(FigureReader&);
    void (*read_keys)(FigureReader&, System);  // each key by itself, so that all errors are found
    std::vector<FieldTable> (*tables)();       // the kind's own, with their defaults
};

/// A kind is a class constructed from a FigureReader. `table_key` is the name of the table with its own keys, if it has
/// any. fields(visit) visits each with its member, as in scene/preset_fields.hpp. other_table() lists further keys, and
/// read_others() reads them.
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

/// The list is in figure/kinds.cpp, the names are in scene/preset_fields.hpp.
std::span<const FigureKind> figure_kinds();

// Each is defined in a file of its own.
extern const FigureKind grid_kind, series_kind, section_kind, work_precision_kind;

}  // namespace doppel
