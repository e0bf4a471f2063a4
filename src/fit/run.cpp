#include "base/clock.hpp"
#include "base/machine.hpp"
#include "fit/report.hpp"
#include "output/png.hpp"

#include <fmt/format.h>

namespace doppel {
namespace {

constexpr Size page_size{1600, 1300};
constexpr const auto& light = themes[1];

std::vector<std::string> sentences_of(const FitResult& result) {
    const auto& [name, fit, left_out_rms, left_out] = result.chosen();
    std::vector all{fmt::format("{}, {} parameters: rms {:.2g} rad, {:.2g} on pieces left out.", name, fit.free_count(),
                                fit.rms, left_out_rms)};
    if (const auto& period = result.period)
        all.push_back(
            fmt::format("Pieces begin every {:.4f} ± {:.4f} s, by the fit.", period->seconds, period->standard_error));
    all.insert(all.end(), {residual_sentence(result), horizon_sentence(result)});
    return all;
}

}  // namespace

std::string fit_name(const std::vector<std::filesystem::path>& files, const FitOptions& options) {
    auto name = options.name.empty() ? files.front().stem().string() : options.name;
    if (name.empty() || name.find('/') != std::string::npos)
        throw bad_input("--name must be the name of a folder; it is \"{}\"", name);
    check_preset_name(options.name.empty() ? files.front().string() : "--name", name);
    return name;
}

FitRun run_fit(const std::vector<std::filesystem::path>& files, const FitOptions& options,
               const std::atomic<bool>& stop, const std::function<void(const Progress&)>& report) {
    const auto name = fit_name(files, options);
    const double start = seconds_of(CLOCK_MONOTONIC);
    auto track = read_tracks(files, stop);
    Transaction parts(options.out / name, name, "fit", {files, options.force});
    parts.require(name + ".fit.json");
    const auto place = [&](const char* ending) { return parts.file(name + ending); };
    const auto preset = place(".toml"), table = place(".residuals.csv"), page = place(".png");
    const auto result = analyse(std::move(track), options, stop, report);
    const auto finish = [&] {
        write_file(preset, fitted_preset(result, name));
        parts.finished(name + ".toml");
        write_residuals(result, table);
        parts.finished(name + ".residuals.csv");
        throw_if_set(stop);
        const auto picture = picture_of(compose(fit_page(result, name), page_size, light), stop);
        throw_if_set(stop);
        write_png(page, picture,
                  {.metadata = metadata_of(name, name, fmt::format("how it was made is in {}.fit.json", name))}, stop);
        parts.finished(name + ".png");
        auto manifest = fit_json(result);
        manifest["threads"] = options.jobs > 0 ? options.jobs : cores();
        manifest["time"] = {{"models_cpu_s", result.models_cpu_s}, {"fit_cpu_s", result.cpu_s}};
        manifest["libraries"] = {{"drawing", page_library()}, {"compiler", __VERSION__}};
        write_manifest(parts, name + ".fit.json", std::move(manifest));
        throw_if_set(stop);
        return parts.publish();
    };
    FitRun done{{.files = parts.keeping_finished(finish), .warnings = result.track.notes}, sentences_of(result)};
    done.run.wall_s = seconds_of(CLOCK_MONOTONIC) - start;
    return done;
}

}  // namespace doppel
