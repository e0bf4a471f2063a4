#include "fit/report.hpp"

#include "base/text.hpp"
#include "numeric/portable_math.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

namespace doppel {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

/// What the start of the first segment is known to, rad.
std::array<double, 2> start_errors(const Fit& fit, const Uncertainty& uncertainty) {
    // by itself; what it shares with the parameters would add little
    const Eigen::Matrix4d covariance =
        inverse_of(fit.sums.front().matrix.topLeftCorner(4, 4)) * std::pow(uncertainty.inflation, 2);
    return {std::sqrt(std::max(covariance(0, 0), 0.0)), std::sqrt(std::max(covariance(1, 1), 0.0))};
}

std::string source_words(const Track& track) {
    std::vector<std::string> names;
    for (const auto& piece : track.pieces)
        if (names.empty() || names.back() != piece.name) names.push_back(piece.name);
    names[0] = on_one_line(std::filesystem::path(names[0]).filename().string());
    return names.size() == 1 ? names[0] : fmt::format("{} and {} more", names[0], names.size() - 1);
}

Json model_json(const FittedModel& rung, const Uncertainty& uncertainty) {
    Json ratios = Json::object();
    for (const auto parameter : rung.fit.model.fitted) {
        Json value = {{"value", rung.fit.of(parameter)}, {"standard_error", uncertainty.standard_error(parameter)}};
        if (rung.fit.is_at_bound(parameter)) value["at_bound"] = true;
        ratios[std::string(words_of(parameter).key)] = value;
    }
    Json names = Json::array(), correlations = Json::array();
    const auto& covariance = uncertainty.covariance;
    for (std::size_t j = 0; j < uncertainty.parameters.size(); ++j) {
        names.push_back(words_of(uncertainty.parameters[j]).key);
        auto& row = correlations.emplace_back(Json::array());
        for (std::size_t k = 0; k < uncertainty.parameters.size(); ++k) {
            const double product = uncertainty.standard_error(j) * uncertainty.standard_error(k);
            row.push_back(product > 0 ? covariance(Eigen::Index(j), Eigen::Index(k)) / product : 0);
        }
    }
    return {{"name", rung.name},
            {"ratios_to_B", ratios},
            {"correlations", {{"parameters", names}, {"matrix", correlations}}},
            {"rms_rad", rung.fit.rms},
            {"left_out_rms_rad", rung.left_out_rms}};
}

/// The lists of friction as presets name them.
std::vector<std::pair<std::string, std::vector<double>>> friction_of(const FittedPendulum& pendulum) {
    const auto& friction = pendulum.body.friction;
    const bool own = friction.air_quadratic.empty();
    return {{"joint_viscous_N_m_s", friction.viscous},
            {"joint_coulomb_N_m", friction.coulomb},
            {own ? "arm_drag_quadratic_N_m_s2" : "air_drag_quadratic_N_m_s2",
             own ? friction.arm_quadratic : friction.air_quadratic}};
}

Json pendulum_json(const FittedPendulum& p) {
    const auto& chain = p.body.chain;
    Json json = {{"convention", p.rule},           {"gravity_m_per_s2", chain.gravity}, {"B_kg_m2", p.second_inertia},
                 {"mass_kg", chain.mass},          {"length_m", chain.length},          {"center_m", p.body.center},
                 {"inertia_kg_m2", p.body.inertia}};
    for (const auto& [key, values] : friction_of(p)) json[key] = values;
    return json;
}

Json horizon_json(const FitResult& result) {
    if (!result.horizon) return {{"sentence", horizon_sentence(result)}};
    const auto& horizon = *result.horizon;
    Json predictions = Json::array();
    const auto seconds = [](const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); };
    for (const auto& p : horizon.predictions)
        predictions.push_back({{"start_s", p.start_s},
                               {"data_s", p.data_s},
                               {"within_s", p.within_s},
                               {"left_s", seconds(p.left_s)},
                               {"start_alone_s", seconds(p.start_alone_s)},
                               {"parameters_alone_s", seconds(p.parameters_alone_s)}});
    return {
        {"limit_rad", horizon.limit},
        {"median_s", seconds(horizon.median_s)},
        {"longest_s", horizon.longest_s},
        {"left_by", {{"model", horizon.left_by[0]}, {"start", horizon.left_by[1]}, {"parameters", horizon.left_by[2]}}},
        {"sentence", horizon_sentence(result)},
        {"predictions", predictions}};
}

}  // namespace

