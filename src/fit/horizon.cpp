#include "fit/horizon.hpp"

#include "base/error.hpp"
#include "base/threads.hpp"
#include "fit/flow.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace doppel {
namespace {

/// On the track's clock.
double time_of(const Track& track, const TrackSegment& segment, std::size_t sample) {
    const auto& times = track.pieces[segment.piece].time_s;
    return track.start_s[segment.piece] + times[sample] - times.front();
}

/// The start, fitted to the first seconds of a unit alone, and its normal matrix; nothing where no motion stays finite.
std::optional<Fit> fitted_start(const FitJob& job, const TrackSegment& segment, const Fit& fit,
                                const ArmState<double>& guess) {
    auto start = fit.without_sums();
    start.segments = {segment}, start.starts = {guess}, start.model.fitted.clear();
    try {
        return fit_model(job, std::move(start),
                         {.most_passes = 10, .finds_scale = false, .step_share = 0, .relative = 1e-5});
    } catch (const Error& error) {  // of this prediction alone
        if (error.code() != ExitCode::method_failed) throw;
        return std::nullopt;
    }
}

/// Goes along a segment after the data, by the motion from a fitted start. False where the error is well beyond the limit.
bool follow(const Track& track, const TrackSegment& segment, bool is_first_piece, double limit, const Fit& start,
            Flow<double>& flow, Prediction& prediction) {
    constexpr double kept_every_s = 0.02, afterwards_s = 10, far = 10, turn = 2 * std::numbers::pi;  // far: limits
    const auto& piece = track.pieces[segment.piece];
    auto &times = prediction.time_s, &errors = prediction.error;
    for (std::size_t i = segment.first; i < segment.last; ++i) {
        const double from_start = time_of(track, segment, i) - prediction.start_s, t = from_start - prediction.data_s;
        if (t <= 0) continue;
        double error = 0;
        for (std::size_t arm = 0; arm < 2; ++arm) {
            if (piece.is_outlier[arm][i]) continue;
            const auto shown = shown_angle(start.parameters, flow, arm, from_start);
            if (!shown) return false;
            double off = piece.angle[arm][i] - *shown;
            if (!is_first_piece) off -= turn * std::round(off / turn);  // a piece may count turns anew
            error = std::max(error, std::abs(off));
        }
        if (error > limit && !prediction.left_s) prediction.left_s = t;
        if (!prediction.left_s) prediction.within_s = t;
        if (times.empty() || t - times.back() >= kept_every_s) times.push_back(t), errors.push_back(error);
        if (error > far * limit || (prediction.left_s && t > *prediction.left_s + afterwards_s)) return false;
    }
    return true;
}

/// When one standard error of start, or of parameters, has grown to the limit.
void attribute(const Fit& fit, const Fit& start, const Uncertainty& uncertainty, double limit, Prediction& prediction) {
    const auto& fitted = fit.model.fitted;
    const auto moving = std::count_if(fitted.begin(), fitted.end(), is_dynamic);  // the first of them
    const Eigen::MatrixXd of_parameters = uncertainty.covariance.topLeftCorner(moving, moving);
    const Eigen::Matrix4d of_start = inverse_of(start.sums[0].matrix) * std::pow(uncertainty.inflation, 2);
    constexpr double looked_at_s = 40, beyond = 1.7, steps = 2;  // as fine as a standard error is known
    const double step = steps * fit.rules.step_s;
    const double end = prediction.data_s + std::min(looked_at_s, beyond * std::max(prediction.within_s, 1.0));
    auto flow = varied_flow<all_directions>(fit.model, fit.parameters, start.starts[0], step);
    for (double t = prediction.data_s; t < end; t += step) {
        if (!flow.reach(t)) return;
        double from_start = 0, from_parameters = 0;
        for (std::size_t arm = 0; arm < 2; ++arm) {
            const Eigen::VectorXd by = flow.angle(arm, t).tangent, by_parameters = by.segment(4, moving);
            from_start = std::max(from_start, by.head<4>().dot(of_start * by.head<4>()));
            from_parameters = std::max(from_parameters, by_parameters.dot(of_parameters * by_parameters));
        }
        const auto note = [&](double square, std::optional<double>& when) {
            if (!when && square > limit * limit) when = t - prediction.data_s;
        };
        note(from_start, prediction.start_alone_s);
        note(from_parameters, prediction.parameters_alone_s);
        if (prediction.start_alone_s && prediction.parameters_alone_s) return;
    }
}

/// 0 the model, 1 the start, 2 the parameters (Horizon::left_by).
std::size_t limit_of(const Prediction& prediction) {
    constexpr double never = 1e300, much = 0.6;
    const double start = prediction.start_alone_s.value_or(never);
    const double parameters = prediction.parameters_alone_s.value_or(never);
    if (prediction.within_s < much * std::min(start, parameters)) return 0;
    return start < parameters ? 1 : 2;
}

Prediction predict(const FitJob& job, const Units& units, std::size_t unit, const Fit& fit,
                   const Uncertainty& uncertainty, double limit) {
    const auto& track = job.track;
    constexpr double data_s = 2, most_of_unit = 0.75;  // something must be left to predict
    const auto& own = units[unit];
    auto segment = fit.segments[own.front()];
    const auto& times = track.pieces[segment.piece].time_s;
    const double begin = times[segment.first], length = times[fit.segments[own.back()].last - 1] - begin;
    const auto end = std::upper_bound(times.begin(), times.end(), begin + std::min(data_s, most_of_unit * length));
    segment.last = static_cast<std::size_t>(end - times.begin());
    Prediction prediction{.start_s = time_of(track, segment, segment.first),
                          .data_s = times[segment.last - 1] - begin,
                          .time_s = {},
                          .error = {}};
    // each unit after is judged by parameters that know neither it nor the first
    std::optional<Fit> start;
    for (std::size_t judged = unit; judged < units.size(); ++judged) {
        auto out = own;
        if (judged != unit) out.insert(out.end(), units[judged].begin(), units[judged].end());
        const auto without = fit_without(fit, out);
        const auto next = fitted_start(job, segment, without, start ? start->starts[0] : without.starts[own.front()]);
        if (!next) break;
        start = next;
        Flow<double> flow(arms_of(start->model, start->parameters), start->starts[0], start->rules.step_s);
        const auto& follows = units[judged];
        if (!std::all_of(follows.begin(), follows.end(), [&](std::size_t k) {
                const auto& other = fit.segments[k];
                return follow(track, other, other.piece == segment.piece, limit, *start, flow, prediction);
            }))
            break;
    }
    if (start) attribute(fit, *start, uncertainty, limit, prediction);
    return prediction;
}

}  // namespace

