#include "scene/manifest.hpp"

#include "output/output_file.hpp"
#include "output/sha256.hpp"
#include "scene/version.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace doppel {
namespace {

using Json = nlohmann::ordered_json;

/// A basic TOML string.
std::string quoted(const std::string& text) {
    return Json(text).dump();
}

std::string hex(const Color& color) {
    const auto channel = [](float x) { return static_cast<int>(std::lround(x * 255)); };
    return fmt::format("\"#{:02x}{:02x}{:02x}\"", channel(color.r), channel(color.g), channel(color.b));
}

/// A number where it is whole, "a/b" where it is not.
std::string ratio(const Rational& value) {
    return value.is_whole() ? value.text() : fmt::format("\"{}\"", value.text());
}

Json json_of(const std::string& toml) {
    std::ostringstream text;
    text << toml::json_formatter{toml::parse(toml)};
    return Json::parse(text.str());
}

std::string side_toml(const SideSpec& side) {
    constexpr const char* models[] = {"auto", "angles", "constraints"};
    return fmt::format(
        "links = {}\nmass_kg = [{}]\nlength_m = [{}]\nangle_deg = [{}]\nomega_deg_per_s = [{}]\ngravity_m_per_s2 = {}\n"
        "model = \"{}\"\nintegrator = \"{}\"\nstep_s = {}\nprecision = \"double\"\n",
        link_count, fmt::join(side.mass_kg, ", "), fmt::join(side.length_m, ", "), fmt::join(side.angle_deg, ", "),
        fmt::join(side.omega_deg_per_s, ", "), side.gravity_m_per_s2, models[static_cast<int>(side.model)],
        side.integrator, ratio(side.step_s));
}

Json side_json(const Side& side, double energy_error, double length_error) {
    return {{"model", name_of(side.model)},
            {"why", side.why},
            {"integrator", side.method.name},
            {"step_s", side.step.text()},
            {"steps_per_sample", side.steps_per_sample},
            {"worst_energy_error", energy_error},
            {"worst_length_error_m", length_error}};
}

/// A file of the run, or every file of a folder.
void add_files(Json& files, const std::string& name, const std::filesystem::path& path) {
    if (!std::filesystem::is_directory(path)) {
        files[name] = {{"bytes", std::filesystem::file_size(path)}, {"sha256", sha256_of_file(path)}};
        return;
    }
    std::vector<std::filesystem::path> entries(std::filesystem::directory_iterator{path}, {});
    std::sort(entries.begin(), entries.end());
    for (const auto& entry : entries) add_files(files, name + "/" + entry.filename().string(), entry);
}

}  // namespace

std::string resolved_toml(const Preset& preset) {
    const auto& video = preset.video;
    std::vector<std::string> panels;
    if (video.pendulums) panels.emplace_back("\"pendulums\"");
    if (video.distance) panels.emplace_back("\"distance\"");
    if (video.energy) panels.emplace_back("\"energy\"");

    auto text = fmt::format("title = {}\n\n[scene]\nkind = \"pair\"\nduration_s = {}\nsample_hz = {}\n",
                            quoted(preset.title), ratio(preset.duration_s), ratio(preset.sample_hz));
    text += fmt::format("\n[a]\n{}\n[b]\n{}", side_toml(preset.a), side_toml(preset.b));
    text += fmt::format(
        "\n[video]\nsize = [{}, {}]\nspeed = {}\nformat = \"{}\"\npreset = \"{}\"\ncrf = {}\ntheme = \"{}\"\n",
        video.size.width, video.size.height, ratio(video.speed), video.format, video.preset, video.crf, video.theme);
    text += fmt::format("trail_s = {}\npanels = [{}]\n", video.trail_s, fmt::join(panels, ", "));
    if (video.fps) text += fmt::format("fps = {}\n", ratio(*video.fps));
    if (video.side_colors)
        text += fmt::format("side_colors = [{}, {}]\n", hex((*video.side_colors)[0]), hex((*video.side_colors)[1]));
    const auto add_range = [&](const char* key, const std::optional<Range>& range) {
        if (range) text += fmt::format("{} = [{}, {}]\n", key, range->low, range->high);
    };
    add_range("distance_range", video.distance_range);
    add_range("energy_range", video.energy_range);
    return text;
}

void write_manifest(const std::filesystem::path& path, const Scene& scene, const RunRecord& record) {
    Json files = Json::object();
    for (const auto& [name, where] : record.files) add_files(files, name, where);

    const long steps = record.last_sample * (scene.a.steps_per_sample + scene.b.steps_per_sample);
    const Json manifest = {
        {"doppel", {{"version", version()}, {"revision", revision()}}},
        {"preset", scene.preset.name},
        {"resolved_preset", json_of(resolved_toml(scene.preset))},
        {"samples", {{"first", record.first_sample}, {"last", record.last_sample}, {"of", scene.samples}}},
        {"frames",
         {{"count", record.frames}, {"fps", scene.fps.text()}, {"samples_per_frame", scene.samples_per_frame}}},
        {"steps", steps},
        {"a", side_json(scene.a, record.worst.energy_a, record.worst.length_a)},
        {"b", side_json(scene.b, record.worst.energy_b, record.worst.length_b)},
        {"largest_distance", record.largest_distance},
        {"libraries", {{"gl", record.gl}, {"libav", record.libav}, {"compiler", __VERSION__}}},
        {"time",
         {{"wall_s", record.wall_s},
          {"cpu_s", record.cpu_s},
          {"cpu_by_stage_s",
           {{"simulate", record.simulate_cpu_s},
            {"draw", record.draw_cpu_s},
            {"convert", record.write_cpu_s},
            {"encode_and_rest", record.encode_cpu_s}}}}},
        {"files", files},
    };
    OutputFile file(path);
    file.write(manifest.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    file.close();
}

}  // namespace doppel
