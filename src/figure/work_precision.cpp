#include "figure/work_precision.hpp"

#include "analysis/exponent.hpp"
#include "base/error.hpp"
#include "integrate/methods.hpp"
#include "output/written.hpp"
#include "scene/captions.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <set>
#include <string_view>
#include <tuple>

namespace doppel {
namespace {

/// A standard problem: unit masses and lengths, released at rest.
struct StandardProblem {
    std::vector<int> angle_deg;
    int seconds;
};

constexpr std::array<std::string_view, 4> standard_problem_names{"P1", "P2", "P3", "P4"};
const std::array<StandardProblem, 4> all_standard{{{{90, 90}, 10}, {{30, 0}, 60}, {{150, 90}, 5}, {{120, 0, 0}, 5}}};

std::string title_words(const std::string& name, const SideSpec& side, const Rational& duration) {
    const auto seconds = fmt::format("{:.6g} s", duration.value());
    if (!side.particles.empty()) return fmt::format("{} · {}", name, seconds);
    return fmt::format("{} · {}{}, {}", name, slashed(side.angle_deg, "°"), side.is_mechanism() ? " and more" : "",
                       seconds);
}

/// A chain or mechanism as a problem. Throws Error (exit 2) if the system is invalid.
WorkProblem make_problem(const std::string& name, SideSpec spec, const Rational& duration) {
    if (spec.physical.has_coulomb())
        throw bad_input("{}: methods are compared on smooth motions; joints with joint_coulomb_N_m stick", name);
    const bool is_mechanism = spec.is_mechanism();
    spec.model = is_mechanism ? ModelChoice::mechanism : ModelChoice::automatic;
    spec.integrator = "taylor";
    spec.precision = Precision::in_double;
    spec.stabilise = Stabilise::none;
    const auto side = make_side(spec, {1, 1});
    WorkProblem problem{.name = name, .title = title_words(name, spec, duration)};
    problem.motion = {.chain = side.motion.chain,
                      .physical = side.motion.physical,
                      .model = is_mechanism ? Model::mechanism : Model::angles,
                      .sample_interval = duration,
                      .follows_turns = false};
    if (is_mechanism || !side.motion.physical) problem.motion.parts = assembly_of(spec);
    problem.conserves_energy = side.has_energy_error;
    problem.energy_unit = side.energy_unit;
    problem.size = side.reach;
    const double gravity = std::abs(side.gravity);
    if (side.motion.chain)
        problem.natural_time = NaturalUnits(physical(side.motion.chain->cast<double>())).time;
    else
        problem.natural_time = gravity > 0 ? std::sqrt(side.reach / gravity) : 1;
    return problem;
}

SideSpec side_of(const StandardProblem& standard) {
    SideSpec side;
    side.set_links(standard.angle_deg.size());  // unit masses and lengths, at rest
    side.angle_deg.assign(standard.angle_deg.begin(), standard.angle_deg.end());
    return side;
}

/// The system in the words of a subtitle.
std::string problem_words(const WorkProblem& problem, const SideSpec& side) {
    constexpr std::string_view computed = "double precision, one core";
    if (!problem.has_angles()) return fmt::format("side a of {}, a mechanism; {}", problem.name, computed);
    auto shown = side;
    shown.mass_kg = problem.motion.chain->mass;  // links with mass have none of their own in the preset
    return fmt::format("side a of {}: {}{}; {}", problem.name, motion_words(shown),
                       side.is_mechanism() ? ", and more" : "", computed);
}

/// The standard problems of these names, listed in `table`'s key `problems`. Throws Error (exit 2).
std::vector<WorkProblem> standard_problems(const std::vector<std::string>& names, const TomlReader& table) {
    if (names.empty())
        throw table.error("problems", "must name at least one of {}", fmt::join(standard_problem_names, ", "));
    check_distinct(table, "problems", names);
    std::vector<WorkProblem> problems;
    for (const auto& name : names) {
        const auto number = std::ranges::find(standard_problem_names, name) - standard_problem_names.begin();
        const auto& standard = all_standard.at(static_cast<std::size_t>(number));
        problems.push_back(make_problem(name, side_of(standard), {standard.seconds, 1}));
    }
    return problems;
}

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

constexpr double shown_spread = 0.05;  // of measured times; less is hidden by the curve

/// The range of measured times of a curve, as pale bars.
Curve spread_bars(const StepStudy& study, const WorkDiagram& diagram, int hue) {
    Curve bars{.hue = hue, .background = Background::line};
    constexpr double maximum = 0.9;
    for (const auto& point : pareto_front({&study, 1}, Cost::time, range_of(diagram))) {
        const double spread = std::min(point.spread, maximum);
        if (spread < shown_spread) continue;
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

/// The film preset of that name or path, given by the table's key `scene`. Throws Error (exit 2).
Preset film_named(const std::string& name, const TomlReader& table) {
    const auto source = [&] {
        try {
            return find_preset(name);
        } catch (const Error& error) {
            throw table.error("scene", "cannot be taken: {}", error.what());
        }
    }();
    table.require_drawable("scene", source.name);
    if (is_figure(source)) throw table.error("scene", "must name a film; \"{}\" is a figure", name);
    return read_preset(source);
}

/// Error against cost of every method on a few problems. Trials: the reference solution of each problem, then all
/// step-size studies, repeated in turn, so that other load on the machine affects all equally.
class WorkPrecision final : public Experiment, public WorkComparison {
public:
    static constexpr std::string_view table_key = "work_precision";
    WorkPrecision()
        : problem_names_(standard_problem_names.begin(), standard_problem_names.end()),
          model_names_(names_of<Model>.begin(), names_of<Model>.end()),
          methods_(names_of_methods().begin(), names_of_methods().end()) {}
    explicit WorkPrecision(FigureReader& reader) : WorkPrecision() {
        further_fields(reader.chart);
        auto table = reader.settings(*this);
        if (reader.only_keys) return;
        settings_ = settings_text(*this);
        if (scene_) {
            problems.push_back(make_problem(film_.name, film_.a, film_.duration_s));
            subtitle_ = problem_words(problems.back(), film_.a);
            film_.b = film_.a;
            // distinguishes two films of the same name
            settings_ += fmt::format("# {}\n", sha256_of_text(resolved_sides(film_)));
        } else {
            problems = standard_problems(problem_names_, table);
            subtitle_ = fmt::format("pendulums released at rest, {}; double precision, one core",
                                    links_words(side_of(all_standard[0])));  // all links are alike
        }
        references_ = std::make_unique<SharedReference[]>(problems.size());
        unit_ = "step-size studies";
        const auto* error = has_angles() ? "angle_error_rad" : "place_error";
        columns_ = {"problem",      "model",          "method",      "setting",     error,
                    "energy_error", "length_error_m", "cpu_seconds", "evaluations", "steps"};
        check_distinct(table, "methods", methods_);
        std::set<std::string_view> used;  // methods and models
        for (std::size_t p = 0; p < problems.size(); ++p)
            for (const auto& model_name : model_names_)
                for (const auto model = value_named<Model>(model_name); const auto& name : methods_of(model, methods_))
                    if (const Solver solver{model, name}; solver.supports(problems[p])) {
                        studies_.push_back({p, solver});
                        used.insert({name_of(model), find_method(name)->name});
                    }
        const auto& problem = problems[0];
        const auto hint = problem.is_plain_chain()
                              ? ""
                              : fmt::format("; {} supports \"{}\"", problem.name, name_of(problem.motion.model));
        // what is chosen must not be left out; all names are no choice
        for (const auto& [key, others, names, all] :
             {std::tuple{"methods", "models", &methods_, names_of_methods().size()},
              std::tuple{"models", "methods", &model_names_, names_of<Model>.size()}}) {
            if (names->empty()) throw table.error(key, "must name at least one");
            for (const auto& name : *names)
                if (names->size() < all && !used.contains(name))
                    throw table.error(key, "must each run {} with one of the {}; \"{}\" does not{}", problem.name,
                                      others, name, hint);
        }
    }

    void fields(KeyVisitor& visit) {
        visit({"scene", "a film, by name or path, whose side a is the problem"}, scene_);
        if (const auto* table = dynamic_cast<const TomlReader*>(&visit); table && scene_)
            film_ = film_named(*scene_, *table);
        const Condition standard{!scene_, "cannot be combined with \"scene\", which is a problem of its own"};
        const Condition of_scene{scene_.has_value(),
                                 "is only for the motion of a \"scene\"; the standard problems have their own"};
        visit({"problems", "the standard problems", "", {}, "", standard, "", standard_problem_names}, problem_names_);
        if (auto* writer = dynamic_cast<TomlWriter*>(&visit); writer && scene_)  // in quotes, whole or not
            writer->add("duration_s", toml_text(film_.duration_s.text()));
        else
            visit({"duration_s", "of the motion of `scene`", "s", positive, "the film's", of_scene}, film_.duration_s);
        visit({"repeats", "of a measurement of time", "", from_to(1, 99)}, repeats);
        visit({"most_evaluations", "of the right-hand side, in one run", "", from_to(100, 1e9)}, max_evaluations);
        visit({"least_error", "below which no finer setting is taken", "", positive}, min_error);
        visit({.key = "models", .help = "the equations", .names = names_of<Model>}, model_names_);
        visit({.key = "methods", .help = "names of methods", .absent = "all", .names = names_of_methods()}, methods_);
    }
    void further_fields(KeyVisitor& visit) {
        visit({"cost", "the cost axis"}, cost);
        visit({"names", "which curves are labelled: the five best, or all"}, names);
    }

    std::size_t trials() const override { return problems.size() + studies_.size() * rounds(); }
    bool measures_time() const override { return cost == Cost::time; }
    double merged_trials() const override { return static_cast<double>(rounds()); }
    double numbers_in_row() const override { return numbers_in<StepResult>; }
    double units(std::size_t trial) const override { return trial < problems.size() ? 0 : 1; }

    bool fits(std::size_t trial, std::span<const double> numbers) const override {
        if (trial < problems.size()) return numbers.size() == 1 && finite_or_none(numbers);  // its sensitivity
        if (numbers.empty() || numbers.size() % numbers_in<StepResult> != 0) return false;
        const auto is_count_or_none = [](double x) { return std::isnan(x) || is_count(x); };
        const auto outcomes = rows_of<StepResult>(numbers);
        return std::ranges::all_of(outcomes, [&](const StepResult& outcome) {
            return is_count_or_none(outcome.evaluations) && is_count_or_none(outcome.steps);
        });
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        const auto all = merged_studies(numbers);
        for (std::size_t p = 0; p < all.size(); ++p)
            for (const auto& study : all[p])
                for (const auto& outcome : study.outcomes) {
                    const auto add = [&](const auto& error) {
                        add_row(table, problems[p].name, name_of(study.solver.model), study.solver.method,
                                outcome.setting, error, outcome.energy_error, outcome.length_error, outcome.cpu_s,
                                outcome.evaluations, outcome.steps);
                    };
                    outcome.failed() ? add("failed") : add(outcome.error);
                }
    }

    std::optional<std::string> nothing_to_draw(std::span<const TrialNumbers> numbers) const override {
        for (const auto& studies : merged_studies(numbers))
            for (const auto& study : studies) {
                if (!pareto_front({&study, 1}, cost, {0, max_error_shown}).empty()) return std::nullopt;
                for (const auto& outcome : study.outcomes)
                    if (study.solver.is_kao_study() && outcome.is_kao_study() && !outcome.failed()) return std::nullopt;
            }
        return fmt::format(
            "no run of any method has an error below {:g}{}; raise work_precision.most_evaluations, or take a "
            "shorter motion",
            max_error_shown, has_angles() ? " rad" : " of the size");
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        const auto all = merged_studies(numbers);
        auto named = ranked(all, cost, accuracies);
        const bool are_all = named.size() <= best_shown;
        named.resize(std::min(named.size(), best_shown));
        for (std::size_t p = 0; p < problems.size(); ++p)
            figure.panels.push_back(
                work_plot({problems[p], 0x1p-53 * numbers[p][0], all[p], all[p], cost, named, names}));
        figure.captions.push_back(
            are_all ? "Each method in its best model; the pale band is the Pareto front."
                    : fmt::format("In colour the five best, by the mean rank at 10⁻³, 10⁻⁶, 10⁻⁹ and 10⁻¹²{}, each in "
                                  "its best model; the pale band is the Pareto front of all.",
                                  has_angles() ? " rad" : ""));
        figure.captions.push_back(
            error_words(std::ranges::any_of(figure.panels, [](const Plot& plot) { return !plot.rules.empty(); })));
        if (cost == Cost::time) figure.captions.push_back(timing_caption(all, repeats));
    }

    const Reference& reference(std::size_t problem, const std::atomic<bool>& stop) const override {
        auto& shared = references_[problem];
        const auto& motion = problems[problem].motion;
        std::call_once(shared.once, [&] { shared.reference = reference_end(motion, motion.sample_interval, stop); });
        return shared.reference;
    }

    Studies merged_studies(std::span<const TrialNumbers> numbers) const override {
        Studies all(problems.size());
        for (std::size_t i = 0; i < studies_.size(); ++i) {
            std::vector<std::vector<StepResult>> measured;
            for (std::size_t trial = problems.size() + i; trial < numbers.size(); trial += studies_.size())
                measured.push_back(rows_of<StepResult>(numbers[trial]));
            all[studies_[i].first].push_back(merged(studies_[i].second, measured));
        }
        return all;
    }

private:
    std::size_t rounds() const { return cost == Cost::time ? static_cast<std::size_t>(repeats) : 1; }
    bool has_angles() const { return problems.front().has_angles(); }

    TrialNumbers compute(std::size_t trial, const std::atomic<bool>& stop) const override {
        const std::size_t first = problems.size();
        if (trial < first) return {reference(trial, stop).sensitivity};
        const auto& [p, solver] = studies_[(trial - first) % studies_.size()];
        const bool is_first = trial - first < studies_.size();
        TrialNumbers numbers;
        for (const auto& outcome : run_step_study(problems[p], reference(p, stop), solver,
                                                  {max_evaluations, min_error, cost == Cost::time, is_first}, stop))
            append(numbers, outcome);
        return numbers;
    }

    std::string error_words(bool floors) const {
        return fmt::format("Errors: the worst {} against Taylor series in quad, {}, which agree.{}",
                           has_angles() ? "angle" : "place, as a part of the mechanism's size,",
                           problems.front().is_plain_chain() ? "in two formulations" : "at two tolerances",
                           floors ? " Dashed: round-off in double, and round-off × sensitivity." : "");
    }

    std::optional<std::string> scene_;
    Preset film_;  // of the key `scene`
    std::vector<std::string> problem_names_, model_names_, methods_;
    struct SharedReference {
        std::once_flag once;
        Reference reference;
    };
    std::unique_ptr<SharedReference[]> references_;        // for each problem
    std::vector<std::pair<std::size_t, Solver>> studies_;  // the problem and the solver of each study
};

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

std::string timing_caption(const WorkComparison::Studies& studies, int repeats) {
    if (repeats == 1) return "CPU time of one thread, warm, measured once.";
    const auto [typical, worst] = time_spread(studies);
    return fmt::format(
        "CPU time of one thread, warm, the median of {}; half of them lie within ± {:.1f} % of it, at worst within "
        "± {:.0f} %. Bars: where a coloured curve has more than ± {:g} %.",
        repeats, 100 * typical, 100 * worst, 100 * shown_spread);
}

const FigureKind work_precision_kind = kind_of<WorkPrecision>("work-precision");

}  // namespace doppel
