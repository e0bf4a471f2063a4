#include "fit/ladder.hpp"

#include "base/error.hpp"
#include "base/threads.hpp"
#include "fit/beginning.hpp"
#include "numeric/portable_math.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

using enum FitParameter;

/// One rung's name and what it adds.
struct Plan {
    std::string name;
    ModelSpec model;
};

bool fits(const ModelSpec& model, FitParameter parameter) {
    return std::find(model.fitted.begin(), model.fitted.end(), parameter) != model.fitted.end();
}

std::vector<Plan> plans_of(Bodies bodies) {
    std::vector<Plan> plans;
    const auto add = [&](bool point, const std::string& words, int friction, Drag drag = Drag::own, int reading = 0) {
        plans.push_back({(point ? "point masses, " : "compound, ") + words, model_of(point, friction, drag, reading)});
        plans.back().model.dry = DryLaw::sharp;
    };
    const bool only_point = bodies == Bodies::point;
    if (bodies != Bodies::compound) {
        add(true, "no friction", 0);
        add(true, "viscous friction", 1);
    }
    if (!only_point) {
        add(false, "no friction", 0);
        add(false, "viscous friction", 1);
    }
    add(only_point, "viscous and dry friction", 2);
    add(only_point, "viscous, dry, drag by own rates", 3);
    add(only_point, "viscous, dry, drag by the air met", 3, Drag::carried);
    add(only_point, "drag by the air met, a lag", 3, Drag::carried, 1);
    add(only_point, "drag by the air met, a lag, scales", 3, Drag::carried, 2);
    return plans;
}

/// Mean square residual of segments whose starts alone are fitted, rad²; infinite where no motion stays finite.
double mean_square_without(const Track& track, const Division& division, const std::vector<std::size_t>& unit,
                           const Fit& fit, const std::atomic<bool>& stop) {
    Fit alone{.model = fit.model, .rules = fit.rules, .parameters = fit.parameters};
    std::vector<TrackSegment> segments;
    for (const auto k : unit) {
        segments.push_back(division.segments[k]);
        alone.starts.push_back(fit.starts[k]);
    }
    alone.model.fitted.clear();
    try {
        alone = fit_model(track, segments, alone,
                          {.most_passes = 8, .finds_scale = false, .finds_step = false, .relative = 1e-3}, stop);
    } catch (const Error& error) {
        if (error.code() != ExitCode::method_failed) throw;
        return std::numeric_limits<double>::infinity();
    }
    return alone.rms * alone.rms;
}

void leave_out(const Track& track, const Division& division, FittedModel& rung, int jobs,
               const std::atomic<bool>& stop) {
    const auto units = division.units.size();
    rung.left_out.assign(units, 0);
    rung.without.assign(units, {});
    parallel_for(units, jobs, [&](std::size_t u) {
        const auto without = fit_without(rung.fit, division.units[u]);
        rung.without[u] = without.parameters;
        rung.left_out[u] = mean_square_without(track, division, division.units[u], without, stop);
    });
    double squares = 0, samples = 0;
    for (std::size_t u = 0; u < units; ++u) {
        double size = 0;
        for (const auto k : division.units[u]) size += static_cast<double>(division.segments[k].size());
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

/// The nearer of two places to start from: where the model before ended, and where all began.
Fit nearer_start(const Track& track, const std::vector<TrackSegment>& segments, const ModelSpec& model,
                 const Fit& before, const Fit& first, int jobs, const std::atomic<bool>& stop) {
    const auto placed = [&](Fit fit) {
        fit.model = model;
        for (std::size_t k = index_of(viscous_1); k < dynamic_count; ++k)
            if (!fits(model, static_cast<FitParameter>(k))) fit.parameters[k] = 0;
        fit.parameters = completed(model, fit.parameters);
        fit.sums.clear();
        return fit;
    };
    auto one = placed(first);
    if (before.starts.empty() || before.model.point_masses != model.point_masses) return one;
    auto other = placed(before);
    one.rules = other.rules;
    evaluate_fit(track, segments, one, jobs, stop);
    evaluate_fit(track, segments, other, jobs, stop);
    return one.cost < other.cost ? one : other;
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
    const auto samples = static_cast<double>(rung.fit.residuals.size());
    const double more = static_cast<double>(best.parameters) - static_cast<double>(rung.parameters);
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

Division divide(const Track& track, double segment_s) {
    constexpr double longest = 3, shortest = 0.5, wanted = 8, few_pieces = 4;
    const double length = segment_s > 0 ? segment_s : std::clamp(track.duration() / wanted, shortest, longest);
    Division division;
    for (std::size_t piece = 0; piece < track.pieces.size(); ++piece) {
        const auto& times = track.pieces[piece].time_s;
        const auto parts = std::max(1L, std::lround(std::ceil(track.pieces[piece].duration() / length - 0.01)));
        auto& unit = division.units.emplace_back();
        std::size_t first = 0;
        for (long part = 1; part <= parts; ++part) {
            const double end =
                times.front() + track.pieces[piece].duration() * static_cast<double>(part) / static_cast<double>(parts);
            auto last = static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), end) - times.begin());
            if (part == parts) last = times.size();
            if (last - first < 8 && part < parts) continue;  // a gap
            unit.push_back(division.segments.size());
            division.segments.push_back({piece, first, last});
            first = last;
        }
    }
    if (static_cast<double>(track.pieces.size()) < few_pieces) {
        division.units.clear();
        for (std::size_t k = 0; k < division.segments.size(); ++k) division.units.push_back({k});
    }
    return division;
}

