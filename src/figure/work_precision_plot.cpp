#include "figure/work_precision.hpp"
#include "scene/captions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

namespace doppel {
namespace {

constexpr double rounding = 0x1p-53;

/// Methods of a family, one below the other here, share a hue; the second of two is dashed.
struct CurveStyle {
    int hue = 0;
    bool dashed = false;
};
CurveStyle style_of(std::string_view method) {
    constexpr std::array<std::string_view, 8> first{"taylor", "dop853", "gauss6", "rattle6",
                                                    "rk4",    "adams",  "euler",  "midpoint"},
        second{"", "dopri5", "gauss4", "rattle", "", "", "semi-implicit-euler", ""};
    for (const auto* names : {&first, &second})
        if (const auto at = std::ranges::find(*names, method) - names->begin(); at < std::ssize(*names))
            return {static_cast<int>(at), names == &second};
    return {};
}

ErrorRange range_of(const WorkDiagram& diagram) {
    constexpr double at_floor = 10;
    return {std::isnan(diagram.floor) ? rounding : at_floor * diagram.floor, max_error_shown};
}

/// An error may be exactly 0, which a logarithmic axis cannot show.
double shown(double error) {
    return std::max(error, rounding / 4);
}

/// Adds the Pareto front of the studies.
void add_front(std::span<const StepStudy> studies, const WorkDiagram& diagram, Curve& curve) {
    for (const auto& point : pareto_front(studies, diagram.cost, range_of(diagram)))
        add_point(curve, point.cost(diagram.cost), shown(point.error));
}

bool is_named(const StepStudy& study, const WorkDiagram& diagram) {
    return std::ranges::count(diagram.named, study.solver.method) > 0;
}

/// In colour with its name, or pale.
Curve curve_of(const StepStudy& study, const WorkDiagram& diagram) {
    const auto& method = study.solver.method;
    Curve curve{.label = method};
    if (is_named(study, diagram)) {
        const auto style = style_of(method);
        curve.hue = style.hue;
        curve.dashed = style.dashed;
    } else {
        curve.quiet = true;
        if (diagram.names == NamedCurves::best) curve.label = "", curve.background = Background::line;
    }
    add_front({&study, 1}, diagram, curve);
    return curve;
}

/// The range of measured times of a curve, as pale bars.
Curve spread_bars(const StepStudy& study, const WorkDiagram& diagram, int hue) {
    Curve bars{.hue = hue, .background = Background::line};
    constexpr double shows = 0.05, maximum = 0.9;
    for (const auto& point : pareto_front({&study, 1}, Cost::time, range_of(diagram))) {
        const double spread = std::min(point.spread, maximum);
        if (spread < shows) continue;
        add_point(bars, point.cpu_s * (1 - spread), shown(point.error));
        add_point(bars, point.cpu_s * (1 + spread), shown(point.error));
        add_point(bars, NAN, NAN);
    }
    return bars;
}

/// The result of the published study.
void add_kao_point(const WorkDiagram& diagram, Plot& plot) {
    for (const auto& study : diagram.studies) {
        if (!study.solver.is_kao_study()) continue;
        for (const auto& outcome : study.outcomes)
            if (outcome.is_kao_study())
                plot.curves.push_back({.label = "the study: Euler, 30 kHz",
                                       .x = {outcome.cost(diagram.cost)},
                                       .y = {outcome.error},
                                       .mark = Mark::points,
                                       .quiet = true});
    }
}

/// The limits of the axes: from the largest useful error down to the error floors, if errors come near them.
void fit(const WorkDiagram& diagram, Plot& plot) {
    constexpr double of_use = 0.03, near = 100;
    double minimum = max_error_shown, cheapest = std::numeric_limits<double>::infinity();
    for (const auto& curve : plot.curves)
        for (std::size_t i = 0; i < curve.x.size(); ++i) {
            minimum = std::fmin(minimum, curve.y[i]);
            if (curve.y[i] < of_use) cheapest = std::fmin(cheapest, curve.x[i]);
        }
    if (std::isfinite(cheapest)) plot.x.low = 0.5 * cheapest;
    plot.y.low = minimum / 4;
    plot.y.high = 20 * max_error_shown;  // leaves space for the study's label
    if (!(minimum < near * diagram.floor)) return;
    const double grown = diagram.floor / rounding;
    const auto times = grown < 1e5 ? fmt::format("{:.0f}", grown) : scientific(grown);
    plot.rules.push_back({.at = diagram.floor, .label = "round-off × " + times});
    plot.y.low = std::fmin(minimum, diagram.floor) / 20;
    constexpr double in_sight = 1e-12;
    if (diagram.floor > in_sight) return;
    plot.rules.push_back({.at = rounding, .label = "rounding"});
    plot.y.low = rounding / 20;
}

}  // namespace

Plot work_plot(const WorkDiagram& diagram) {
    Plot plot;
    plot.title = diagram.problem.title;
    plot.needs_no_legend = true;
    plot.x = {.label = diagram.cost == Cost::time ? "CPU time, s" : "evaluations of the right-hand side",
              .logarithmic = true};
    plot.y = {.label = diagram.problem.has_angles() ? "angle error at the end, rad"
                                                    : "error of place at the end, of the size",
              .logarithmic = true};
    add_front(diagram.front, diagram, plot.curves.emplace_back(Curve{.background = Background::band}));
    add_kao_point(diagram, plot);
    for (const bool named : {false, true})
        for (const auto* study : best_models(diagram.studies, diagram.cost)) {
            if (is_named(*study, diagram) != named) continue;
            plot.curves.push_back(curve_of(*study, diagram));
            if (named && diagram.cost == Cost::time)
                plot.curves.push_back(spread_bars(*study, diagram, plot.curves.back().hue));
        }
    fit(diagram, plot);
    return plot;
}

}  // namespace doppel
