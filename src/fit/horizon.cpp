#include "fit/horizon.hpp"

#include "base/error.hpp"
#include "base/threads.hpp"
#include "fit/flow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

constexpr double data_s = 2, looked_at_s = 40;

/// On the track's clock.
double start_of(const Track& track, const TrackSegment& segment) {
    const auto& piece = track.pieces[segment.piece];
    return track.start_s[segment.piece] + piece.time_s[segment.first] - piece.time_s.front();
}

/// The start, fitted to the first seconds of a unit alone, and its normal matrix.
Fit fitted_start(const Track& track, const TrackSegment& segment, const Fit& fit, const ArmState<double>& guess,
                 const std::atomic<bool>& stop) {
    Fit start{.model = fit.model, .rules = fit.rules, .parameters = fit.parameters, .starts = {guess}, .sums = {}};
    start.model.fitted.clear();
    return fit_model(track, {segment}, start,
                     {.most_passes = 10, .finds_scale = false, .step_share = 0, .relative = 1e-5}, stop);
}

/// A start and the motion from it.
struct Run {
    Fit fit;
    Flow<double> flow;
    explicit Run(Fit from)
        : fit(std::move(from)), flow(arms_of(fit.model, fit.parameters), fit.starts[0], fit.rules.step_s) {}

    /// How far the track is from it at t seconds from the start, rad; nothing where the motion ran away.
    std::optional<double> error(const TrackPiece& piece, std::size_t sample, double t, bool is_first) {
        double largest = 0;
        for (std::size_t arm = 0; arm < 2; ++arm) {
            if (piece.is_outlier[arm][sample]) continue;
            const auto shown = shown_angle(fit.parameters, flow, arm, t);
            if (!shown) return std::nullopt;
            double off = piece.angle[arm][sample] - *shown;
            constexpr double turn = 2 * std::numbers::pi;
            if (!is_first) off -= turn * std::round(off / turn);  // a piece may count turns anew
            largest = std::max(largest, std::abs(off));
        }
        return largest;
    }
};

/// Goes along one unit after the data. False where the error is well beyond the limit.
bool follow(const Track& track, const TrackSegment& segment, std::size_t first_piece, double limit, Run& run,
            Prediction& prediction) {
    constexpr double kept_every_s = 0.02, gap_s = 0.1, afterwards_s = 10, far = 10;  // far: limits
    const auto& piece = track.pieces[segment.piece];
    auto &times = prediction.time_s, &errors = prediction.error;
    for (std::size_t i = segment.first; i < segment.last; ++i) {
        const double from_start =
            start_of(track, segment) + piece.time_s[i] - piece.time_s[segment.first] - prediction.start_s;
        const double t = from_start - prediction.data_s;
        if (t <= 0) continue;
        const auto error = run.error(piece, i, from_start, segment.piece == first_piece);
        if (!error) return false;
        if (*error > limit && !prediction.left_s) prediction.left_s = t;
        if (!prediction.left_s) prediction.within_s = t;
        const double last = times.empty() ? -1 : times.back();
        if (t - last >= kept_every_s) {
            if (!times.empty() && t - last > gap_s) {
                times.push_back(t);
                errors.push_back(std::numeric_limits<double>::quiet_NaN());
            }
            times.push_back(t);
            errors.push_back(*error);
        }
        if (*error > far * limit || (prediction.left_s && t > *prediction.left_s + afterwards_s)) return false;
    }
    return true;
}

/// When one standard error of start, or of parameters, has grown to the limit.
void attribute(const Fit& fit, const Fit& start, const Uncertainty& uncertainty, double limit, Prediction& prediction) {
    constexpr int most = 4 + static_cast<int>(dynamic_count);
    const auto& fitted = fit.model.fitted;
    const auto moving = std::count_if(fitted.begin(), fitted.end(), is_dynamic);  // the first of them
    const Eigen::MatrixXd of_parameters = uncertainty.covariance.topLeftCorner(moving, moving);
    const Eigen::Matrix4d of_start = inverse_of(start.sums[0].matrix) * std::pow(uncertainty.inflation, 2);
    constexpr double beyond = 1.7, steps = 2;  // as fine as a standard error is known
    const double step = steps * fit.rules.step_s;
    const double end = prediction.data_s + std::min(looked_at_s, beyond * std::max(prediction.within_s, 1.0));
    auto flow = varied_flow<most>(fit.model, fit.parameters, start.starts[0], step);
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

}  // namespace

Limit limit_of(const Prediction& prediction) {
    constexpr double never = 1e300, much = 0.6;
    const double start = prediction.start_alone_s.value_or(never);
    const double parameters = prediction.parameters_alone_s.value_or(never);
    if (prediction.within_s < much * std::min(start, parameters)) return Limit::model;
    return start < parameters ? Limit::start : Limit::parameters;
}

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

Horizon measure_horizon(const Track& track, const Division& division, const Fit& fit, const Uncertainty& uncertainty,
                        int jobs, const std::atomic<bool>& stop) {
    Horizon horizon;
    constexpr double noises = 5;  // so that no single sample's noise ends a prediction
    horizon.limit = std::max(horizon.limit, noises * std::max(track.noise[0], track.noise[1]));
    const auto units = division.units.size();
    std::vector<std::optional<Prediction>> all(units);
    parallel_for(units, jobs, [&](std::size_t u) {
        const auto first = division.units[u].front();
        auto segment = division.segments[first];
        const auto& times = track.pieces[segment.piece].time_s;
        const double begin = times[segment.first];
        // the first two seconds, of which something must be left to predict
        const auto last = division.segments[division.units[u].back()].last;
        const double length = times[last - 1] - begin, used = std::min(data_s, 0.75 * length);
        segment.last =
            static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), begin + used) - times.begin());
        Prediction prediction{
            .unit = u, .start_s = start_of(track, segment), .data_s = times[segment.last - 1] - begin};
        // each unit after is judged by parameters that know neither it nor the first
        std::optional<Run> run;
        for (std::size_t judged = u; judged < units; ++judged) {
            auto out = division.units[u];
            if (judged != u) out.insert(out.end(), division.units[judged].begin(), division.units[judged].end());
            const auto without = fit_without(fit, out);
            try {
                const auto guess = run ? run->fit.starts[0] : without.starts[first];
                run.emplace(fitted_start(track, segment, without, guess, stop));
            } catch (const Error& error) {  // of this prediction alone
                if (error.code() != ExitCode::method_failed) throw;
                break;
            }
            bool goes_on = true;
            for (const auto k : division.units[judged])
                goes_on =
                    goes_on && follow(track, division.segments[k], segment.piece, horizon.limit, *run, prediction);
            if (!goes_on) break;
        }
        if (run) attribute(fit, run->fit, uncertainty, horizon.limit, prediction);
        all[u] = std::move(prediction);
    });
    std::vector<std::pair<double, bool>> times;
    for (auto& prediction : all) {
        if (prediction->time_s.empty()) continue;
        times.emplace_back(prediction->within_s, prediction->left_s.has_value());
        horizon.longest_s = std::max(horizon.longest_s, prediction->within_s);
        if (prediction->left_s) ++horizon.left_by[static_cast<std::size_t>(limit_of(*prediction))];
        horizon.predictions.push_back(std::move(*prediction));
    }
    horizon.median_s = median_of(times);
    return horizon;
}

}  // namespace doppel
