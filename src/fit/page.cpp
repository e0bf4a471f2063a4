#include "fit/page.hpp"

#include "fit/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
const std::array<const char*, 2> arm_names{"θ1", "θ2"};

/// The first segment: some samples as points, the model as lines.
Plot track_plot(const FitResult& result) {
    const auto& fit = result.chosen().fit;
    const auto& segment = fit.segments.front();
    const auto& piece = result.track.pieces[segment.piece];
    Plot plot{.title = "A stretch of the track", .note = "points: measured, lines: model"};
    const double begin = piece.time_s[segment.first];
    plot.x = {.label = "time, s", .low = 0, .high = piece.time_s[segment.last - 1] - begin};
    plot.y = {.label = "angle, rad"};
    constexpr std::size_t points = 60;
    const std::size_t every = std::max<std::size_t>(segment.size() / points, 1);
    for (std::size_t arm = 0; arm < 2; ++arm) {
        Curve model{.label = arm_names[arm], .hue = static_cast<int>(arm)};
        for (std::size_t i = segment.first; i < segment.last; ++i) {
            model.x.push_back(piece.time_s[i] - begin);
            model.y.push_back(piece.angle[arm][i] - fit.sums[0].residuals[i - segment.first][arm]);
        }
        plot.curves.push_back(std::move(model));
    }
    for (std::size_t arm = 0; arm < 2; ++arm) {
        Curve measured{.mark = Mark::points, .hue = static_cast<int>(arm)};
        for (std::size_t i = segment.first; i < segment.last; i += every) {
            measured.x.push_back(piece.time_s[i] - begin);
            measured.y.push_back(piece.angle[arm][i]);
        }
        plot.curves.push_back(std::move(measured));
    }
    return plot;
}

/// All residuals, piece after piece, thinned to what a panel can show: the one of a stretch that is largest.
Plot residual_plot(const FitResult& result) {
    const auto& fit = result.chosen().fit;
    const auto& segments = fit.segments;
    Plot plot{.title = "Residuals, measured − model", .note = fmt::format("rms {:.2g} mrad", 1e3 * fit.rms)};
    plot.x = {.label = "time measured, piece after piece, s"};
    plot.y = {.label = "residual, mrad"};
    constexpr double rad = 1e3, points = 900;
    const auto bin = static_cast<std::size_t>(std::max(static_cast<double>(result.track.samples()) / points, 1.0));
    double end = 0;
    std::array<Curve, 2> curves;
    for (std::size_t arm = 0; arm < 2; ++arm) curves[arm] = {.label = arm_names[arm], .hue = static_cast<int>(arm)};
    for (std::size_t k = 0; k < segments.size(); ++k) {
        const auto* times = result.track.pieces[segments[k].piece].time_s.data() + segments[k].first;
        const auto& residuals = fit.sums[k].residuals;
        for (std::size_t arm = 0; arm < 2; ++arm) {
            const auto size = [&](std::size_t i) {
                return std::isnan(residuals[i][arm]) ? 0 : std::abs(residuals[i][arm]);
            };
            for (std::size_t from = 0; from < residuals.size(); from += bin) {
                auto largest = from;
                for (auto i = from; i < std::min(from + bin, residuals.size()); ++i)
                    if (size(i) > size(largest)) largest = i;
                curves[arm].x.push_back(end + times[largest] - times[0]);
                curves[arm].y.push_back(rad * residuals[largest][arm]);
            }
            curves[arm].x.push_back(end);
            curves[arm].y.push_back(none);
        }
        end += times[residuals.size() - 1] - times[0];
    }
    plot.x.low = 0;
    plot.x.high = end;
    Curve band{.x = {0, end}, .y = {0, 0}, .quiet = true};
    band.uncertainty = {2 * rad * fit.rms, 2 * rad * fit.rms};
    plot.curves.push_back(band);
    for (auto& curve : curves) plot.curves.push_back(std::move(curve));
    return plot;
}

