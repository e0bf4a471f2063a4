#include "fit/ladder.hpp"

#include "base/error.hpp"
#include "base/threads.hpp"
#include "fit/regression.hpp"
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

bool fits(const ModelSpec& model, FitParameter parameter) {
    return std::find(model.fitted.begin(), model.fitted.end(), parameter) != model.fitted.end();
}

std::vector<Plan> plans_of(Bodies bodies) {
    std::vector<Plan> plans;
    const auto add = [&](bool point, const std::string& words, int friction, Drag drag = Drag::own, int reading = 0) {
        plans.push_back({(point ? "point masses, " : "compound, ") + words, model_of(point, friction, drag, reading)});
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

/// Mean square residual of segments whose starts alone are fitted, rad².
double mean_square_without(const Track& track, const Division& division, const std::vector<std::size_t>& unit,
                           const Fit& fit, const std::atomic<bool>& stop) {
    Fit alone{.model = fit.model, .rules = fit.rules, .parameters = fit.parameters};
    std::vector<TrackSegment> segments;
    for (const auto k : unit) {
        segments.push_back(division.segments[k]);
        alone.starts.push_back(fit.starts[k]);
    }
    alone.model.fitted.clear();
    alone = fit_model(track, segments, alone,
                      {.most_passes = 8, .finds_scale = false, .finds_step = false, .relative = 1e-3}, stop);
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

/// Parameters and starts to begin with: equations of motion regressed, then a fit of short stretches, which follow
/// them more easily than long ones.
Fit first_fit(const Track& track, const Division& division, const ModelSpec& model, int jobs,
              const std::atomic<bool>& stop) {
    constexpr double short_s = 0.5;
    const auto regression = regress(glimpses_of(track));
    if (!regression.is_physical)
        throw method_failed(
            "no double pendulum moves like this: its equations leave {:.0f} % of the forces unexplained",
            100 * regression.unexplained);
    auto pieces = divide(track, short_s).segments;
    Fit fit{.model = model, .parameters = regression.parameters};
    auto& p = fit.parameters;
    const double most_coupling = 0.95 * std::sqrt(p[index_of(inertia)]);
    p[index_of(coupling)] = std::min(p[index_of(coupling)], most_coupling);
    for (const auto& segment : pieces) fit.starts.push_back(guessed_start(track, segment));
    fit.rules.scale = {std::max(3 * track.noise[0], 1e-3), std::max(3 * track.noise[1], 1e-3)};
    fit = fit_model(track, pieces, fit, {.most_passes = 12, .finds_step = false, .relative = 1e-3, .jobs = jobs}, stop);
    // the starts of long segments are among those of short ones
    Fit whole{.model = model, .rules = fit.rules, .parameters = fit.parameters};
    for (const auto& segment : division.segments)
        for (std::size_t k = 0; k < pieces.size(); ++k)
            if (pieces[k].piece == segment.piece && pieces[k].first == segment.first)
                whole.starts.push_back(fit.starts[k]);
    while (whole.starts.size() < division.segments.size())
        whole.starts.push_back(guessed_start(track, division.segments[whole.starts.size()]));
    return whole;
}

}  // namespace

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
    for (bool again = true; again;) {
        again = false;
        change = scale.asDiagonal() * even.ldlt().solve(right);
        for (Eigen::Index k = 0; k < count; ++k) {
            const auto parameter = fit.model.fitted[static_cast<std::size_t>(places[static_cast<std::size_t>(k)])];
            const double value = fit.parameters[index_of(parameter)];
            constexpr double margin = 1e-9;
            if (!is_friction(parameter) || value + change[k] >= -margin * value) continue;
            const double to_zero = -value / scale[k];
            right -= even.col(k) * to_zero;
            even.row(k).setZero();
            even.col(k).setZero();
            even(k, k) = 1;
            right[k] = to_zero;
            again = true;
        }
    }
    return moved(fit, places, change);
}

ModelLadder climb(const Track& track, Bodies bodies, int jobs, const std::atomic<bool>& stop,
                  const std::function<void(std::size_t done, std::size_t of)>& report) {
    ModelLadder ladder{.division = divide(track)};
    const auto& [segments, units] = ladder.division;
    const auto plans = plans_of(bodies);
    constexpr double roughly = 1e-4;  // enough to compare
    const auto first = first_fit(track, ladder.division, model_of(false, 0, Drag::own, 0), jobs, stop);
    Fit start = first;
    for (const auto& plan : plans) {
        throw_if_set(stop);
        FittedModel rung{.name = plan.name, .model = plan.model};
        if (plan.model.point_masses != start.model.point_masses) start = first;
        start.model = plan.model;
        for (std::size_t k = index_of(viscous_1); k < dynamic_count; ++k)
            if (!fits(plan.model, static_cast<FitParameter>(k))) start.parameters[k] = 0;
        rung.fit = fit_model(track, segments, start, {.step_share = 0.2, .relative = roughly, .jobs = jobs}, stop);
        leave_out(track, ladder.division, rung, jobs, stop);
        rung.parameters = rung.fit.free().size();
        start = rung.fit;
        start.sums.clear();
        ladder.rungs.push_back(std::move(rung));
        report(ladder.rungs.size(), plans.size());
    }
    const auto& rungs = ladder.rungs;
    const auto choose = [&](const auto& may) {
        std::size_t best = 0;
        for (std::size_t k = 0; k < rungs.size(); ++k)
            if (may(rungs[k]) && (!may(rungs[best]) || rungs[k].left_out_rms < rungs[best].left_out_rms)) best = k;
        for (std::size_t k = 0; k < rungs.size(); ++k)
            if (may(rungs[k]) && serves(rungs[k], rungs[best])) return std::pair(k, best);
        return std::pair(best, best);
    };
    std::tie(ladder.chosen, ladder.best) = choose([](const FittedModel&) { return true; });
    ladder.for_preset = choose([](const FittedModel& rung) { return rung.model.drag == Drag::own; }).first;
    return ladder;
}

}  // namespace doppel