Fit fit_without(const Fit& fit, const std::vector<std::size_t>& segments) {
    const auto places = fit.free_places();
    const auto count = static_cast<Eigen::Index>(places.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(count);
    for (std::size_t k = 0; k < fit.sums.size(); ++k) {
        if (std::find(segments.begin(), segments.end(), k) != segments.end()) continue;
        const auto part = reduced(fit.sums[k], places);
        matrix += part.matrix;
        slope += part.slope;
    }
    // friction that would be less than 0 is 0, and the others follow
    const Eigen::VectorXd scale = matrix.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    Eigen::MatrixXd even = scale.asDiagonal() * matrix * scale.asDiagonal();
    Eigen::VectorXd right = scale.asDiagonal() * slope, change;
    std::vector<bool> held(places.size(), false);  // each once: what is not finite would ask for it for ever
    for (bool again = true; again;) {
        again = false;
        change = scale.asDiagonal() * even.ldlt().solve(right);
        for (Eigen::Index k = 0; k < count; ++k) {
            const auto place = static_cast<std::size_t>(k);
            const auto parameter = fit.model.fitted[static_cast<std::size_t>(places[place])];
            const double value = fit.parameters[index_of(parameter)];
            if (held[place] || !fit.model.is_bounded(parameter) || value + change[k] >= 0) continue;
            const double to_zero = -value / scale[k];
            right -= even.col(k) * to_zero;
            even.row(k).setZero();
            even.col(k).setZero();
            even(k, k) = 1;
            right[k] = to_zero;
            held[place] = again = true;
        }
    }
    return moved(fit, places, change);
}

Fit of_better_law(const Track& track, const std::vector<TrackSegment>& segments, Fit fit, const FitEffort& effort,
                  const std::atomic<bool>& stop) {
    if (!fits(fit.model, coulomb_1)) return fit;
    Fit other = fit;
    other.model.dry = fit.model.dry == DryLaw::sharp ? DryLaw::smooth : DryLaw::sharp;
    other.sums.clear();
    try {
        other = fit_model(track, segments, std::move(other), effort, stop);
    } catch (const Error& error) {
        if (error.code() != ExitCode::method_failed) throw;
        return fit;
    }
    return other.rms < fit.rms ? other : fit;
}

ModelLadder climb(const Track& track, Bodies bodies, int jobs, const std::atomic<bool>& stop,
                  const std::function<void(std::size_t done, std::size_t of)>& report) {
    ModelLadder ladder;
    const auto plans = plans_of(bodies);
    constexpr double roughly = 5e-4;  // enough to compare
    auto [division, first] = begin_fit(track, jobs, stop);
    ladder.division = std::move(division);
    const auto& segments = ladder.division.segments;
    Fit before{};
    for (const auto& plan : plans) {
        throw_if_set(stop);
        FittedModel rung{.name = plan.name, .model = plan.model};
        const auto start = nearer_start(track, segments, plan.model, before, first, jobs, stop);
        try {
            const FitEffort effort{.step_share = 0.2, .relative = roughly, .jobs = jobs};
            rung.fit = of_better_law(track, segments, fit_model(track, segments, start, effort, stop), effort, stop);
            rung.model = rung.fit.model;
        } catch (const Error& error) {  // of this model alone
            if (error.code() != ExitCode::method_failed || (plan.name == plans.back().name && ladder.rungs.empty()))
                throw;
            continue;
        }
        leave_out(track, ladder.division, rung, jobs, stop);
        rung.parameters = rung.fit.free().size();
        before = rung.fit;
        ladder.rungs.push_back(std::move(rung));
        report(ladder.rungs.size(), plans.size());
    }
    const auto& rungs = ladder.rungs;
    const auto choose = [&](const auto& may) {
        std::size_t best = 0;
        for (std::size_t k = 0; k < rungs.size(); ++k)
            if (may(rungs[k]) && (!may(rungs[best]) || rungs[k].left_out_rms < rungs[best].left_out_rms)) best = k;
        for (std::size_t k = 0; k < rungs.size(); ++k)
            if (may(rungs[k]) && serves(rungs[k], rungs[best]) &&
                (!like_noise(track, rungs[best]) || is_as_likely(rungs[k], rungs[best])))
                return std::pair(k, best);
        return std::pair(best, best);
    };
    std::tie(ladder.chosen, ladder.best) = choose([](const FittedModel&) { return true; });
    return ladder;
}

}  // namespace doppel
