#pragma once

#include "film/run.hpp"
#include "film/support.hpp"
#include "output/fixtures.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace doppel {

/// Half a second of butterfly in a little picture.
inline Scene small_scene(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"video.size=[320, 180]", "scene.duration_s=0.5"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return scene_of("butterfly", arguments);
}

inline RunResult render(const Scene& scene, const RunOptions& options) {
    const std::atomic<bool> never = false;
    return run(scene, options, never, [](const Progress&) {});
}

/// Of a CSV file, without their ends.
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

}  // namespace doppel
