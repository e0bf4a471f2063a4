#include "fit/horizon.hpp"

#include "base/threads.hpp"
#include "fit/flow.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace doppel {
namespace {

/// On the track's clock.
double time_of(const Track& track, const Shot& shot, std::size_t sample) {
    const auto& times = track.pieces[shot.piece].time_s;
    return track.start_s[shot.piece] + times[sample] - times.front();
}

/// Follows a shot after the data by the motion from a fitted start. Returns false once the error is far above the
/// limit.
bool follow(const Track& track, const Shot& shot, bool is_first_piece, double limit, const Parameters& p, Flow<>& flow,
            Prediction& prediction) {
    constexpr double kept_every_s = 0.02, afterwards_s = 10, far = 10, turn = 2 * std::numbers::pi;  // far: limits
    const auto& piece = track.pieces[shot.piece];
    auto &times = prediction.time_s, &errors = prediction.error;
    const double begin = time_of(track, shot, 0) - prediction.start_s - prediction.data_s;
    for (std::size_t i = shot.first; i < shot.last; ++i) {
        const double from_start = time_of(track, shot, i) - prediction.start_s, t = from_start - prediction.data_s;
        if (t <= 0) continue;
        double error = 0;
        for (std::size_t link = 0; link < 2; ++link) {
            if (piece.is_outlier[link][i]) continue;
            const double at = from_start + (link == 1 ? p[lag] : 0);
            if (!flow.reach(at)) return false;
            double difference =
                piece.angle[link][i] - (p[offset_1 + link] + p[scale_1 + link] * flow.angle(link, at)[0]);
            if (!is_first_piece)
                difference -= turn * std::round(difference / turn);  // a new piece may count turns differently
            error = std::max(error, std::abs(difference));
        }
        if (error > limit && !prediction.left_s) {
            prediction.left_s = t;
            prediction.left_in_gap = !is_first_piece && prediction.within_s < begin;
        }
        if (!prediction.left_s) prediction.within_s = t;
        if (times.empty() || t - times.back() >= kept_every_s) times.push_back(t), errors.push_back(error);
        if (error > far * limit || (prediction.left_s && t > *prediction.left_s + afterwards_s)) return false;
    }
    return true;
}

/// Finds when the effect of one standard error of the start, and of the parameters, reaches the limit.
void attribute(const Fit& fit, const Shot& start, const Uncertainty& uncertainty, double limit,
               Prediction& prediction) {
    constexpr double max_search_s = 40, beyond = 1.7, steps = 2;  // as precise as a standard error is known
    const double step = steps * fit.step_s;
    const double end = prediction.data_s + std::min(max_search_s, beyond * std::max(prediction.within_s, 1.0));
    const auto of_parameters = uncertainty.covariance.topLeftCorner<dynamic_count, dynamic_count>();
    const Eigen::Matrix4d of_start = start.sums.inverse_of_start() * std::pow(uncertainty.inflation, 2);
    auto &start_s = prediction.start_alone_s, &parameters_s = prediction.parameters_alone_s;
    Flow<all_directions> flow(fit.model, fit.parameters, start.start, step);
    for (double t = prediction.data_s; t < end && flow.reach(t) && !(start_s && parameters_s); t += step)
        for (std::size_t link = 0; link < 2; ++link) {
            const auto angle = flow.angle(link, t);
            const LinkState by_start = angle.segment<4>(1);
            const Eigen::Matrix<double, dynamic_count, 1> by_parameters = angle.tail<dynamic_count>();
            const auto note = [&](std::optional<double>& when, double variance) {
                if (!when && variance > limit * limit) when = t - prediction.data_s;
            };
            note(start_s, by_start.dot(of_start * by_start));
            note(parameters_s, by_parameters.dot(of_parameters * by_parameters));
        }
}

Prediction predict(const FitJob& job, std::size_t unit, const Fit& fit, const Uncertainty& uncertainty, double limit) {
    const auto& track = job.track;
    constexpr double data_s = 2, max_share_of_unit = 0.75;  // so that there is something left to predict
    const auto own = fit.unit(unit);
    auto shot = own.front();
    const auto& times = track.pieces[shot.piece].time_s;
    const double begin = times[shot.first], length = times[own.back().last - 1] - begin;
    const auto end = std::upper_bound(times.begin(), times.end(), begin + std::min(data_s, max_share_of_unit * length));
    shot.last = static_cast<std::size_t>(end - times.begin());
    Prediction prediction{.start_s = time_of(track, shot, shot.first), .data_s = times[shot.last - 1] - begin};
    // each later unit is judged by parameters fitted without it and without the first
    for (auto judged = unit; judged < fit.units(); ++judged) {
        const auto without = stepped(fit, 0, unit, judged);
        if (judged == unit) shot.start = without.unit(unit).front().start;
        const auto start = fit_starts(job, without, {&shot, 1}, 10, 1e-5);
        if (!start) break;
        shot = start->shots.front();
        Flow<> flow(start->model, start->parameters, shot.start, start->step_s);
        const auto follows = fit.unit(judged);
        if (!std::all_of(follows.begin(), follows.end(), [&](const Shot& next) {
                return follow(track, next, next.piece == shot.piece, limit, start->parameters, flow, prediction);
            }))
            break;
    }
    if (!prediction.time_s.empty()) attribute(fit, shot, uncertainty, limit, prediction);
    return prediction;
}

}  // namespace

