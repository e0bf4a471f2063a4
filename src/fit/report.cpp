#include "fit/report.hpp"

#include "base/text.hpp"
#include "numeric/portable_math.hpp"
#include "scene/captions.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

namespace doppel {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

std::vector<std::string> files_of(const Track& track) {
    std::vector<std::string> files;
    for (const auto& piece : track.pieces)
        if (files.empty() || files.back() != piece.name) files.push_back(piece.name);
    return files;
}

template <class Range, class Make>
Json list_of(const Range& range, Make make) {
    Json list = Json::array();
    for (const auto& one : range) list.push_back(make(one));
    return list;
}

Json or_null(const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
}

Json model_json(const FittedModel& candidate, const Uncertainty& uncertainty) {
    const auto parameters = candidate.fit.model.list();
    Json ratios = Json::object();
    for (const auto parameter : parameters) {
        auto& ratio = ratios[std::string(parameter_words[parameter].key)];
        ratio = {{"value", candidate.fit.parameters[parameter]},
                 {"standard_error", uncertainty.standard_error(parameter)}};
        if (candidate.fit.is_at_bound(parameter)) ratio["at_bound"] = true;
    }
    const auto correlations = [&](auto one) {
        return list_of(parameters, [&](auto other) {
            const double product = uncertainty.standard_error(one) * uncertainty.standard_error(other);
            return product > 0 ? uncertainty.covariance(one, other) / product : 0;
        });
    };
    return {{"name", candidate.name},
            {"ratios_to_B", ratios},
            {"correlations",
             {{"parameters", list_of(parameters, [](auto p) { return parameter_words[p].key; })},
              {"matrix", list_of(parameters, correlations)}}},
            {"rms_rad", candidate.fit.rms},
            {"left_out_rms_rad", candidate.left_out_rms}};
}

Json horizon_json(const FitResult& result) {
    if (!result.horizon) return {{"sentence", horizon_sentence(result)}};
    const auto& horizon = *result.horizon;
    const auto& by = horizon.left_by;
    return {{"limit_rad", horizon.limit},
            {"median_s", or_null(horizon.median_s)},
            {"longest_s", horizon.longest_s},
            {"left_by", {{"model", by[0]}, {"start", by[1]}, {"parameters", by[2]}}},
            {"ended_by_gap", horizon.ended_by_gap},
            {"sentence", horizon_sentence(result)},
            {"predictions", list_of(horizon.predictions, [](const Prediction& p) {
                 return Json{{"start_s", p.start_s},
                             {"data_s", p.data_s},
                             {"within_s", p.within_s},
                             {"left_s", or_null(p.left_s)},
                             {"start_alone_s", or_null(p.start_alone_s)},
                             {"parameters_alone_s", or_null(p.parameters_alone_s)}};
             })}};
}

}  // namespace

std::string residual_sentence(const FitResult& result) {
    const auto& u = result.uncertainty;
    const double rms = result.chosen().fit.rms;
    if (u.is_white)
        return fmt::format(
            "Residuals look like noise of {:.2g} rad: neighbours are not correlated beyond chance ({:.2f} and "
            "{:.2f}).",
            rms, u.neighbour[0], u.neighbour[1]);
    const double noise = std::max(result.track.noise[0], result.track.noise[1]);
    std::string why = "the measurement noise may be like this";
    if (rms > 2 * noise)
        why = fmt::format("from sample to sample the angles scatter by only {:.1g} mrad, so the error is the model's",
                          1e3 * noise);
    const auto how = std::ranges::max(u.neighbour) > 1 / std::numbers::e
                         ? fmt::format("keep their sign for about {:.2g} s", std::ranges::max(u.memory_s))
                         : fmt::format("are correlated within ten samples (neighbours by {:.2f} and {:.2f})",
                                       u.neighbour[0], u.neighbour[1]);
    return fmt::format(
        "Residuals of {:.2g} rad are not white noise: they {}; {}. Standard errors include this ({:.2g} times those of "
        "white noise).",
        rms, how, why, u.inflation);
}

