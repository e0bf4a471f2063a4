#pragma once

#include "analysis/work_precision.hpp"
#include "figure/chart.hpp"
#include "figure/experiment.hpp"
#include "scene/field_table.hpp"
#include "scene/preset.hpp"

#include <memory>

namespace doppel {

/// A figure as a preset file describes it: read, complete and checked, nothing computed yet.
struct FigurePreset {
    std::string name;             // of the file, without folder and ending
    std::string title, subtitle;  // where they are not given: the name; what the experiment says of itself
    std::vector<std::string> captions;
    std::string erratum;  // where the study's printed caption and the truth differ
    std::string kind;     // of [scene]
    ChartSpec chart;
    std::shared_ptr<const Experiment> experiment;

    /// What its numbers depend on: TOML.
    std::string resolved_work() const;
    /// That and everything else: TOML that read_figure() reads back to the same figure.
    std::string resolved() const;
};

/// Errors as read_preset()'s, and exit 130 soon after `stop` is set. Work–precision diagrams also show `external_methods`,
/// which outlive the figure.
FigurePreset read_figure(const PresetText& source, const std::vector<Override>& overrides = {},
                         std::span<const ExternalMethod> external_methods = {},
                         const std::atomic<bool>& stop = never_stopped);

/// What all figures have, then the tables that are a kind's own (figure/kinds.hpp).
std::vector<FieldTable> figure_tables();

/// The tables that a preset of this kind may have, those of particles, constraints and forces aside: "[]" for the keys
/// outside of tables, "[scene]", "[system]", "[a]" … and "[[curve]]".
std::vector<FieldTable> tables_of(std::string_view kind);

/// What a preset may say, as a JSON schema (Draft 4).
std::string preset_schema();

/// A page of docs/ that lists keys.
struct ReferencePage {
    std::string file, text;
};
/// All tables and keys of films, of [video], and of figures.
std::vector<ReferencePage> reference_pages();

}  // namespace doppel
