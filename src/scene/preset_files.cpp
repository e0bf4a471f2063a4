#include "embedded/scene.hpp"
#include "numeric/error.hpp"
#include "scene/nearest.hpp"
#include "scene/preset.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace doppel {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view ending = ".toml";

/// Where presets lie: films, then figures.
constexpr std::array<std::string_view, 2> folders{"presets/", "presets/figures/"};

PresetText read_file(const fs::path& path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) throw bad_input("{} is a folder; a preset is a TOML file", path.string());
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        const int reason = errno;
        throw bad_input("{}: {}", path.string(), reason == ENOENT ? "there is no such preset" : std::strerror(reason));
    }
    std::ostringstream text;
    text << file.rdbuf();
    if (file.bad()) throw io_failed("{}: cannot be read", path.string());
    return {path.stem().string(), path.string(), text.str()};
}

}  // namespace

std::vector<PresetText> builtin_presets() {
    std::vector<PresetText> presets;
    for (const auto& file : scene_files()) {
        if (!file.name.ends_with(ending)) continue;
        const fs::path path = fs::path("presets") / file.name;
        presets.push_back({path.stem().string(), path.string(), std::string(file.contents)});
    }
    std::sort(presets.begin(), presets.end(), [](const auto& x, const auto& y) { return x.name < y.name; });
    return presets;
}

PresetText find_preset(const std::string& name_or_path) {
    if (name_or_path.find('/') != std::string::npos || name_or_path.ends_with(ending)) return read_file(name_or_path);

    std::error_code ignored;
    for (const auto folder : folders)
        if (const auto path = fmt::format("{}{}{}", folder, name_or_path, ending); fs::exists(path, ignored))
            return read_file(path);
    const auto presets = builtin_presets();
    std::vector<std::string_view> names;
    for (const auto& preset : presets) {
        if (preset.name == name_or_path) return preset;
        names.push_back(preset.name);
    }
    const auto meant = nearest(name_or_path, names);
    throw bad_input(
        "there is no preset \"{}\"; {}", name_or_path,
        meant ? fmt::format("did you mean \"{}\"?", *meant) : fmt::format("there are {}", fmt::join(names, ", ")));
}

}  // namespace doppel