std::string residual_sentence(const FitResult& result) {
    const auto& u = result.uncertainty;
    const double rms = result.chosen().fit.rms;
    if (u.is_white)
        return fmt::format(
            "Residuals look like noise of {:.2g} rad: neighbours are not correlated ({:.2f} and {:.2f}).", rms,
            u.neighbour[0], u.neighbour[1]);
    const double noise = std::max(result.track.noise[0], result.track.noise[1]);
    const auto why = rms > 2 * noise ? fmt::format(
                                           "from sample to sample the angles scatter by {:.1g} rad only, so it is "
                                           "the model that errs",
                                           noise)
                                     : std::string("the measurement's own noise may be so");
    return fmt::format(
        "Residuals of {:.2g} rad are not noise: they keep their sign for some {:.2g} s; {}. Standard errors allow "
        "for it ({:.2g} times those of white noise).",
        rms, std::max(u.memory_s[0], u.memory_s[1]), why, u.inflation);
}

std::string horizon_sentence(const FitResult& result) {
    if (!result.horizon)
        return result.track.start_s.empty()
                   ? "No horizon: it is not known when each piece began; --every SECONDS tells."
                   : "No horizon: stretches are too short to predict from.";
    const auto& h = *result.horizon;
    const auto left = h.left_by[0] + h.left_by[1] + h.left_by[2];
    const auto span = [&](auto member) {
        const auto [least, most] =
            std::minmax_element(h.predictions.begin(), h.predictions.end(),
                                [&](const Prediction& a, const Prediction& b) { return a.*member < b.*member; });
        const auto from = fmt::format("{:.1f}", (*least).*member), to = fmt::format("{:.1f}", (*most).*member);
        return from == to ? from : from + " to " + to;
    };
    auto sentence =
        fmt::format("Predictions from {} s of data stay within {:.2g} rad ", span(&Prediction::data_s), h.limit);
    if (left == 0) {
        // of those seen for the median time or longer: (1 − p)ⁿ = 5 %
        std::vector<double> seen;
        for (const auto& p : h.predictions) seen.push_back(p.within_s);
        std::sort(seen.begin(), seen.end());
        const auto count = seen.size() - seen.size() / 2;
        return sentence + fmt::format(
                              "as long as the track shows them, {} s; of the {} seen for {:.1f} s or more none "
                              "left by then: at 95 % confidence at most {:.0f} % would.",
                              span(&Prediction::within_s), count, seen[seen.size() / 2],
                              100 * (1 - portable_pow(0.05, 1 / static_cast<double>(count))));
    }
    sentence += h.median_s ? fmt::format("for {:.1f} s (median)", *h.median_s)
                           : fmt::format("for longer than the track shows, {:.1f} s", h.longest_s);
    constexpr std::array<const char*, 3> names{"the model", "the start", "the parameters"};
    std::string because;
    for (std::size_t k = 0; k < names.size(); ++k)
        if (h.left_by[k] > 0) because += fmt::format("{}{} {}", because.empty() ? "" : ", ", names[k], h.left_by[k]);
    return sentence + fmt::format("; of {} predictions {} left, limited by: {}.", h.predictions.size(), left, because);
}

std::string parameter_words_of(const Fit& fit, const Uncertainty& uncertainty, FitParameter parameter) {
    const auto& words = words_of(parameter);
    const double value = fit.parameters[index_of(parameter)];
    const auto unit = words.unit.empty() ? std::string() : fmt::format(" {}", words.unit);
    const double error = uncertainty.standard_error(parameter);
    const int decimals = error > 0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, 12) : 6;
    return fmt::format("{} = {:.{}f} ± {:.{}f}{}", words.symbol, value, decimals, error, decimals, unit);
}