std::string horizon_sentence(const FitResult& result) {
    if (!result.horizon)
        return result.track.start_s.empty()
                   ? "No prediction horizon: the start times of the pieces are unknown; give --every SECONDS."
                   : "No prediction horizon: the pieces are too short to predict from.";
    const auto& h = *result.horizon;
    const int left = h.left();
    const auto span = [&](auto member) {
        const auto [minimum, maximum] = std::ranges::minmax(h.predictions, {}, member);
        const auto from = fmt::format("{:.1f}", minimum.*member), to = fmt::format("{:.1f}", maximum.*member);
        return from == to ? from : from + " to " + to;
    };
    auto sentence =
        fmt::format("Predictions from {} s of data stay within {:.2g} rad ", span(&Prediction::data_s), h.limit);
    const auto gaps = h.ended_by_gap > 0
                          ? fmt::format(" {} ended at a gap: the next piece is another motion, or the model is wrong.",
                                        h.ended_by_gap)
                          : "";
    if (left == 0) {
        // among those observed for the median time or longer: (1 − p)ⁿ = 5 %
        std::vector<double> seen;
        for (const auto& p : h.predictions) seen.push_back(p.within_s);
        std::sort(seen.begin(), seen.end());
        const auto count = seen.size() - seen.size() / 2;
        return sentence +
               fmt::format(
                   "to the end of the track, {} s. Of the {} that ran for {:.1f} s or more, none exceeded "
                   "it: at 95 % confidence at most {:.0f} % would.",
                   span(&Prediction::within_s), count, seen[seen.size() / 2],
                   100 * (1 - portable_pow(0.05, 1 / static_cast<double>(count)))) +
               gaps;
    }
    sentence += h.median_s ? fmt::format("for {:.1f} s (median)", *h.median_s)
                           : fmt::format("beyond the end of the track, {:.1f} s", h.longest_s);
    constexpr std::array<const char*, 3> names{"the model", "the start", "the parameters"};
    std::string because;
    for (std::size_t k = 0; k < names.size(); ++k)
        if (h.left_by[k] > 0) because += fmt::format("{}{} ({})", because.empty() ? "" : ", ", names[k], h.left_by[k]);
    return sentence + fmt::format("; {} of {} exceeded it, limited by {}.", left, h.predictions.size(), because) + gaps;
}

std::string parameter_text(const Fit& fit, const Uncertainty& uncertainty, std::size_t parameter) {
    const auto& words = parameter_words[parameter];
    const double error = uncertainty.standard_error(parameter);
    const int decimals = error > 0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, 12) : 6;
    const double value = fit.parameters[parameter];
    const auto shown_error = decimals < 12 ? fmt::format("{:.{}f}", error, decimals) : scientific(error);
    return fmt::format("{} = {}{:.{}f} ± {}{}", words.symbol, value < 0 ? "−" : "", std::abs(value), decimals,
                       shown_error, words.unit);
}

std::string fitted_preset(const FitResult& result, const std::string& name) {
    const auto& candidate = result.chosen();
    const auto& p = result.pendulum;
    const auto files = files_of(result.track);
    const auto& shot = candidate.fit.shots.front();
    // the uncertainty of the start by itself; its correlation with the parameters would add little
    const Eigen::Matrix4d covariance = shot.sums.inverse_of_start();
    const LinkState errors = covariance.diagonal().cwiseMax(0).cwiseSqrt() * result.uncertainty.inflation;
    auto text = fmt::format(
        "# Fitted by doppel fit to {}{}: {}.\n"
        "# Its error is {:.2g} rad on pieces left out. Errors, models and prediction horizon are in {}.fit.json.\n"
        "# Angles determine only ratios: gravity and the second mass are given, {}.\n"
        "title = {}\n\n[scene]\nduration_s = 30\n\n[system]\n",
        on_one_line(std::filesystem::path(files[0]).filename().string()),
        files.size() == 1 ? "" : fmt::format(" and {} more", files.size() - 1), candidate.name, candidate.left_out_rms,
        name, p.rule, toml_text(name + ", as fitted"));
    const auto add = [&](const std::string& key, double first, double second) {
        text += fmt::format("{} = [{:.10g}, {:.10g}]\n", key, first, second);
    };
    for (const auto& [key, values] : p.links)
        if ((values[0] != 0 || values[1] != 0) && !(candidate.fit.model.point_masses && key == "center_m"))
            add(key, values[0], values[1]);
    text += fmt::format("gravity_m_per_s2 = {}\n", p.gravity);
    const LinkState start = degrees * shot.start, further = degrees * (shot.start + errors);
    add("angle_deg", start[0], start[1]);
    add("omega_deg_per_s", start[2], start[3]);
    text += "accuracy = 1e-6\n\n[b]  # released one standard error further\n";
    add("angle_deg", further[0], further[1]);
    if (result.horizon && result.horizon->median_s)
        text += fmt::format("\n[video]\nmodel_limit_s = {:.3g}  # the median of predictions of this track\n",
                            *result.horizon->median_s);
    return text;
}

