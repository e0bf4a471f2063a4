#include "fit/report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

constexpr double mrad = 1e3;
constexpr std::array<const char*, 2> names{"θ1", "θ2"};  // of the arms

/// The first shot: some samples as points, the model as lines.
Plot track_plot(const FitResult& result) {
    const auto& shot = result.chosen().fit.shots.front();
    const auto& piece = result.track.pieces[shot.piece];
    const double begin = piece.time_s[shot.first];
    Plot plot{.title = "A stretch of the track", .note = "points: measured, lines: model"};
    plot.x = {.label = "time, s", .low = 0, .high = piece.time_s[shot.last - 1] - begin};
    plot.y = {.label = "angle, rad"};
    constexpr std::size_t points = 60;
    for (const bool measured : {false, true})
        for (std::size_t arm = 0; arm < 2; ++arm) {
            Curve curve{.label = measured ? "" : names[arm], .hue = static_cast<int>(arm)};
            if (measured) curve.mark = Mark::points;
            for (std::size_t i = 0; i < shot.size();
                 i += measured ? std::max<std::size_t>(shot.size() / points, 1) : 1) {
                const auto sample = shot.first + i;
                curve.x.push_back(piece.time_s[sample] - begin);
                curve.y.push_back(piece.angle[arm][sample] - (measured ? 0 : shot.sums.residuals[i][arm]));
            }
            plot.curves.push_back(std::move(curve));
        }
    return plot;
}

/// All residuals, piece after piece, thinned to what a panel can show: the one of a stretch that is largest.
Plot residual_plot(const FitResult& result) {
    const auto& fit = result.chosen().fit;
    constexpr double points = 900, none = std::numeric_limits<double>::quiet_NaN();
    const auto bin = static_cast<std::size_t>(std::max(static_cast<double>(result.track.samples()) / points, 1.0));
    double end = 0;
    std::array curves{Curve{.label = names[0], .hue = 0}, Curve{.label = names[1], .hue = 1}};
    for (const auto& shot : fit.shots) {
        const auto* times = result.track.pieces[shot.piece].time_s.data() + shot.first;
        const auto& residuals = shot.sums.residuals;
        for (std::size_t arm = 0; arm < 2; ++arm) {
            auto &x = curves[arm].x, &y = curves[arm].y;
            for (std::size_t from = 0; from < shot.size(); from += bin) {
                auto largest = from;
                for (auto i = from; i < std::min(from + bin, shot.size()); ++i)
                    if (std::isnan(residuals[largest][arm]) ||
                        std::abs(residuals[i][arm]) > std::abs(residuals[largest][arm]))
                        largest = i;
                x.push_back(end + times[largest] - times[0]), y.push_back(mrad * residuals[largest][arm]);
            }
            x.push_back(end), y.push_back(none);
        }
        end += times[shot.size() - 1] - times[0];
    }
    const double band = 2 * mrad * fit.rms;
    Plot plot{.title = "Residuals, measured − model", .note = fmt::format("rms {:.2g} mrad", mrad * fit.rms)};
    plot.x = {.label = "time measured, piece after piece, s", .low = 0, .high = end};
    plot.y = {.label = "residual, mrad"};
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
                               .hue = chosen,
                               .quiet = !chosen});
    }
    plot.x = {.label = "parameters fitted", .low = least - 1, .high = most + 1, .every = 1};
    return plot;
}

Plot horizon_plot(const std::optional<Horizon>& horizon) {
    Plot plot{.title = "Predictions from at most two seconds of data", .note = "not measured"};
    plot.x = {.label = "time predicted, s", .low = 0, .high = 1};
    plot.y = {.label = "largest error so far, rad", .logarithmic = true};
    if (!horizon) return plot;
    for (const bool left : {true, false})
        for (const auto& p : horizon->predictions) {
            if (p.left_s.has_value() != left) continue;
            auto& curve = plot.curves.emplace_back(Curve{.x = p.time_s, .hue = left, .quiet = !left});
            double largest = 0;
            for (const double error : p.error) curve.y.push_back(largest = std::max(largest, error));
            plot.x.high = std::max(*plot.x.high, p.time_s.back());
        }
    plot.note = fmt::format("{} of {} left, in colour", horizon->left(), horizon->predictions.size());
    plot.rules.push_back({Rule::Orientation::horizontal, horizon->limit, fmt::format("{:.2g} rad", horizon->limit)});
    if (const auto& median = horizon->median_s)
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
        .panels = {track_plot(result), residual_plot(result), ladder_plot(result), horizon_plot(result.horizon)},
        .columns = 2,
        .captions = {fmt::format("Models: {}.", fmt::join(models, "; ")), fmt::format("{}.", fmt::join(numbers, ",  ")),
                     residual_sentence(result) + " " + horizon_sentence(result)}};
}

}  // namespace doppel
