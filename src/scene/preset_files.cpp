#include "base/error.hpp"
#include "base/read_file.hpp"
#include "base/text.hpp"
#include "embedded/scene.hpp"
#include "scene/preset.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

namespace doppel {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view ending = ".toml";

/// Folders of presets: films, then figures.
constexpr std::array<std::string_view, 2> folders{"presets/", "presets/figures/"};

constexpr std::size_t max_bytes = std::size_t{8} << 20;  // 10 000 links with every number to 34 digits take 4 MB

PresetText read_file(const fs::path& path, const std::string& call, const std::atomic<bool>* stop) {
    PresetText preset{.name = path.stem().string(), .path = path.string(), .text = {}, .call = call};
    constexpr WantedFile wanted{"a preset is a TOML file", max_bytes, "there is no such preset"};
    preset.text = read_whole_file(path, wanted, stop);
    check_preset_name(preset.path, preset.name);
    return preset;
}

}  // namespace

void check_preset_name(const std::string& path, const std::string& name) {
    const auto refuse = [&](const std::string& why) {
        throw bad_input("{}: the name of the preset, \"{}\", is used for its folder and files, and {}; rename it", path,
                        name, why);
    };
    if (name == "." || name == "..") refuse("leads out of it");
    if (!is_utf8(name)) refuse("is not UTF-8");
    for (std::string_view rest = name; !rest.empty();)
        if (const auto character = next_character(rest); is_control(character))
            refuse(fmt::format("contains the control character U+{:04X}", static_cast<unsigned>(character)));
    if (name.size() > longest_preset_name)
        refuse(fmt::format("has {} bytes; at most {} are possible", name.size(), longest_preset_name));
}

std::string path_beside(const std::string& preset_path, const std::string& given, bool from_command_line) {
    std::error_code ignored;
    const auto beside = fs::path(preset_path).parent_path() / given;
    return !from_command_line && fs::exists(beside, ignored) ? beside.string() : given;
}

std::vector<PresetText> builtin_presets() {
    std::vector<PresetText> presets;
    for (const auto& file : scene_files()) {
        if (!file.name.ends_with(ending)) continue;
        const fs::path path = fs::path("presets") / file.name;
        const auto name = path.stem().string();
        presets.push_back({name, path.string(), std::string(file.contents), name});
    }
    std::sort(presets.begin(), presets.end(), [](const auto& x, const auto& y) { return x.name < y.name; });
    return presets;
}

PresetText find_preset(const std::string& name_or_path, const std::atomic<bool>* stop) {
    if (name_or_path.find('/') != std::string::npos || name_or_path.ends_with(ending))
        return read_file(name_or_path, name_or_path, stop);

    std::error_code ignored;
    for (const auto folder : folders)
        if (const auto path = fmt::format("{}{}{}", folder, name_or_path, ending); fs::exists(path, ignored))
            return read_file(path, name_or_path, stop);
    const auto presets = builtin_presets();
    std::vector<std::string_view> names;
    for (const auto& preset : presets) {
        if (preset.name == name_or_path) return preset;
        names.push_back(preset.name);
    }
    if (fs::is_regular_file(name_or_path, ignored)) return read_file(name_or_path, name_or_path, stop);
    if (const auto file = fmt::format("{}{}", name_or_path, ending); fs::is_regular_file(file, ignored))
        throw bad_input("there is no preset \"{}\"; did you mean {}?", name_or_path, file);
    throw bad_input("there is no preset \"{}\"; {}", name_or_path,
                    did_you_mean("", name_or_path, names, fmt::format("there are {}", fmt::join(names, ", "))));
}

}  // namespace doppel
