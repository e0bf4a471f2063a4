#include "embedded/scene.hpp"
#include "output/written.hpp"
#include "scene/preset_fields.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace doppel {
namespace {

/// Reads the file relative to the preset, to the current folder, or the built-in one.
void read_file(TrackSpec& spec, const std::string& preset_path, bool from_command_line) {
    const auto path = path_beside(preset_path, spec.file, from_command_line);
    const auto built_in = std::find_if(scene_files().begin(), scene_files().end(),
                                       [&](const EmbeddedFile& file) { return file.name == spec.file; });
    std::error_code ignored;
    const bool is_built_in = built_in != scene_files().end() && !std::filesystem::exists(path, ignored);
    if (!is_built_in) spec.file = path;
    const auto text = is_built_in ? std::string(built_in->contents) : text_of_track(path);
    spec.sha256 = sha256_of_text(text);
    spec.track = std::make_shared<const Track>(tracks_of_texts({spec.file}, {text}));
}

}  // namespace

void load_track(const TomlDocument& document, TomlReader& side_table, SideSpec& side) {
    if (side.track.is_none()) return;
    auto table = side_table.inner("track");
    const bool is_read = table.guarded("file", [&] {
        if (!side.particles.empty() || side.links() != 2)
            throw bad_input("a track needs two links; the side has {}",
                            side.particles.empty()
                                ? fmt::format("{} link{}", side.links(), side.links() == 1 ? "" : "s")
                                : "particles");
        read_file(side.track, document.path, table.from_command_line("file"));
    });
    if (is_read) table.guarded("start_s", [&] { replay_of(side.track); });
}

Replay replay_of(const TrackSpec& spec) {
    const Quad degree = pi_of<Quad>() / 180;
    std::array<double, 2> offset{};
    std::transform(spec.offset_deg.begin(), spec.offset_deg.end(), offset.begin(),
                   [&](const Quad& angle) { return static_cast<double>(Quad(angle * degree)); });
    std::optional<double> start;
    if (spec.start_s) start = static_cast<double>(*spec.start_s);
    return replay_from(spec.track, start, offset);
}

Rational longest_duration(const Replay& replay, const Rational& sample_hz) {
    constexpr double rounding = 1e-9;  // s
    const auto samples = static_cast<long>(std::floor((replay.length() + rounding) * sample_hz.value()));
    return *quotient({samples, 1}, sample_hz);
}

}  // namespace doppel