Json fit_json(const FitResult& result) {
    const auto& track = result.track;
    const auto& uncertainty = result.uncertainty;
    const auto& [links, gravity, second_inertia, rule] = result.pendulum;
    Json pendulum = {{"convention", rule}, {"gravity_m_per_s2", gravity}, {"B_kg_m2", second_inertia}};
    for (const auto& [key, values] : links) pendulum[key] = values;
    const auto file_name = [](const std::string& file) {
        std::error_code ignored;  // if the current folder was removed, the path is empty
        return on_one_line(std::filesystem::proximate(file, ignored).string());
    };
    const auto candidate_json = [](const FittedModel& candidate) {
        return Json{{"model", candidate.name},        {"parameters", candidate.fit.free_count()},
                    {"rms_rad", candidate.fit.rms},   {"left_out_rms_rad", candidate.left_out_rms},
                    {"passes", candidate.fit.passes}, {"step_s", candidate.fit.step_s}};
    };
    const auto start_json = [&](const Shot& shot) {
        const auto& y = shot.start;
        return Json{{"piece", shot.piece},
                    {"time_s", track.pieces[shot.piece].time_s[shot.first]},
                    {"angle_rad", {y[0], y[1]}},
                    {"rate_rad_per_s", {y[2], y[3]}}};
    };
    Json json = {{"doppel", program_json()},
                 {"track",
                  {{"files", list_of(files_of(track), file_name)},
                   {"pieces", track.pieces.size()},
                   {"samples", track.samples()},
                   {"seconds", track.duration()},
                   {"noise_rad", track.noise},
                   {"left_out_angles", track.outliers()},
                   {"notes", track.notes}}},
                 {"model", model_json(result.chosen(), uncertainty)},
                 {"starts", list_of(result.chosen().fit.shots, start_json)},
                 {"models", list_of(result.hierarchy.candidates, candidate_json)},
                 {"residuals",
                  {{"like_noise", uncertainty.is_white},
                   {"neighbour_correlation", uncertainty.neighbour},
                   {"memory_s", uncertainty.memory_s},
                   {"inflation", uncertainty.inflation},
                   {"sentence", residual_sentence(result)}}},
                 {"horizon", horizon_json(result)},
                 {"pendulum", pendulum}};
    if (const auto& period = result.period)
        json["track"]["period"] = {{"seconds", period->seconds}, {"standard_error", period->standard_error}};
    return json;
}

void write_residuals(const FitResult& result, const std::filesystem::path& place) {
    Csv table(place, {"piece", "time_s", "theta1_rad", "theta2_rad", "residual1_rad", "residual2_rad"});
    for (const auto& shot : result.chosen().fit.shots) {
        const auto& piece = result.track.pieces[shot.piece];
        for (std::size_t i = shot.first; i < shot.last; ++i) {
            table.add(static_cast<long>(shot.piece));
            for (const double value : {piece.time_s[i], piece.angle[0][i], piece.angle[1][i]}) table.add(value);
            for (const double residual : shot.sums.residuals[i - shot.first]) table.add_or_empty(residual);
            table.end_row();
        }
    }
    table.finish();
}

// The page of a fit.

