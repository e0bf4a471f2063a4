#include "fit/report.hpp"

#include "base/text.hpp"

#include <Eigen/Cholesky>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

namespace doppel {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

std::string pair_text(double first, double second) {
    return fmt::format("[{:.10g}, {:.10g}]", first, second);
}

bool any(const std::array<double, 2>& values) {
    return values[0] != 0 || values[1] != 0;
}

/// What the start of the first segment is known to, rad.
std::array<double, 2> start_errors(const Fit& fit, const Uncertainty& uncertainty) {
    // by itself; what it shares with the parameters would add little
    const Eigen::Matrix4d covariance =
        fit.sums.front().starts.ldlt().solve(Eigen::Matrix4d::Identity()) * std::pow(uncertainty.inflation, 2);
    return {std::sqrt(std::max(covariance(0, 0), 0.0)), std::sqrt(std::max(covariance(1, 1), 0.0))};
}

std::string source_words(const Track& track) {
    std::vector<std::string> names;
    for (const auto& piece : track.pieces)
        if (names.empty() || names.back() != piece.name) names.push_back(piece.name);
    names[0] = on_one_line(std::filesystem::path(names[0]).filename().string());
    return names.size() == 1 ? names[0] : fmt::format("{} and {} more", names[0], names.size() - 1);
}

Json ladder_json(const FitResult& result) {
    Json all = Json::array();
    for (const auto& rung : result.ladder.rungs)
        all.push_back({{"model", rung.name},
                       {"parameters", rung.parameters},
                       {"rms_rad", rung.fit.rms},
                       {"left_out_rms_rad", rung.left_out_rms},
                       {"passes", rung.fit.passes},
                       {"step_s", rung.fit.rules.step_s}});
    return all;
}

Json model_json(const FittedModel& rung, const Uncertainty& uncertainty) {
    Json ratios = Json::object();
    for (const auto parameter : rung.model.fitted) {
        const bool held = std::count(rung.fit.at_bound.begin(), rung.fit.at_bound.end(), parameter) > 0;
        Json value = {{"value", rung.fit.parameters[index_of(parameter)]},
                      {"standard_error", uncertainty.standard_error(parameter)}};
        if (held) value["at_bound"] = true;
        ratios[std::string(words_of(parameter).key)] = value;
    }
    Json names = Json::array(), correlations = Json::array();
    for (std::size_t j = 0; j < uncertainty.parameters.size(); ++j) {
        names.push_back(words_of(uncertainty.parameters[j]).key);
        Json row = Json::array();
        for (std::size_t k = 0; k < uncertainty.parameters.size(); ++k) row.push_back(uncertainty.correlation(j, k));
        correlations.push_back(row);
    }
    return {{"name", rung.name},
            {"ratios_to_B", ratios},
            {"correlations", {{"parameters", names}, {"matrix", correlations}}},
            {"rms_rad", rung.fit.rms},
            {"left_out_rms_rad", rung.left_out_rms}};
}

/// By which presets state the drag of that model.
const char* drag_key(const ModelSpec& model) {
    return model.drag == Drag::own ? "arm_drag_quadratic_N_m_s2" : "air_drag_quadratic_N_m_s2";
}

/// Of rates within which dry friction turns over, °/s.
double dry_width(const ModelSpec& model) {
    return model.dry == DryLaw::sharp ? 0 : coulomb_width_deg_per_s;
}

Json pendulum_json(const FittedPendulum& p, const ModelSpec& model) {
    return {{"convention", p.rule},           {"gravity_m_per_s2", p.gravity},
            {"B_kg_m2", p.second_inertia},    {"mass_kg", p.mass},
            {"length_m", p.length},           {"center_m", p.center},
            {"inertia_kg_m2", p.inertia},     {"joint_viscous_N_m_s", p.viscous},
            {"joint_coulomb_N_m", p.coulomb}, {"joint_coulomb_width_deg_per_s", dry_width(model)},
            {drag_key(model), p.quadratic}};
}

/// Where each segment of the chosen model's fit begins.
Json starts_json(const FitResult& result) {
    Json all = Json::array();
    const auto& segments = result.ladder.division.segments;
    for (std::size_t k = 0; k < segments.size(); ++k) {
        const auto& y = result.chosen().fit.starts[k];
        all.push_back({{"piece", segments[k].piece},
                       {"time_s", result.track.pieces[segments[k].piece].time_s[segments[k].first]},
                       {"angle_rad", {y[0], y[1]}},
                       {"rate_rad_per_s", {y[2], y[3]}}});
    }
    return all;
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
    const auto add = [&](const char* key, const std::array<double, 2>& values) {
        text += fmt::format("{} = {}\n", key, pair_text(values[0], values[1]));
    };
    add("mass_kg", p.mass);
    add("length_m", p.length);
    if (!rung.model.point_masses) {
        add("center_m", p.center);
        add("inertia_kg_m2", p.inertia);
    }
    if (any(p.viscous)) add("joint_viscous_N_m_s", p.viscous);
    if (any(p.coulomb)) {
        if (rung.model.dry == DryLaw::smooth)
            text += fmt::format("# fitted as turning over within {} deg/s; here it does so at once\n",
                                dry_width(rung.model));
        add("joint_coulomb_N_m", p.coulomb);
    }
    if (any(p.quadratic)) add(drag_key(rung.model), p.quadratic);
    const auto& start = rung.fit.starts.front();
    const auto errors = start_errors(rung.fit, result.uncertainty);
    text += fmt::format("gravity_m_per_s2 = {}\n", p.gravity);
    add("angle_deg", {degrees * start[0], degrees * start[1]});
    add("omega_deg_per_s", {degrees * start[2], degrees * start[3]});
    text += "accuracy = 1e-6\n\n[b]  # released one standard error further\n";
    add("angle_deg", {degrees * (start[0] + errors[0]), degrees * (start[1] + errors[1])});
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
                 {"starts", starts_json(result)},
                 {"ladder", ladder_json(result)},
                 {"residuals",
                  {{"like_noise", result.uncertainty.is_white},
                   {"neighbour_correlation", result.uncertainty.neighbour},
                   {"memory_s", result.uncertainty.memory_s},
                   {"inflation", result.uncertainty.inflation},
                   {"sentence", residual_sentence(result)}}},
                 {"horizon", horizon_json(result)},
                 {"pendulum", pendulum_json(result.pendulum, result.chosen().model)}};
    if (result.period)
        json["track"]["period"] = {{"seconds", result.period->seconds},
                                   {"standard_error", result.period->standard_error}};
    return json;
}

std::vector<std::string> residual_columns() {
    return {"piece", "time_s", "theta1_rad", "theta2_rad", "residual1_rad", "residual2_rad"};
}

void write_residuals(const FitResult& result, Csv& table) {
    const auto& segments = result.ladder.division.segments;
    const auto& residuals = result.chosen().fit.residuals;
    std::size_t next = 0;
    for (std::size_t k = 0; k < segments.size(); ++k) {
        const auto& piece = result.track.pieces[segments[k].piece];
        for (std::size_t i = segments[k].first; i < segments[k].last; ++i) {
            table.add(static_cast<long>(segments[k].piece));
            table.add(piece.time_s[i]);
            table.add(piece.angle[0][i]);
            table.add(piece.angle[1][i]);
            for (std::size_t arm = 0; arm < 2; ++arm) {
                std::optional<double> residual;
                if (next < residuals.size() && residuals[next].segment == k && residuals[next].sample == i &&
                    residuals[next].arm == arm)
                    residual = residuals[next++].residual;
                table.add(residual);
            }
            table.end_row();
        }
    }
}

}  // namespace doppel
