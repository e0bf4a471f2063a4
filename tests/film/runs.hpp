#pragma once

#include "film/run.hpp"
#include "film/support.hpp"
#include "output/fixtures.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace doppel {

/// The film butterfly with this duration in a small picture.
inline Scene small_scene(std::vector<std::string> more = {}, const std::string& duration_s = "0.5") {
    more.insert(more.begin(), {"video.size=[320, 180]", "scene.duration_s=" + duration_s});
    return scene_of("butterfly", more);
}

inline RunResult render(const Scene& scene, const RunOptions& options) {
    return run(scene, options, never_stopped, [](const Progress&) {});
}

/// The manifest of a run without pictures.
inline nlohmann::json manifest_of(const Scene& scene, const std::filesystem::path& out = test::fresh_folder()) {
    render(scene, {.out = out, .pictures = false});
    return nlohmann::json::parse(test::bytes_of(out / scene.preset.name / (scene.preset.name + ".json")));
}

/// The names of the files in a folder.
inline std::set<std::string> files_in(const std::filesystem::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.insert(entry.path().filename().string());
    return names;
}

/// The lines of a CSV file, without line ends.
inline std::vector<std::string> lines_of(const std::filesystem::path& path) {
    std::istringstream text(test::bytes_of(path));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line, '\n');) {
        EXPECT_TRUE(line.ends_with('\r')) << "RFC 4180 ends lines with CR LF";
        lines.push_back(line.substr(0, line.size() - 1));
    }
    return lines;
}

inline std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells;
    std::string cell;
    for (std::istringstream text(line + ","); std::getline(text, cell, ',');) cells.push_back(cell);
    return cells;
}

/// The table of a run without pictures.
inline std::vector<std::string> table_of(const Scene& scene, const std::vector<std::string>& columns = {}) {
    const auto out = test::fresh_folder();
    render(scene, {.out = out, .pictures = false, .columns = columns});
    return lines_of(out / scene.preset.name / (scene.preset.name + ".csv"));
}

}  // namespace doppel