namespace {

constexpr double mrad = 1e3;
constexpr std::array<const char*, 2> names{"θ₁", "θ₂"};  // of the links

/// The first shot: samples as points, the model as lines.
Plot track_plot(const FitResult& result) {
    const auto& shot = result.chosen().fit.shots.front();
    const auto& piece = result.track.pieces[shot.piece];
    const double begin = piece.time_s[shot.first];
    Plot plot{.title = "A part of the track", .note = "points: measured, lines: model"};
    plot.x = {.label = "time, s", .low = 0, .high = piece.time_s[shot.last - 1] - begin};
    plot.y = {.label = "angle, rad"};
    constexpr std::size_t points = 60;
    for (const bool measured : {false, true})
        for (std::size_t link = 0; link < 2; ++link) {
            Curve curve{.label = measured ? "" : names[link], .hue = static_cast<int>(link)};
            if (measured) curve.mark = Mark::points;
            for (std::size_t i = 0; i < shot.size();
                 i += measured ? std::max<std::size_t>(shot.size() / points, 1) : 1) {
                const auto sample = shot.first + i;
                curve.x.push_back(piece.time_s[sample] - begin);
                curve.y.push_back(piece.angle[link][sample] - (measured ? 0 : shot.sums.residuals[i][link]));
            }
            plot.curves.push_back(std::move(curve));
        }
    return plot;
}

/// All residuals in order. Each stretch that a panel can resolve shows its largest one.
Plot residual_plot(const FitResult& result) {
    const auto& fit = result.chosen().fit;
    constexpr double points = 900, none = std::numeric_limits<double>::quiet_NaN();
    const auto bin = static_cast<std::size_t>(std::max(static_cast<double>(result.track.samples()) / points, 1.0));
    double end = 0;
    std::array curves{Curve{.label = names[0], .hue = 0}, Curve{.label = names[1], .hue = 1}};
    for (const auto& shot : fit.shots) {
        const auto* times = result.track.pieces[shot.piece].time_s.data() + shot.first;
        const auto& residuals = shot.sums.residuals;
        for (std::size_t link = 0; link < 2; ++link) {
            auto &x = curves[link].x, &y = curves[link].y;
            for (std::size_t from = 0; from < shot.size(); from += bin) {
                auto largest = from;
                for (auto i = from; i < std::min(from + bin, shot.size()); ++i)
                    if (std::isnan(residuals[largest][link]) ||
                        std::abs(residuals[i][link]) > std::abs(residuals[largest][link]))
                        largest = i;
                x.push_back(end + times[largest] - times[0]), y.push_back(mrad * residuals[largest][link]);
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

Plot hierarchy_plot(const FitResult& result) {
    Plot plot{.title = "Error against number of parameters", .needs_no_legend = true};
    plot.y = {.label = "rms on pieces left out, mrad", .logarithmic = true};
    double minimum = parameter_count, maximum = 0;
    for (std::size_t k = 0; k < result.hierarchy.candidates.size(); ++k) {
        const auto& candidate = result.hierarchy.candidates[k];
        const bool chosen = k == result.hierarchy.chosen;
        const auto count = static_cast<double>(candidate.fit.free_count());
        minimum = std::min(minimum, count), maximum = std::max(maximum, count);
        plot.curves.push_back({.label = fmt::format("{}{}", k + 1, chosen ? ", chosen" : ""),
                               .x = {count},
                               .y = {mrad * candidate.left_out_rms},
                               .mark = Mark::points,
                               .hue = chosen,
                               .quiet = !chosen});
    }
    plot.x = {.label = "parameters fitted", .low = minimum - 1, .high = maximum + 1, .every = 1};
    return plot;
}

Plot horizon_plot(const std::optional<Horizon>& horizon) {
    Plot plot{.title = "Predictions", .note = "not measured"};
    plot.x = {.label = "time predicted, s", .low = 0, .high = 1};
    plot.y = {.label = "maximum error to date, rad", .logarithmic = true};
    if (!horizon) return plot;
    for (const bool left : {true, false})
        for (const auto& p : horizon->predictions) {
            if (p.left_s.has_value() != left) continue;
            auto& curve = plot.curves.emplace_back(Curve{.x = p.time_s, .hue = left, .quiet = !left});
            double largest = 0;
            for (const double error : p.error) curve.y.push_back(largest = std::max(largest, error));
            plot.x.high = std::max(*plot.x.high, p.time_s.back());
        }
    plot.note = fmt::format("{} of {} exceeded it, in colour", horizon->left(), horizon->predictions.size());
    plot.rules.push_back({Rule::Orientation::horizontal, horizon->limit, fmt::format("{:.2g} rad", horizon->limit)});
    if (const auto& median = horizon->median_s)
        plot.rules.push_back({Rule::Orientation::vertical, *median, fmt::format("median {:.1f} s", *median)});
    return plot;
}

}  // namespace

Figure fit_page(const FitResult& result, const std::string& name) {
    const auto& candidate = result.chosen();
    const auto& track = result.track;
    std::vector<std::string> models, numbers;
    for (const auto& other : result.hierarchy.candidates)
        models.push_back(fmt::format("{} {}", models.size() + 1, other.name));
    for (const auto parameter : candidate.fit.model.list())
        numbers.push_back(parameter_text(candidate.fit, result.uncertainty, parameter));
    return {
        .title = fmt::format("{}: {}", name, candidate.name),
        .subtitle =
            fmt::format("{} samples in {:.1f} s of {} piece{}; {} parameters", track.samples(), track.duration(),
                        track.pieces.size(), track.pieces.size() == 1 ? "" : "s", candidate.fit.free_count()),
        .panels = {track_plot(result), residual_plot(result), hierarchy_plot(result), horizon_plot(result.horizon)},
        .columns = 2,
        .captions = {fmt::format("Models: {}.", fmt::join(models, "; ")), fmt::format("{}.", fmt::join(numbers, ",  ")),
                     residual_sentence(result) + " " + horizon_sentence(result)}};
}

}  // namespace doppel
