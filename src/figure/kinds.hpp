#pragma once

#include "analysis/external_method.hpp"
#include "figure/work.hpp"
#include "integrate/methods.hpp"
#include "integrate/motion.hpp"
#include "scene/field_table.hpp"
#include "scene/preset_fields.hpp"

#include <memory>
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

    /// "[table]" and its keys. Throws as TomlReader::finish() does.
    std::string finish() const {
        TomlReader::finish();
        return fmt::format("\n[{}]\n{}", bare_name(), writer_.text());
    }

private:
    TomlWriter writer_;
};

/// A preset being read: each kind of figure takes the tables that are its own.
struct FigureReader {
    std::string name;  // of the preset
    const TomlDocument& document;
    TomlReader &top, &scene, &chart;  // of [chart], a kind may take keys of its own
    std::span<const ExternalMethod> external_methods = {};

    SettingsReader table(std::string_view key) { return SettingsReader(document.table(top, key)); }
    /// The pair that [scene], [system], [a] and [b] describe, with `more` levels on top (scene/preset_tables.hpp).
    Preset pair(const std::vector<TomlReader*>& more = {});
    /// The chain that [system] describes, where the figure itself knows how to step it.
    SideSpec release();
};

/// Whether the method can step the model.
inline bool serves(const MethodEntry& method, Model model) {
    return model == Model::angles ? method.angles : model == Model::constraints ? method.constraints : method.mechanism;
}

/// Throws Error (exit 2) where no method has that name, one of `methods`.
const MethodEntry& method_named(const TomlReader& table, const std::string& name);

/// What sweeps and maps vary in a release.
struct ReleaseParameter {
    std::string_view name, label;  // the column's, the axis's
    std::size_t links;             // that it takes, at least
    void (*set)(SideSpec&, const Quad&);
    double every;   // between ticks; 0 = as fits
    bool is_ratio;  // > 0
};
const ReleaseParameter& release_parameter(std::string_view name);
/// `parameter`, one of these names.
template <class Visit>
void parameter_field(Visit& visit, std::span<const std::string_view> names, const ReleaseParameter*& parameter) {
    std::string name(parameter->name);
    visit({.key = "parameter", .help = "what the releases differ in", .names = names}, name);
    parameter = &release_parameter(name);
}

/// Throws Error (exit 2) where one of the names of a key is there twice.
void check_distinct(const TomlReader& table, std::string_view key, const std::vector<std::string>& names);

/// A kind of figure. Each is a class whose constructor takes a FigureReader, and whose tables are listed by
/// fields(visit), which visits each key with its member, as the lists of scene/preset_fields.hpp do.
struct FigureKind {
    enum class System { none, release, pair };  // what moves
    std::string_view name;                      // of [scene] kind
    System system;
    std::shared_ptr<const FigureWork> (*read)(FigureReader&);
    std::vector<FieldTable> (*tables)();  // its own, with their defaults
};

template <class Work>
std::shared_ptr<const FigureWork> read_as(FigureReader& reader) {
    return std::make_shared<Work>(reader);
}
template <class Work>
FieldTable table_of(std::string name) {
    FieldTable table{std::move(name)};
    Work().fields(table);
    return table;
}

/// All of them; this list stands in figure/kinds.cpp and its names in scene/preset_tables.hpp.
std::span<const FigureKind> figure_kinds();

// One file each.
extern const FigureKind sweep_kind, curves_kind, convergence_kind, spectrum_kind, section_kind, flip_map_kind,
    links_kind, work_precision_kind, stability_kind, drift_kind, audit_kind;

}  // namespace doppel
