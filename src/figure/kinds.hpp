#pragma once

#include "analysis/external_method.hpp"
#include "figure/work.hpp"
#include "integrate/methods.hpp"
#include "integrate/motion.hpp"
#include "scene/preset_tables.hpp"
#include "scene/resolved.hpp"

#include <memory>
#include <span>
#include <string_view>

namespace doppel {

/// Reads the table that is a kind's own, and keeps what it read as TOML, defaults included: one list of keys for both.
class SettingsReader : public TomlReader {
public:
    explicit SettingsReader(TomlReader table)
        : TomlReader(std::move(table)), text_(fmt::format("\n[{}]\n", bare_name())) {}

    void read_whole(std::string_view key, int& into, int least, int most) {
        keep(key, into, [&] { TomlReader::read_whole(key, into, least, most); });
    }
    void read_truth(std::string_view key, bool& into) {
        keep(key, into, [&] { TomlReader::read_truth(key, into); });
    }
    template <class Number>  // double or Quad
    void read_number(std::string_view key, Number& into) {
        keep(key, into, [&] { TomlReader::read_number(key, into); });
    }
    template <class Number>
    void read_positive(std::string_view key, Number& into) {
        keep(key, into, [&] { TomlReader::read_positive(key, into); });
    }
    void read_positive_ratio(std::string_view key, Rational& into) {
        keep(key, into, [&] { TomlReader::read_positive_ratio(key, into); });
    }
    void read_positive_list(std::string_view key, std::vector<double>& into, std::size_t most) {
        keep(key, into, [&] { TomlReader::read_positive_list(key, into, most); });
    }
    void read_text(std::string_view key, std::string& into) {
        keep(key, into, [&] { TomlReader::read_text(key, into); });
    }
    void read_choice(std::string_view key, std::string& into, std::span<const std::string_view> choices) {
        keep(key, into, [&] { TomlReader::read_choice(key, into, choices); });
    }
    void read_texts(std::string_view key, std::vector<std::string>& into);

    /// "[table]" and its keys. Throws as TomlReader::finish() does.
    const std::string& finish() const {
        TomlReader::finish();
        return text_;
    }

private:
    template <class Value, class Read>
    void keep(std::string_view key, const Value& value, Read&& read) {
        read();
        if constexpr (std::is_same_v<Value, Quad>)
            text_ += fmt::format("{} = {}\n", key, text_of(value));
        else if constexpr (std::is_same_v<Value, Rational>)
            text_ += fmt::format("{} = {}\n", key, toml_text(value.text()));
        else if constexpr (std::is_same_v<Value, std::string>)
            text_ += fmt::format("{} = {}\n", key, toml_text(value));
        else if constexpr (std::is_same_v<Value, std::vector<double>>)
            text_ += fmt::format("{} = [{}]\n", key, fmt::join(value, ", "));
        else
            text_ += fmt::format("{} = {}\n", key, value);
    }
    std::string text_;
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
/// `parameter`, one of these, of which the first is the default. Throws Error (exit 2).
const ReleaseParameter& read_parameter(SettingsReader& table, std::span<const std::string_view> names);

/// Throws Error (exit 2) where one of the names of a key is there twice.
void check_distinct(const TomlReader& table, std::string_view key, const std::vector<std::string>& names);

struct FigureKind {
    std::string_view name;  // of [scene] kind
    std::shared_ptr<const FigureWork> (*read)(FigureReader&);
};

/// All of them; this list stands in figure/kinds.cpp and its names in scene/preset_tables.hpp.
std::span<const FigureKind> figure_kinds();

// One file each.
extern const FigureKind sweep_kind, curves_kind, convergence_kind, spectrum_kind, section_kind, flip_map_kind,
    links_kind, work_precision_kind, stability_kind, drift_kind, audit_kind;

template <class Kind>
std::shared_ptr<const FigureWork> read_as(FigureReader& reader) {
    return std::make_shared<Kind>(reader);
}

}  // namespace doppel