std::optional<double> median_of(std::vector<std::pair<double, bool>> times) {
    std::sort(times.begin(), times.end(), [](const auto& a, const auto& b) {
        return a.first < b.first || (a.first == b.first && a.second &&
                                     !b.second);  // at equal times, predictions that ended come before censored ones
    });
    double remaining = 1;
    for (std::size_t k = 0; k < times.size(); ++k) {
        if (!times[k].second) continue;
        remaining *= 1 - 1 / static_cast<double>(times.size() - k);
        if (remaining <= 0.5 + 1e-12) return times[k].first;
    }
    return std::nullopt;
}

Horizon measure_horizon(const FitJob& job, const Fit& fit, const Uncertainty& uncertainty) {
    Horizon horizon;
    constexpr double noises = 5;                 // so that no single sample's noise ends a prediction
    constexpr double never = 1e300, much = 0.6;  // relative to the time at which errors of start or parameters end it
    horizon.limit = std::max(horizon.limit, noises * std::max(job.track.noise[0], job.track.noise[1]));
    std::vector<Prediction> all(fit.units());
    parallel_for(all.size(), job.threads, [&](std::size_t unit) {
        all[unit] = predict({job.track, job.stop}, unit, fit, uncertainty, horizon.limit);
    });
    std::vector<std::pair<double, bool>> times;
    for (auto& prediction : all) {
        if (prediction.time_s.empty()) continue;
        horizon.longest_s = std::max(horizon.longest_s, prediction.within_s);
        const double start = prediction.start_alone_s.value_or(never);
        const double parameters = prediction.parameters_alone_s.value_or(never);
        const bool by_model = prediction.within_s < much * std::min(start, parameters);
        if (by_model && prediction.left_in_gap) {  // the pieces may be separate motions
            ++horizon.ended_by_gap;
            prediction.left_s.reset();
            auto& shown = prediction.time_s;
            shown.erase(std::ranges::upper_bound(shown, prediction.within_s), shown.end());
            prediction.error.resize(shown.size());
        }
        times.emplace_back(prediction.within_s, prediction.left_s.has_value());
        if (prediction.left_s) ++horizon.left_by[by_model ? 0 : start < parameters ? 1 : 2];
        horizon.predictions.push_back(std::move(prediction));
    }
    horizon.median_s = median_of(times);
    return horizon;
}

}  // namespace doppel
