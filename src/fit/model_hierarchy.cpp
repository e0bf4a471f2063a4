#include "fit/model_hierarchy.hpp"

#include "base/threads.hpp"
#include "fit/initial_fit.hpp"
#include "numeric/portable_math.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

/// The models, the smallest first: with point masses and with rigid bodies up to those with Coulomb friction.
std::vector<FittedModel> models_of(Bodies bodies) {
    constexpr const char* words[]{"no friction",
                                  "viscous friction",
                                  "viscous and Coulomb friction",
                                  "viscous, Coulomb, drag by own rates",
                                  "viscous, Coulomb, drag by relative velocity",
                                  "drag by relative velocity, a lag",
                                  "drag by relative velocity, a lag, scales"};
    std::vector<FittedModel> models;
    for (const bool point : {true, false})
        for (int k = 0; k < 7; ++k) {
            if (bodies == (point ? Bodies::rigid : Bodies::point)) continue;
            if (point && k > 1 && bodies != Bodies::point) continue;
            models.push_back({.name = std::string(point ? "point masses, " : "rigid bodies, ") + words[k], .fit = {}});
            models.back().fit.model =
                model_of(point, std::min(k, 3), k < 4 ? Drag::own : Drag::carried, std::max(k - 4, 0));
        }
    return models;
}

/// Computes the mean square residual of each unit with parameters fitted without it; only starts are fitted. Infinite
/// if no motion stays finite.
void leave_out(const FitJob& job, FittedModel& candidate) {
    candidate.left_out.resize(candidate.fit.units());
    parallel_for(candidate.left_out.size(), job.threads, [&](std::size_t unit) {
        const auto without = stepped(candidate.fit, 0, unit, unit);
        const auto alone = fit_starts({job.track, job.stop}, without, without.unit(unit), 8, 1e-3);
        candidate.left_out[unit] = alone ? alone->rms * alone->rms : std::numeric_limits<double>::infinity();
    });
    double squares = 0, samples = 0;
    for (const auto& shot : candidate.fit.shots) {
        squares += static_cast<double>(shot.size()) * candidate.left_out[shot.unit];
        samples += static_cast<double>(shot.size());
    }
    candidate.left_out_rms = std::sqrt(squares / samples);
}

/// Whether a model predicts left-out pieces as well as the best one, within the scatter of pieces. If the best one
/// leaves only noise, comparable to the sample-to-sample scatter, the model must also be as likely by the likelihood
/// ratio, at some 99.9 %.
bool is_as_good(const Track& track, const FittedModel& candidate, const FittedModel& best) {
    constexpr double negligible = 0.1,
                     about = 1.3;  // of the mean square: a twentieth of the rms; relative to the noise
    double sum = 0, squares = 0;
    const auto count = static_cast<double>(candidate.left_out.size());
    for (std::size_t u = 0; u < candidate.left_out.size(); ++u) {
        const double ratio = portable_log(candidate.left_out[u] / best.left_out[u]);
        sum += ratio;
        squares += ratio * ratio;
    }
    const double mean = sum / count, variance = (squares - sum * mean) / std::max(count - 1, 1.0);
    if (!(mean <= std::max(negligible, std::sqrt(variance / count)))) return false;
    const double noise = std::sqrt(0.5 * (track.noise[0] * track.noise[0] + track.noise[1] * track.noise[1]));
    const double more = static_cast<double>(best.fit.free_count()) - static_cast<double>(candidate.fit.free_count());
    return best.fit.rms >= about * noise ||
           2 * static_cast<double>(candidate.fit.residual_count()) * portable_log(candidate.fit.rms / best.fit.rms) <
               10 + 2 * std::max(more, 0.0);
}

/// Another model with the same parameters, without the friction that it lacks.
Fit as_model(const ModelSpec& model, Fit fit) {
    fit.model = model;
    fit.is_evaluated = false;
    for (std::size_t k = viscous_1; k <= quadratic_2; ++k)
        if (!model.fitted[k]) fit.parameters[k] = 0;
    return fit;
}

}  // namespace

ModelHierarchy fit_hierarchy(const FitJob& job, Bodies bodies, const std::function<void(const Progress&)>& report) {
    constexpr double roughly = 5e-4;  // precise enough for a comparison
    const auto models = models_of(bodies);
    const auto first = initial_fit(job);
    ModelHierarchy hierarchy;
    auto& candidates = hierarchy.candidates;
    for (auto candidate : models) {
        throw_if_set(job.stop);
        // starts from the better of two fits: the first one, and that of the previous model
        const auto model = candidate.fit.model;
        auto start = as_model(model, first);
        if (!candidates.empty() && candidates.back().fit.model.point_masses == model.point_masses) {
            auto other = as_model(model, candidates.back().fit);
            start.step_s = other.step_s, start.scale = other.scale;
            evaluate_fit(job, start);
            evaluate_fit(job, other);
            if (other.cost <= start.cost) start = std::move(other);
        }
        auto fit = fit_model(job, std::move(start), {.step_share = 0.2, .relative = roughly});
        if (!fit) continue;
        candidate.fit = *std::move(fit);
        leave_out(job, candidate);
        candidates.push_back(std::move(candidate));
        report({static_cast<long>(candidates.size()), static_cast<long>(models.size())});
    }
    if (candidates.empty()) throw no_motion(job.track);
    for (std::size_t k = 0; k < candidates.size(); ++k)
        if (candidates[k].left_out_rms < candidates[hierarchy.best].left_out_rms) hierarchy.best = k;
    while (hierarchy.chosen < hierarchy.best &&
           !is_as_good(job.track, candidates[hierarchy.chosen], candidates[hierarchy.best]))
        ++hierarchy.chosen;
    return hierarchy;
}

}  // namespace doppel