std::string fitted_preset(const FitResult& result, const std::string& name) {
    const auto& rung = result.chosen();
    const auto& p = result.pendulum;
    std::string text = fmt::format(
        "# Fitted by doppel fit to {}: {}.\n# It errs by {:.2g} rad on pieces left out. Errors, ladder and horizon are "
        "in "
        "{}.fit.json.\n",
        source_words(result.track), rung.name, rung.left_out_rms, name);
    text += fmt::format("# Angles tell ratios alone: gravity and the second mass are given, {}.\n", p.rule);
    text += fmt::format("title = {}\n\n[scene]\nduration_s = 30\n\n[system]\n", toml_text(name + ", as measured"));
    const auto add = [&](const std::string& key, const auto& values) {
        text += fmt::format("{} = [{:.10g}, {:.10g}]\n", key, values[0], values[1]);
    };
    add("mass_kg", p.body.chain.mass);
    add("length_m", p.body.chain.length);
    if (!rung.fit.model.point_masses) {
        add("center_m", p.body.center);
        add("inertia_kg_m2", p.body.inertia);
    }
    for (const auto& [key, values] : friction_of(p))
        if (values[0] != 0 || values[1] != 0) add(key, values);
    const auto& start = rung.fit.starts.front();
    const auto errors = start_errors(rung.fit, result.uncertainty);
    text += fmt::format("gravity_m_per_s2 = {}\n", p.body.chain.gravity);
    add("angle_deg", std::array{degrees * start[0], degrees * start[1]});
    add("omega_deg_per_s", std::array{degrees * start[2], degrees * start[3]});
    text += "accuracy = 1e-6\n\n[b]  # released one standard error further\n";
    add("angle_deg", std::array{degrees * (start[0] + errors[0]), degrees * (start[1] + errors[1])});
    return text;
}

Json fit_json(const FitResult& result) {
    const auto& track = result.track;
    std::vector<std::string> files;
    std::error_code ignored;  // of a folder that is gone: the path is empty
    for (const auto& piece : track.pieces) {
        const auto file = on_one_line(std::filesystem::proximate(piece.name, ignored).string());
        if (files.empty() || files.back() != file) files.push_back(file);
    }
    Json ladder = Json::array(), starts = Json::array();
    for (const auto& rung : result.ladder.rungs)
        ladder.push_back({{"model", rung.name},
                          {"parameters", rung.fit.free_count()},
                          {"rms_rad", rung.fit.rms},
                          {"left_out_rms_rad", rung.left_out_rms},
                          {"passes", rung.fit.passes},
                          {"step_s", rung.fit.rules.step_s}});
    for (std::size_t k = 0; k < result.chosen().fit.segments.size(); ++k) {
        const auto& segment = result.chosen().fit.segments[k];
        const auto& y = result.chosen().fit.starts[k];
        starts.push_back({{"piece", segment.piece},
                          {"time_s", track.pieces[segment.piece].time_s[segment.first]},
                          {"angle_rad", {y[0], y[1]}},
                          {"rate_rad_per_s", {y[2], y[3]}}});
    }
    Json json = {{"doppel", program_json()},
                 {"track",
                  {{"files", files},
                   {"pieces", track.pieces.size()},
                   {"samples", track.samples()},
                   {"seconds", track.duration()},
                   {"noise_rad", track.noise},
                   {"left_out_angles", track.outliers()},
                   {"notes", track.notes}}},
                 {"model", model_json(result.chosen(), result.uncertainty)},
                 {"starts", starts},
                 {"ladder", ladder},
                 {"residuals",
                  {{"like_noise", result.uncertainty.is_white},
                   {"neighbour_correlation", result.uncertainty.neighbour},
                   {"memory_s", result.uncertainty.memory_s},
                   {"inflation", result.uncertainty.inflation},
                   {"sentence", residual_sentence(result)}}},
                 {"horizon", horizon_json(result)},
                 {"pendulum", pendulum_json(result.pendulum)}};
    if (result.period)
        json["track"]["period"] = {{"seconds", result.period->seconds},
                                   {"standard_error", result.period->standard_error}};
    return json;
}

void write_residuals(const FitResult& result, const FilePlace& place) {
    Csv table(place, {"piece", "time_s", "theta1_rad", "theta2_rad", "residual1_rad", "residual2_rad"});
    const auto& segments = result.chosen().fit.segments;
    for (std::size_t k = 0; k < segments.size(); ++k) {
        const auto& piece = result.track.pieces[segments[k].piece];
        for (std::size_t i = segments[k].first; i < segments[k].last; ++i) {
            table.add(static_cast<long>(segments[k].piece));
            table.add(piece.time_s[i]);
            table.add(piece.angle[0][i]);
            table.add(piece.angle[1][i]);
            for (const double residual : result.chosen().fit.sums[k].residuals[i - segments[k].first])
                table.add(std::isnan(residual) ? std::nullopt : std::optional(residual));
            table.end_row();
        }
    }
    table.finish();
}

}  // namespace doppel
