#pragma once

#include "figure/chart.hpp"
#include "figure/experiment.hpp"
#include "scene/preset.hpp"

#include <memory>

namespace doppel {

/// A figure described by a preset file: read, completed and checked, not yet computed.
struct FigurePreset {
    std::string name;             // of the file, without folder and extension
    std::string title, subtitle;  // if not given: the name; the experiment's subtitle
    std::vector<std::string> captions;
    std::string erratum;  // where the study's printed caption is wrong
    std::string kind;     // of [scene]
    ChartSpec chart;
    std::shared_ptr<const Experiment> experiment;

    /// The settings that its numbers depend on, TOML.
    std::string resolved_work() const;
    /// All settings; read_figure() reads this TOML back to the same figure.
    std::string resolved() const;
};

/// The keys outside of tables.
void top_fields(KeyVisitor& visit, FigurePreset& figure);

/// Errors as read_preset(), and exit 130 soon after `stop` is set.
FigurePreset read_figure(const PresetText& source, const std::vector<Override>& overrides = {},
                         const std::atomic<bool>& stop = never_stopped);

}  // namespace doppel