std::optional<double> median_of(std::vector<std::pair<double, bool>> times) {
    std::sort(times.begin(), times.end(), [](const auto& a, const auto& b) {
        return a.first < b.first || (a.first == b.first && a.second && !b.second);  // ends before what goes on
    });
    double remaining = 1;
    for (std::size_t k = 0; k < times.size(); ++k) {
        if (!times[k].second) continue;
        remaining *= 1 - 1 / static_cast<double>(times.size() - k);
        if (remaining <= 0.5 + 1e-12) return times[k].first;
    }
    return std::nullopt;
}

Horizon measure_horizon(const FitJob& job, const Units& units, const Fit& fit, const Uncertainty& uncertainty) {
    Horizon horizon;
    constexpr double noises = 5;  // so that no single sample's noise ends a prediction
    horizon.limit = std::max(horizon.limit, noises * std::max(job.track.noise[0], job.track.noise[1]));
    std::vector<Prediction> all(units.size());
    parallel_for(all.size(), job.threads, [&](std::size_t u) {
        all[u] = predict({job.track, job.stop}, units, u, fit, uncertainty, horizon.limit);
    });
    std::vector<std::pair<double, bool>> times;
    for (auto& prediction : all) {
        if (prediction.time_s.empty()) continue;
        times.emplace_back(prediction.within_s, prediction.left_s.has_value());
        horizon.longest_s = std::max(horizon.longest_s, prediction.within_s);
        if (prediction.left_s) ++horizon.left_by[limit_of(prediction)];
        horizon.predictions.push_back(std::move(prediction));
    }
    horizon.median_s = median_of(times);
    return horizon;
}

}  // namespace doppel
