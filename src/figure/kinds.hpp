#pragma once

#include "analysis/external_method.hpp"
#include "figure/work.hpp"
#include "integrate/methods.hpp"
#include "integrate/motion.hpp"
#include "scene/preset_tables.hpp"

#include <memory>
#include <span>
#include <string_view>

namespace doppel {

/// A preset being read: each kind of figure takes the tables that are its own.
struct FigureReader {
    std::string name;  // of the preset
    const TomlDocument& document;
    TomlReader &top, &scene, &chart;  // of [chart], a kind may take keys of its own
    std::span<const ExternalMethod> external_methods = {};

    TomlReader table(std::string_view key) { return document.table(top, key); }
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
const ReleaseParameter& read_parameter(TomlReader& table, std::span<const std::string_view> names);

/// ["a", "b"]
std::string toml_list(const std::vector<std::string>& texts);

/// Throws Error (exit 2) where one of the names of a key is there twice.
void check_distinct(const TomlReader& table, std::string_view key, const std::vector<std::string>& names);

struct FigureKind {
    std::string_view name;  // of [scene] kind
    std::shared_ptr<const FigureWork> (*read)(FigureReader&);
};

/// All of them; this list stands in figure/kinds.cpp and its names in scene/preset_tables.hpp.
std::span<const FigureKind> figure_kinds();

// One file each.
std::shared_ptr<const FigureWork> read_sweep(FigureReader& reader);
std::shared_ptr<const FigureWork> read_curves(FigureReader& reader);
std::shared_ptr<const FigureWork> read_convergence(FigureReader& reader);
std::shared_ptr<const FigureWork> read_spectrum(FigureReader& reader);
std::shared_ptr<const FigureWork> read_section(FigureReader& reader);
std::shared_ptr<const FigureWork> read_flip_map(FigureReader& reader);
std::shared_ptr<const FigureWork> read_links(FigureReader& reader);
std::shared_ptr<const FigureWork> read_audit(FigureReader& reader);
std::shared_ptr<const FigureWork> read_work_precision(FigureReader& reader);
std::shared_ptr<const FigureWork> read_stability(FigureReader& reader);
std::shared_ptr<const FigureWork> read_drift(FigureReader& reader);

}  // namespace doppel
