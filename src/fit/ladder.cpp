#include "fit/ladder.hpp"

#include "base/error.hpp"
#include "base/threads.hpp"
#include "numeric/portable_math.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

using enum FitParameter;

/// The models, from the smallest.
std::vector<FittedModel> models_of(Bodies bodies) {
    std::vector<FittedModel> models;
    const auto add = [&](bool point, const std::string& words, int friction, Drag drag = Drag::own, int reading = 0) {
        auto& model = models.emplace_back();
        model.name = (point ? "point masses, " : "compound, ") + words;
        model.fit.model = model_of(point, friction, drag, reading);
    };
    const bool only_point = bodies == Bodies::point;
    for (const bool point : {true, false}) {
        if (bodies == (point ? Bodies::compound : Bodies::point)) continue;
        add(point, "no friction", 0);
        add(point, "viscous friction", 1);
    }
    add(only_point, "viscous and dry friction", 2);
    add(only_point, "viscous, dry, drag by own rates", 3);
    add(only_point, "viscous, dry, drag by the air met", 3, Drag::carried);
    add(only_point, "drag by the air met, a lag", 3, Drag::carried, 1);
    add(only_point, "drag by the air met, a lag, scales", 3, Drag::carried, 2);
    return models;
}

/// Mean square residual of segments whose starts alone are fitted, rad²; infinite where no motion stays finite.
double mean_square_of(const FitJob& job, const std::vector<std::size_t>& unit, const Fit& fit) {
    auto alone = fit.without_sums();
    alone.segments.clear(), alone.starts.clear(), alone.model.fitted.clear();
    for (const auto k : unit) {
        alone.segments.push_back(fit.segments[k]);
        alone.starts.push_back(fit.starts[k]);
    }
    try {
        alone = fit_model(job, std::move(alone),
                          {.most_passes = 8, .finds_scale = false, .step_share = 0, .relative = 1e-3});
    } catch (const Error& error) {
        if (error.code() != ExitCode::method_failed) throw;
        return std::numeric_limits<double>::infinity();
    }
    return alone.rms * alone.rms;
}

void leave_out(const FitJob& job, const Units& units, FittedModel& rung) {
    rung.left_out.assign(units.size(), 0);
    parallel_for(units.size(), job.threads, [&](std::size_t u) {
        const auto& unit = units[u];
        rung.left_out[u] = mean_square_of({job.track, job.stop}, unit, fit_without(rung.fit, unit));
    });
    double squares = 0, samples = 0;
    for (std::size_t u = 0; u < units.size(); ++u)
        for (const auto k : units[u]) {
            const auto size = static_cast<double>(rung.fit.segments[k].size());
            squares += size * rung.left_out[u];
            samples += size;
        }
    rung.left_out_rms = std::sqrt(squares / samples);
}

/// Whether pieces left out are predicted as well as by the best, within what pieces differ by.
bool serves(const FittedModel& rung, const FittedModel& best) {
    constexpr double negligible = 0.1;  // of the mean square: a twentieth of the rms
    double sum = 0, squares = 0;
    const auto count = static_cast<double>(rung.left_out.size());
    for (std::size_t u = 0; u < rung.left_out.size(); ++u) {
        const double ratio = portable_log(rung.left_out[u] / best.left_out[u]);
        sum += ratio;
        squares += ratio * ratio;
    }
    const double mean = sum / count, variance = (squares - sum * mean) / std::max(count - 1, 1.0);
    return mean <= std::max(negligible, std::sqrt(variance / count));
}

/// Another model at the same parameters, without the friction that it leaves out.
Fit as_model(const ModelSpec& model, Fit fit) {
    fit.model = model;
    fit.sums.clear();
    for (auto k = index_of(viscous_1); k <= index_of(quadratic_2); ++k)
        if (!model.fits(static_cast<FitParameter>(k))) fit.parameters[k] = 0;
    fit.parameters = completed(model, fit.parameters);
    return fit;
}

/// Whether samples scatter about the model no more than from one to the next.
bool like_noise(const Track& track, const FittedModel& rung) {
    constexpr double about = 1.3;
    const double noise = std::sqrt(0.5 * (track.noise[0] * track.noise[0] + track.noise[1] * track.noise[1]));
    return rung.fit.rms < about * noise;
}

/// Whether its residuals are no larger than fewer parameters explain, where they are noise: by the ratio of
/// likelihoods, at some 99.9 %.
bool is_as_likely(const FittedModel& rung, const FittedModel& best) {
    const auto samples = static_cast<double>(rung.fit.residual_count());
    const double more = static_cast<double>(best.fit.free_count()) - static_cast<double>(rung.fit.free_count());
    return 2 * samples * portable_log(rung.fit.rms / best.fit.rms) < 10 + 2 * std::max(more, 0.0);
}

}  // namespace

ModelSpec model_of(bool point, int friction, Drag drag, int reading) {
    ModelSpec model{.point_masses = point, .drag = drag, .fitted = {inertia, coupling}};
    auto& fitted = model.fitted;
    if (!point) fitted.push_back(gravity_1);
    fitted.push_back(gravity_2);
    if (friction > 0) fitted.insert(fitted.end(), {viscous_1, viscous_2});
    if (friction > 1) fitted.insert(fitted.end(), {coulomb_1, coulomb_2});
    if (friction > 2) fitted.insert(fitted.end(), {quadratic_1, quadratic_2});
    fitted.insert(fitted.end(), {offset_1, offset_2});
    if (reading > 0) fitted.push_back(lag);
    if (reading > 1) fitted.insert(fitted.end(), {scale_1, scale_2});
    return model;
}

ModelLadder climb(const FitJob& job, Bodies bodies,
                  const std::function<void(std::size_t done, std::size_t of)>& report) {
    constexpr double roughly = 5e-4;  // enough to compare
    const auto models = models_of(bodies);
    auto [units, first] = begin_fit(job);
    ModelLadder ladder{.units = std::move(units), .rungs = {}};
    auto& rungs = ladder.rungs;
    for (auto rung : models) {
        throw_if_set(job.stop);
        const auto model = rung.fit.model;
        try {
            // from the nearer of two places: where all began, and where the model before ended
            auto start = as_model(model, first);
            if (!rungs.empty() && rungs.back().fit.model.point_masses == model.point_masses) {
                auto other = as_model(model, rungs.back().fit);
                start.rules = other.rules;
                evaluate_fit(job, start);
                evaluate_fit(job, other);
                if (other.cost <= start.cost) start = std::move(other);
            }
            rung.fit = fit_model(job, std::move(start), {.step_share = 0.2, .relative = roughly});
        } catch (const Error& error) {  // of this model alone
            if (error.code() != ExitCode::method_failed || (rung.name == models.back().name && rungs.empty())) throw;
            continue;
        }
        leave_out(job, ladder.units, rung);
        rungs.push_back(std::move(rung));
        report(rungs.size(), models.size());
    }
    for (std::size_t k = 0; k < rungs.size(); ++k)
        if (rungs[k].left_out_rms < rungs[ladder.best].left_out_rms) ladder.best = k;
    const auto& best = rungs[ladder.best];
    const auto is_as_good = [&](const FittedModel& rung) {
        return serves(rung, best) && (!like_noise(job.track, best) || is_as_likely(rung, best));
    };
    while (ladder.chosen < ladder.best && !is_as_good(rungs[ladder.chosen])) ++ladder.chosen;
    return ladder;
}

}  // namespace doppel
