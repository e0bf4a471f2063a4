#include "base/threads.hpp"
#include "film/film.hpp"
#include "output/written.hpp"
#include "scene/certificate.hpp"
#include "scene/forecast.hpp"
#include "scene/resolved.hpp"
#include "scene/side_keys.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <exception>

namespace doppel {
namespace {

Json track_json(const Replay& replay, const TrackSpec& spec) {
    const auto& piece = replay.samples();
    const Json measured{
        {"file", spec.file},           {"sha256", spec.sha256},   {"first_sample_s", piece.time_s.front()},
        {"start_s", replay.start_s},   {"samples", piece.size()}, {"noise_rad", replay.track->noise},
        {"notes", replay.track->notes}};
    return {{"measured", measured}};
}

Json side_json(const Scene& scene, const Side& side, const SideRecord& record) {
    auto json = method_json(scene, side);
    json["steps"] = record.effort.steps;
    json["evaluations"] = record.effort.evaluations;
    json["smallest_step_s"] = record.effort.smallest_step;
    json["conserves_energy"] = side.has_energy_error && !side.has_work;
    const auto of_energy = [&](double worst) { return side.has_energy_error ? Json(worst) : Json(nullptr); };
    json["worst_energy_error"] = of_energy(record.energy_error);
    json["worst_energy_change_J"] = of_energy(record.energy_change);
    json["energy_range_J"] = side.energy_unit;
    json["worst_energy_error_of_range"] = of_energy(record.energy_change / side.energy_unit);
    json["worst_length_error_m"] = record.length_error;
    return json;
}

/// The fonts of the film's text with their hashes, except the built-in one: fonts differ between machines.
Json fonts_json(const Preset& preset) {
    std::string words = "0 " + preset.title + preset.subtitle.value_or("");  // every film contains digits
    for (const auto* side : {&preset.a, &preset.b}) {
        words += side->label.value_or("") + side->note.value_or("");
        for (const auto& particle : side->particles) words += particle.name;
    }
    Json fonts = Json::object();
    for (const auto& file : preset.video.typeface.files_of(words)) fonts[file.string()] = sha256_of_file(file);
    return fonts;
}

}  // namespace

Json method_json(const Scene& scene, const Side& side) {
    Json json{{"model", name_of(side.motion.model)}, {"why", side.why}, {"integrator", side.method.name}};
    if (side.method.adaptive) {
        json["tolerance"] = static_cast<double>(side.motion.tolerance);
    } else {
        json["step_s"] = side.step.text();
        json["steps_per_sample"] = side.motion.steps_per_sample;
    }
    if (side.choice)
        json["accuracy"] = {{"unit", side.has_angles ? "rad" : fmt::format("{:g} m, the size", side.reach)},
                            {"asked_rad", side.choice->accuracy},
                            {"estimated_error_rad", side.choice->estimated_error},
                            {"horizon_s", scene.time(side.choice->horizon)},
                            {"holds_to_the_end", side.choice->horizon == scene.samples},
                            {"verified_by", side.choice->reference->description()}};
    return json;
}

void add_warnings(const Scene& scene, RunRecord& record, const std::atomic<bool>& stop) {
    constexpr double maximum = 0.01;
    for (const char name : scene.letters()) {
        const auto& side = scene.side(name);
        const double error = (name == 'a' ? record.motion.a : record.motion.b).energy_change / side.energy_unit;
        if (side.has_energy_error && error > maximum)
            record.warnings.push_back(fmt::format(
                "the energy of side {} changed by {:.2g} % of its range: {}, {} is too coarse for {:g} s; use accuracy "
                "= 1e-3",
                name, 100 * error, side.method.title, step_control_text(side), scene.time(record.last_sample)));
    }
    if (const auto words = no_difference(scene)) record.warnings.push_back(*words);
    if (const auto& proof = scene.certificate; proof && proof->last() < scene.samples)
        record.warnings.push_back(
            fmt::format("{}; nothing is proved after that", certificate_words(scene, *proof).front()));
    try {
        const TimeLimit limit(std::clamp(record.wall_s, 1.0, 2.0), stop);
        for (const char name : scene.letters())
            if (const auto words = early_error(scene, scene.side(name), record.last_sample, limit.reached()))
                record.warnings.push_back(fmt::format("side {}: {}", name, *words));
    } catch (const std::exception&) {
        throw_if_set(stop);  // otherwise unknown: it takes too long, or no thread can watch the time
    }
}

void write_manifest(Transaction& parts, const std::string& name, const Scene& scene, const RunRecord& record) {
    const auto& outcome = record.motion.outcome;
    const auto* stride = scene.frames.changing.empty() ? &scene.frames.stride : nullptr;  // none if the speed changes
    Json manifest = {
        {"doppel", program_json()},
        {"preset", scene.preset.name},
        {"resolved_preset", json_of_toml(resolved_toml(scene.preset))},
        {"samples", {{"first", record.first_sample}, {"last", record.last_sample}, {"of", scene.samples}}},
        {"frames",
         {{"count", record.frames},
          {"fps", scene.fps.text()},
          {"samples_per_frame", !stride              ? Json()
                                : stride->is_whole() ? Json(stride->numerator)
                                                     : Json(stride->text())}}},
        {"steps", record.motion.a.effort.steps + record.motion.b.effort.steps},
        {"a", scene.a.replay ? track_json(*scene.a.replay, scene.preset.a.track)
                             : side_json(scene, scene.a, record.motion.a)},
        {"b", scene.b.replay ? track_json(*scene.b.replay, scene.preset.b.track)
                             : side_json(scene, scene.b, record.motion.b)},
        {"largest_distance", scene.is_single() ? Json(nullptr) : Json(outcome.largest_distance)},
        {"parted_s", outcome.divergence.since() ? Json(*outcome.divergence.since()) : Json(nullptr)},
        {"horizon_s", scene.horizon() ? Json(*scene.horizon()) : Json(nullptr)},
        {"events", json_of(scene, record.events, record.shown)},
        {"warnings", record.warnings},
        {"libraries", {{"gl", record.gl}, {"libav", record.libav}, {"compiler", __VERSION__}}},
        {"time",
         {{"wall_s", record.wall_s},
          {"cpu_s", record.cpu_s},
          {"cpu_by_stage_s",
           {{"choose", scene.made_cpu_s},
            {"simulate", record.simulate_cpu_s},
            {"draw", record.draw_cpu_s},
            {"convert", record.write_cpu_s},
            {"encode_and_rest", record.encode_cpu_s}}}}},
    };
    if (scene.is_single()) manifest.erase("b");
    if (auto fonts = fonts_json(scene.preset); !fonts.empty()) manifest["fonts"] = std::move(fonts);
    if (scene.certificate) manifest["certificate"] = certificate_json(scene, *scene.certificate);
    if (!record.failure.empty()) manifest["failed"] = record.failure;
    write_manifest(parts, name, std::move(manifest));
}

}  // namespace doppel
