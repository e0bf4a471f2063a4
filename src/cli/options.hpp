#pragma once

#include "scene/preset.hpp"
#include "scene/run.hpp"

#include <CLI/App.hpp>

#include <string>
#include <vector>

namespace doppel {

/// What commands that take presets have in common, as it was typed.
struct PresetOptions {
    std::vector<std::string> presets, sets;
};

/// What commands that run presets have besides.
struct RunCommandOptions : PresetOptions {
    std::string out = "out", progress = "auto";
    int jobs = 0;
};

void add_preset_options(CLI::App& command, PresetOptions& options);
void add_run_options(CLI::App& command, RunCommandOptions& options);

/// The scene of each preset, all of them read before the first one runs. `more` = overrides from other options.
std::vector<Scene> read_scenes(const PresetOptions& options, const std::vector<Override>& more = {});

/// Runs the scenes one after the other and tells the person how far they are.
void run_all(const std::vector<Scene>& scenes, const RunCommandOptions& options, const RunOptions& run_options);

}  // namespace doppel
