#include "fit/page.hpp"

#include "fit/report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN(), mrad = 1e3;

Curve curve_of(std::size_t arm, Mark mark) {
    return {.label = mark == Mark::points ? "" : arm == 0 ? "θ1" : "θ2", .mark = mark, .hue = static_cast<int>(arm)};
}

/// The first shot: some samples as points, the model as lines.
Plot track_plot(const FitResult& result) {
    const auto& shot = result.chosen().fit.shots.front();
    const auto& piece = result.track.pieces[shot.piece];
    Plot plot{.title = "A stretch of the track", .note = "points: measured, lines: model"};
    const double begin = piece.time_s[shot.first];
    plot.x = {.label = "time, s", .low = 0, .high = piece.time_s[shot.last - 1] - begin};
    plot.y = {.label = "angle, rad"};
    constexpr std::size_t points = 60;
    for (const auto mark : {Mark::line, Mark::points})
        for (std::size_t arm = 0; arm < 2; ++arm) {
            auto& curve = plot.curves.emplace_back(curve_of(arm, mark));
            const auto every = mark == Mark::line ? 1 : std::max<std::size_t>(shot.size() / points, 1);
            for (std::size_t i = shot.first; i < shot.last; i += every) {
                const double residual = shot.sums.residuals[i - shot.first][arm];
                curve.x.push_back(piece.time_s[i] - begin);
                curve.y.push_back(piece.angle[arm][i] - (mark == Mark::line ? residual : 0));
            }
        }
    return plot;
}

/// All residuals, piece after piece, thinned to what a panel can show: the one of a stretch that is largest.
Plot residual_plot(const FitResult& result) {
    const auto& fit = result.chosen().fit;
    Plot plot{.title = "Residuals, measured − model", .note = fmt::format("rms {:.2g} mrad", mrad * fit.rms)};
    plot.y = {.label = "residual, mrad"};
    constexpr double points = 900;
    const auto bin = static_cast<std::size_t>(std::max(static_cast<double>(result.track.samples()) / points, 1.0));
    double end = 0;
    std::array curves{curve_of(0, Mark::line), curve_of(1, Mark::line)};
    for (const auto& shot : fit.shots) {
        const auto* times = result.track.pieces[shot.piece].time_s.data() + shot.first;
        for (std::size_t arm = 0; arm < 2; ++arm) {
            const auto smaller = [&](const auto& a, const auto& b) {
                return std::abs(a[arm]) < std::abs(b[arm]) || (std::isnan(a[arm]) && !std::isnan(b[arm]));
            };
            const auto all = shot.sums.residuals.begin();
            for (std::size_t from = 0; from < shot.size(); from += bin) {
                const auto to = std::min(from + bin, shot.size());
                const auto largest = std::max_element(all + static_cast<std::ptrdiff_t>(from),
                                                      all + static_cast<std::ptrdiff_t>(to), smaller);
                curves[arm].x.push_back(end + times[largest - all] - times[0]);
                curves[arm].y.push_back(mrad * (*largest)[arm]);
            }
            curves[arm].x.push_back(end);
            curves[arm].y.push_back(none);
        }
        end += times[shot.size() - 1] - times[0];
    }
    plot.x = {.label = "time measured, piece after piece, s", .low = 0, .high = end};
    const double band = 2 * mrad * fit.rms;
    plot.curves = {{.x = {0, end}, .y = {0, 0}, .uncertainty = {band, band}, .quiet = true}, curves[0], curves[1]};
    return plot;
}

/// The error on pieces left out over the number of parameters.
Plot ladder_plot(const FitResult& result) {
    Plot plot{.title = "The ladder of models", .needs_no_legend = true};
    plot.y = {.label = "rms on pieces left out, mrad", .logarithmic = true};
    double least = parameter_count, most = 0;
    for (std::size_t k = 0; k < result.ladder.rungs.size(); ++k) {
        const auto& rung = result.ladder.rungs[k];
        const bool chosen = k == result.ladder.chosen;
        const auto count = static_cast<double>(rung.fit.free_count());
        least = std::min(least, count), most = std::max(most, count);
        plot.curves.push_back({.label = fmt::format("{}{}", k + 1, chosen ? ", chosen" : ""),
                               .x = {count},
                               .y = {mrad * rung.left_out_rms},
                               .mark = Mark::points,
                               .hue = chosen ? 1 : 0,
                               .quiet = !chosen});
    }
    plot.x = {.label = "parameters fitted", .low = least - 1, .high = most + 1, .every = 1};
    return plot;
}

Plot horizon_plot(const FitResult& result) {
    Plot plot{.title = "Predictions from at most two seconds of data", .note = "not measured"};
    plot.x = {.label = "time predicted, s", .low = 0, .high = 1};
    plot.y = {.label = "largest error so far, rad", .logarithmic = true};
    if (!result.horizon) return plot;
    const auto& horizon = *result.horizon;
    std::size_t count = 0;
    for (const bool left : {true, false})
        for (const auto& p : horizon.predictions) {
            if (p.left_s.has_value() != left) continue;
            count += left;
            auto& curve = plot.curves.emplace_back(Curve{.x = p.time_s, .hue = left ? 1 : 0, .quiet = !left});
            double largest = 0;
            for (const double error : p.error) curve.y.push_back(largest = std::max(largest, error));
            plot.x.high = std::max(*plot.x.high, p.time_s.back());
        }
    plot.note = fmt::format("{} of {} left, in colour", count, horizon.predictions.size());
    plot.rules.push_back({Rule::Orientation::horizontal, horizon.limit, fmt::format("{:.2g} rad", horizon.limit)});
    if (const auto& median = horizon.median_s)
        plot.rules.push_back({Rule::Orientation::vertical, *median, fmt::format("median {:.1f} s", *median)});
    return plot;
}

}  // namespace

Figure fit_page(const FitResult& result, const std::string& name) {
    const auto& rung = result.chosen();
    const auto& track = result.track;
    std::vector<std::string> models, numbers;
    for (const auto& other : result.ladder.rungs) models.push_back(fmt::format("{} {}", models.size() + 1, other.name));
    for (const auto parameter : rung.fit.model.list())
        numbers.push_back(parameter_text(rung.fit, result.uncertainty, parameter));
    return {
        .title = fmt::format("{}: {}", name, rung.name),
        .subtitle =
            fmt::format("{} samples in {:.1f} s of {} piece{}; {} parameters", track.samples(), track.duration(),
                        track.pieces.size(), track.pieces.size() == 1 ? "" : "s", rung.fit.free_count()),
        .panels = {track_plot(result), residual_plot(result), ladder_plot(result), horizon_plot(result)},
        .columns = 2,
        .captions = {fmt::format("Models: {}.", fmt::join(models, "; ")), fmt::format("{}.", fmt::join(numbers, ",  ")),
                     residual_sentence(result) + " " + horizon_sentence(result)}};
}

}  // namespace doppel
