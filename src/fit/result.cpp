#include "fit/result.hpp"

#include "base/machine.hpp"
#include "fit/flow.hpp"
#include "fit/report.hpp"
#include "output/png.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// Spread of the angles about their mean, rms of both links, rad.
double spread_of(const Track& track) {
    double squares = 0;
    for (const auto& piece : track.pieces)
        for (const auto& angles : piece.angle) {
            const Eigen::Map<const Eigen::ArrayXd> all(angles.data(), angles.size());
            squares += (all - all.mean()).square().sum();
        }
    return std::sqrt(squares / static_cast<double>(2 * track.samples()));
}

/// The largest acceptable residual of a model, rms, rad.
double max_residual(const Track& track) {
    constexpr double max_share = 0.05, noises = 3;
    return std::max(max_share * spread_of(track), noises * std::max(track.noise[0], track.noise[1]));
}

/// Throws if the swing gains energy. This is only checked if some friction is at its lower bound 0.
void require_loss(const FitJob& job, const ModelHierarchy& hierarchy) {
    constexpr double sure = 5;  // standard errors
    const auto viscous =
        std::find_if(hierarchy.candidates.rbegin(), hierarchy.candidates.rend(), [](const FittedModel& candidate) {
            return candidate.fit.model.fitted[viscous_1] && !candidate.fit.model.fitted[coulomb_1];
        });
    if (viscous == hierarchy.candidates.rend()) return;
    if (!viscous->fit.is_at_bound(viscous_1) && !viscous->fit.is_at_bound(viscous_2)) return;
    const auto loss = energy_loss(job, viscous->fit);
    const bool is_sure = loss && loss->share < -sure * loss->standard_error;  // false if the error is not a number
    if (!is_sure || loss->rms > max_residual(job.track)) return;
    throw method_failed(
        "{}: the motion gains energy, {:.2g} ± {:.1g} % of its kinetic energy a second; a free pendulum loses energy: "
        "check that time_s runs forwards and that nothing drives the pendulum",
        job.track.pieces.front().name, -100 * loss->share, 100 * loss->standard_error);
}

/// Throws if even the best model leaves too much for its parameters to mean anything.
void require_description(const Track& track, const ModelHierarchy& hierarchy) {
    const auto& best = hierarchy.candidates[hierarchy.best];
    if (best.left_out_rms <= max_residual(track)) return;
    throw method_failed(
        "{}: no model describes this track: the best ({}) has an error of {:.2g} rad on parts left out, where angles "
        "spread by {:.2g} rad; check that it is a free double pendulum and that the columns are right",
        track.pieces.front().name, best.name, best.left_out_rms, spread_of(track));
}

/// Throws if the links seem exchanged. Exchanged links obey the same equations, except for friction. But D1 − C D2/B is
/// the first link's own moment, at least m1 a1 g as B/(m2 a2) ≥ a2, so it must be positive.
void require_order(const Track& track, const ModelHierarchy& hierarchy) {
    constexpr double minimum = 1.01;
    const auto& fit = hierarchy.candidates[hierarchy.best].fit;
    const double moment = fit.parameters[gravity_1] / (fit.parameters[coupling] * fit.parameters[gravity_2]);
    if (moment >= minimum) return;
    throw bad_input(
        "{}: theta1_rad and theta2_rad seem to be swapped: D1 B/(C D2) is {:.3f}, and must be more than 1; theta1 is "
        "the link at the pivot",
        track.pieces.front().name, moment);
}

