#include "base/error.hpp"
#include "base/text.hpp"
#include "embedded/scene.hpp"
#include "output/folder.hpp"
#include "scene/preset.hpp"

#include <fcntl.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <system_error>

namespace doppel {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view ending = ".toml";

/// Where presets lie: films, then figures.
constexpr std::array<std::string_view, 2> folders{"presets/", "presets/figures/"};

constexpr std::size_t most_bytes = std::size_t{8} << 20;  // links = 10 000 with every number to 34 digits take 4 MB

}  // namespace

void check_preset_name(const std::string& path, const std::string& name) {
    const auto refuse = [&](const std::string& why) {
        throw bad_input("{}: the preset's name, \"{}\", becomes that of its folder and files, and {}; rename it", path,
                        name, why);
    };
    if (name == "." || name == "..") refuse("leads out of it");
    if (!is_utf8(name)) refuse("is not UTF-8");
    for (std::string_view rest = name; !rest.empty();)
        if (const auto character = next_character(rest); is_control(character))
            refuse(fmt::format("holds the control character U+{:04X}", static_cast<unsigned>(character)));
    if (name.size() > longest_preset_name)
        refuse(
            fmt::format("has {} bytes; {} are the most that leave room for endings", name.size(), longest_preset_name));
}

namespace {

/// Waits until there is something to read. Throws Error (exit 130) soon after `stop` is set.
void wait_for_bytes(const Descriptor& pipe, const std::atomic<bool>& stop) {
    constexpr int patience_ms = 50;
    pollfd wanted{.fd = pipe.number(), .events = POLLIN, .revents = 0};
    while (!stop)
        if (poll(&wanted, 1, patience_ms) > 0) return;
    throw interrupted();
}

/// All of a file, or of what comes through a pipe.
std::string contents_of(const fs::path& path, const std::atomic<bool>* stop) {
    const Descriptor file(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
    if (!file)
        throw bad_input("{}: {}", path.string(),
                        errno == ENOENT ? "there is no such preset" : std::generic_category().message(errno));
    struct stat kind {};
    fstat(file.number(), &kind);
    if (S_ISDIR(kind.st_mode)) throw bad_input("{} is a folder; a preset is a TOML file", path.string());
    const bool is_pipe = S_ISFIFO(kind.st_mode);
    if (!S_ISREG(kind.st_mode) && !(is_pipe && stop))
        throw bad_input("{} is not a file; a preset is a TOML file", path.string());
    std::string text, portion(std::size_t{1} << 16, '\0');
    for (;;) {
        if (is_pipe) wait_for_bytes(file, *stop);
        const auto count = read(file.number(), portion.data(), portion.size());
        if (count == 0) return text;
        if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
        if (count < 0) throw io_failed("{}: cannot be read: {}", path.string(), std::generic_category().message(errno));
        text.append(portion, 0, static_cast<std::size_t>(count));
        if (text.size() > most_bytes)
            throw bad_input("{} has more than {} MB; a preset is a TOML file of a few lines", path.string(),
                            most_bytes >> 20);
    }
}

PresetText read_file(const fs::path& path, const std::string& call, const std::atomic<bool>* stop) {
    PresetText preset{.name = path.stem().string(), .path = path.string(), .text = {}, .call = call};
    preset.text = contents_of(path, stop);
    check_preset_name(preset.path, preset.name);
    return preset;
}

}  // namespace

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
    const auto meant = nearest(name_or_path, names);
    throw bad_input(
        "there is no preset \"{}\"; {}", name_or_path,
        meant ? fmt::format("did you mean \"{}\"?", *meant) : fmt::format("there are {}", fmt::join(names, ", ")));
}

}  // namespace doppel