/// The error on pieces left out over the number of parameters.
Plot ladder_plot(const FitResult& result) {
    Plot plot{.title = "The ladder of models", .needs_no_legend = true};
    plot.x = {.label = "parameters fitted", .every = 1};
    plot.y = {.label = "rms on pieces left out, mrad", .logarithmic = true};
    constexpr double rad = 1e3;
    const auto& rungs = result.ladder.rungs;
    std::size_t least = rungs[0].fit.free_count(), most = least;
    for (std::size_t k = 0; k < rungs.size(); ++k) {
        const bool chosen = k == result.ladder.chosen;
        least = std::min(least, rungs[k].fit.free_count());
        most = std::max(most, rungs[k].fit.free_count());
        plot.curves.push_back({.label = fmt::format("{}{}", k + 1, chosen ? ", chosen" : ""),
                               .x = {static_cast<double>(rungs[k].fit.free_count())},
                               .y = {rad * rungs[k].left_out_rms},
                               .mark = Mark::points,
                               .hue = chosen ? 1 : 0,
                               .quiet = !chosen});
    }
    plot.x.low = static_cast<double>(least) - 1;
    plot.x.high = static_cast<double>(most) + 1;
    return plot;
}

Plot horizon_plot(const FitResult& result) {
    Plot plot{.title = "Predictions from at most two seconds of data"};
    plot.x = {.label = "time predicted, s", .low = 0};
    plot.y = {.label = "largest error so far, rad", .logarithmic = true};
    if (!result.horizon) {
        plot.note = "not measured";
        plot.x.high = 1;
        return plot;
    }
    const auto& horizon = *result.horizon;
    double longest = 1;
    for (const bool left : {true, false})
        for (const auto& p : horizon.predictions) {
            if (p.left_s.has_value() != left) continue;
            Curve curve{.hue = left ? 1 : 0, .quiet = !left};
            double largest = 0;
            for (std::size_t i = 0; i < p.time_s.size(); ++i) {
                largest = std::max(largest, p.error[i]);
                curve.x.push_back(p.time_s[i]);
                curve.y.push_back(largest);
            }
            longest = std::max(longest, curve.x.back());
            plot.curves.push_back(std::move(curve));
        }
    plot.x.high = longest;
    const auto left = std::count_if(horizon.predictions.begin(), horizon.predictions.end(),
                                    [](const auto& p) { return p.left_s.has_value(); });
    plot.note = fmt::format("{} of {} left, in colour", left, horizon.predictions.size());
    plot.rules.push_back({Rule::Orientation::horizontal, horizon.limit, fmt::format("{:.2g} rad", horizon.limit)});
    if (horizon.median_s)
        plot.rules.push_back(
            {Rule::Orientation::vertical, *horizon.median_s, fmt::format("median {:.1f} s", *horizon.median_s)});
    return plot;
}

}  // namespace

Figure fit_page(const FitResult& result, const std::string& name) {
    const auto& rung = result.chosen();
    Figure figure{.title = fmt::format("{}: {}", name, rung.name),
                  .subtitle = fmt::format("{} samples in {:.1f} s of {} piece{}; {} parameters", result.track.samples(),
                                          result.track.duration(), result.track.pieces.size(),
                                          result.track.pieces.size() == 1 ? "" : "s", rung.fit.free_count())};
    figure.columns = 2;
    figure.panels = {track_plot(result), residual_plot(result), ladder_plot(result), horizon_plot(result)};
    std::string numbers;
    for (const auto parameter : rung.fit.model.fitted)
        numbers += (numbers.empty() ? "" : ",  ") + parameter_words_of(rung.fit, result.uncertainty, parameter);
    std::string ladder;
    for (std::size_t k = 0; k < result.ladder.rungs.size(); ++k)
        ladder += fmt::format("{}{} {}", k == 0 ? "Models: " : "; ", k + 1, result.ladder.rungs[k].name);
    figure.captions = {ladder + ".", numbers + ".", residual_sentence(result) + " " + horizon_sentence(result)};
    return figure;
}

}  // namespace doppel