/// The interval at which the fitted motion leads from each piece to the next. Nothing if no interval up to four times a
/// piece stands out.
std::optional<Period> find_period(const FitJob& job, const Fit& fit) {
    constexpr double longest = 4, min_separation_s = 0.15, close = 0.05, times = 3, diverged = 0.25;
    const auto& pieces = job.track.pieces;
    if (pieces.size() < 3) return std::nullopt;
    const double shortest = std::ranges::min_element(pieces, {}, &TrackPiece::duration)->duration(), step = fit.step_s;
    // the state at the start of each piece, and the distance of each piece's motion from it, far beyond the end of the
    // piece; rates are in natural units
    const double rate = std::sqrt(fit.parameters[gravity_2]), transitions = static_cast<double>(pieces.size() - 1);
    const LinkState unit(1, 1, rate, rate);
    std::vector<LinkState> starts(pieces.size());
    for (std::size_t k = fit.shots.size(); k-- > 0;) starts[fit.shots[k].piece] = fit.shots[k].start;
    const auto count = static_cast<std::size_t>(longest * shortest / step);
    const auto from = static_cast<std::size_t>(0.95 * shortest / step);
    std::vector<std::vector<LinkState>> motions(pieces.size() - 1);
    std::vector<double> distance(count, 0);  // mean square distance of ends and starts, for each interval
    for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
        throw_if_set(job.stop);
        Flow<> flow(fit.model, fit.parameters, starts[k], step);
        for (std::size_t i = 0; i < count; ++i) {
            const double t = static_cast<double>(i) * step;
            flow.reach(t);
            const auto& difference = motions[k].emplace_back((starts[k + 1] - flow.values_at(t)).cwiseQuotient(unit));
            distance[i] += std::min(difference.squaredNorm(), 1.0) / transitions;
        }
    }
    const auto minimum = std::min_element(distance.begin() + static_cast<std::ptrdiff_t>(from), distance.end() - 1);
    const auto best = static_cast<std::size_t>(minimum - distance.begin());
    const double found_s = static_cast<double>(best) * step;
    for (std::size_t i = from; i < count; ++i)  // competing minima
        if (std::abs(static_cast<double>(i) * step - found_s) > min_separation_s && distance[i] < times * *minimum)
            return std::nullopt;
    if (*minimum > close) return std::nullopt;
    // refines between the steps: the shift along the motions that brings ends and starts together, without motions that
    // have diverged
    double along = 0, speed = 0, rest = 0, used = 0;
    for (const auto& difference : motions) {
        if (difference[best].squaredNorm() > diverged) continue;
        const LinkState slope = (difference[best - 1] - difference[best + 1]) / (2 * step);
        along += difference[best].dot(slope), speed += slope.squaredNorm(), rest += difference[best].squaredNorm(),
            used += 4;
    }
    const double shift = along / speed;
    return Period{found_s + shift, std::sqrt((rest - shift * along) / std::max(used - 1, 1.0) / speed)};
}

void put_on_one_clock(FitResult& result, std::optional<double> every_s, const std::atomic<bool>& stop) {
    auto& track = result.track;
    if (!track.start_s.empty() && !every_s) return;
    if (!every_s) {
        result.period = find_period({track, stop}, result.chosen().fit);
        if (!result.period) return;
        every_s = result.period->seconds;
    }
    track.start_s.clear();
    for (std::size_t k = 0; k < track.pieces.size(); ++k) {
        track.start_s.push_back(static_cast<double>(k) * *every_s);
        if (k + 1 < track.pieces.size() && track.pieces[k].duration() > *every_s)
            throw bad_input("--every {}: {} lasts {:.4g} s, and the next piece cannot begin before its end", *every_s,
                            track.pieces[k].name, track.pieces[k].duration());
    }
}

/// Throws if a file is given twice.
void require_different(const std::vector<std::filesystem::path>& files) {
    std::error_code ignored;  // missing files are refused when they are read
    for (auto file = files.begin(); file != files.end(); ++file)
        for (auto other = files.begin(); other != file; ++other)
            if (std::filesystem::equivalent(*other, *file, ignored))
                throw bad_input("{} and {} are the same file; samples counted twice would make the errors too small",
                                other->string(), file->string());
}

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

FitResult analyse(Track track, const FitOptions& options, const std::atomic<bool>& stop,
                  const std::function<void(const Progress&)>& report) {
    const double start = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    FitResult result{.track = std::move(track)};
    const FitJob job{result.track, stop, options.jobs > 0 ? options.jobs : cores()};
    auto& hierarchy = result.hierarchy = fit_hierarchy(job, options.bodies, report);
    result.models_cpu_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - start;
    require_order(result.track, hierarchy);
    require_loss(job, hierarchy);
    require_description(result.track, hierarchy);
    auto& fit = hierarchy.candidates[hierarchy.chosen].fit;
    constexpr double of_errors = 0.2;  // of a model's own error: steps need not be finer
    for (const double share : {of_errors, FitEffort{}.step_share}) {
        const auto finer = fit_model(job, fit, {.step_share = share});
        if (!finer) throw no_motion(result.track);
        fit = *finer;
        result.uncertainty = uncertainty_of(job, fit);
        if (!result.uncertainty.is_white) break;
    }
    for (std::size_t link = 0; link < 2; ++link)  // what scatters between coarse samples is mostly motion
        result.track.noise[link] = std::min(result.track.noise[link], fit.scale[link]);
    put_on_one_clock(result, options.every_s, stop);
    if (!result.track.start_s.empty()) {
        auto horizon = measure_horizon(job, fit, result.uncertainty);
        if (!horizon.predictions.empty()) result.horizon = std::move(horizon);
    }
    result.pendulum = fitted_pendulum(fit.parameters, fit.model, options.convention);
    result.cpu_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - start;
    return result;
}

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
    require_different(files);
    auto track = read_tracks(files, stop);
    if (options.every_s && track.pieces.size() == 1)
        throw bad_input("--every is the time from a piece to the next, and {} is one piece", files.front().string());
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
