#include "figure/work_precision.hpp"

#include "base/error.hpp"
#include "integrate/methods.hpp"
#include "scene/captions.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>

namespace doppel {
namespace {

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

/// The numbers of a problem's reference trial.
struct ProblemRow {
    double sensitivity, disagreement;
};

/// Error against cost of every method on a few problems. Trials: the reference solution of each problem, then all
/// step-size studies, repeated in turn, so that other load on the machine affects all equally.
class WorkPrecision final : public Experiment, public WorkComparison {
public:
    static constexpr std::string_view table_key = "work_precision";
    WorkPrecision()
        : problem_names_(standard_problem_names().begin(), standard_problem_names().end()),
          model_names_(names_of<Model>.begin(), names_of<Model>.end()),
          methods_(names_of_methods().begin(), names_of_methods().end()) {}
    explicit WorkPrecision(FigureReader& reader) : WorkPrecision() {
        further_fields(reader.chart);
        auto table = reader.settings(*this);
        if (reader.only_keys) return;
        problems = scene_ ? problem_of(film_) : standard_problems(problem_names_, table);
        references_ = std::make_unique<SharedReference[]>(problems.all.size());
        settings_ = settings_text(*this) + problems.comment;
        subtitle_ = problems.subtitle;
        unit_ = "step-size studies";
        const auto* error = has_angles() ? "angle_error_rad" : "place_error";
        columns_ = {"problem",      "model",          "method",      "setting",     error,
                    "energy_error", "length_error_m", "cpu_seconds", "evaluations", "steps"};
        TomlWriter chart;
        further_fields(chart);
        chart_settings_ = chart.text();
        const auto solvers = solvers_of(table);
        for (std::size_t p = 0; p < problems.all.size(); ++p)
            for (const auto& solver : solvers)
                if (solver.supports(problems.all[p])) studies_.push_back({p, solver});
        if (studies_.empty())
            throw table.error("models", "must name one that is supported; {} supports \"{}\"", problems.all[0].name,
                              name_of(problems.all[0].motion.model));
    }

    void fields(KeyVisitor& visit) {
        visit({"scene", "a film, by name or path, whose side a is the problem"}, scene_);
        if (const auto* table = dynamic_cast<const TomlReader*>(&visit); table && scene_)
            film_ = film_named(*scene_, *table);
        const Condition standard{!scene_, "cannot be combined with \"scene\", which is a problem of its own"};
        const Condition of_scene{scene_.has_value(),
                                 "is only for the motion of a \"scene\"; the standard problems have their own"};
        visit({"problems", "the standard problems", "", {}, "", standard, "", standard_problem_names()},
              problem_names_);
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

    std::size_t trials() const override { return problems.all.size() + studies_.size() * rounds(); }
    bool measures_time() const override { return cost == Cost::time; }
    double units(std::size_t trial) const override { return trial < problems.all.size() ? 0 : 1; }

    bool fits(std::size_t trial, std::span<const double> numbers) const override {
        if (trial < problems.all.size()) return numbers.size() == numbers_in<ProblemRow> && finite_or_none(numbers);
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
                        add_row(table, problems.all[p].name, name_of(study.solver.model), study.solver.method,
                                outcome.setting, error, outcome.energy_error, outcome.length_error, outcome.cpu_s,
                                outcome.evaluations, outcome.steps);
                    };
                    outcome.failed() ? add("failed") : add(outcome.error);
                }
    }

    std::optional<std::string> nothing_to_draw(std::span<const TrialNumbers> numbers) const override {
        bool any = false;
        for (const auto& studies : merged_studies(numbers))
            for (const auto& study : studies) {
                if (!pareto_front({&study, 1}, cost, {0, max_error_shown}).empty()) return std::nullopt;
                for (const auto& outcome : study.outcomes) {
                    any |= std::isfinite(outcome.error);
                    if (study.solver.is_kao_study() && outcome.is_kao_study() && !outcome.failed()) return std::nullopt;
                }
            }
        if (!any) return "every run of every method failed; raise work_precision.most_evaluations for finer settings";
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
        for (std::size_t p = 0; p < problems.all.size(); ++p)
            figure.panels.push_back(work_plot({problems.all[p], 0x1p-53 * row_of<ProblemRow>(numbers[p]).sensitivity,
                                               all[p], all[p], cost, named, names}));
        figure.captions.push_back(
            are_all ? "Each method in its best model; the pale band is the Pareto front."
                    : fmt::format("In colour the five best, by the mean rank at 10⁻³, 10⁻⁶, 10⁻⁹ and 10⁻¹²{}, each in "
                                  "its best model; the pale band is the Pareto front of all.",
                                  has_angles() ? " rad" : ""));
        figure.captions.push_back(
            error_words(std::ranges::any_of(figure.panels, [](const Plot& plot) { return !plot.rules.empty(); })));
        if (cost == Cost::time) figure.captions.push_back(timing_caption(all, repeats));
    }

    Json findings(std::span<const TrialNumbers> numbers) const override {
        Json found;
        const auto all = merged_studies(numbers);
        for (std::size_t p = 0; p < problems.all.size(); ++p) {
            const auto& name = problems.all[p].name;
            const auto problem = row_of<ProblemRow>(numbers[p]);
            found[name + "_sensitivity"] = problem.sensitivity;
            found[name + "_reference_disagreement"] = problem.disagreement;
            for (const double accuracy : accuracies) {
                const auto best = cheapest(all[p], cost, accuracy);
                if (!best.study) continue;
                const auto key = fmt::format("{}_1e{}_", name, std::lround(std::log10(accuracy)));
                const auto& solver = best.study->solver;
                found[key + "best"] = fmt::format("{}, {}", solver.method, name_of(solver.model));
                found[key + "cost"] = best.cost;
            }
        }
        if (cost == Cost::evaluations) return found;
        const auto [typical, worst] = time_spread(all);
        found["spread_typical"] = typical;
        found["spread_worst"] = worst;
        return found;
    }

    const Reference& reference(std::size_t problem, const std::atomic<bool>& stop) const override {
        auto& shared = references_[problem];
        const auto& motion = problems.all[problem].motion;
        std::call_once(shared.once, [&] { shared.reference = reference_end(motion, motion.sample_interval, stop); });
        return shared.reference;
    }

    Studies merged_studies(std::span<const TrialNumbers> numbers) const override {
        Studies all(problems.all.size());
        for (std::size_t i = 0; i < studies_.size(); ++i) {
            std::vector<std::vector<StepResult>> measured;
            for (std::size_t trial = problems.all.size() + i; trial < numbers.size(); trial += studies_.size())
                measured.push_back(rows_of<StepResult>(numbers[trial]));
            all[studies_[i].first].push_back(merged(studies_[i].second, measured));
        }
        return all;
    }

private:
    std::size_t rounds() const { return cost == Cost::time ? static_cast<std::size_t>(repeats) : 1; }
    bool has_angles() const { return problems.all.front().has_angles(); }

    std::vector<Solver> solvers_of(TomlReader& table) const {
        check_distinct(table, "methods", methods_);
        std::vector<Solver> solvers;
        constexpr std::array of_model{&MethodEntry::angles, &MethodEntry::constraints, &MethodEntry::mechanism};
        for (const auto& model_name : model_names_)
            for (const auto& name : methods_)
                if (const auto model = value_named<Model>(model_name);
                    find_method(name)->*of_model[static_cast<std::size_t>(model)])
                    solvers.push_back({model, name});
        if (solvers.empty())
            throw table.error(table.has("methods") ? "methods" : "models",
                              "must leave a method with a model that it supports");
        return solvers;
    }

    TrialNumbers compute_trial(std::size_t trial, const std::atomic<bool>& stop) const override {
        const std::size_t first = problems.all.size();
        if (trial < first) {
            const auto& known = reference(trial, stop);
            return {known.sensitivity, known.disagreement};
        }
        const auto& [p, solver] = studies_[(trial - first) % studies_.size()];
        const bool is_first = trial - first < studies_.size();
        TrialNumbers numbers;
        for (const auto& outcome : run_step_study(problems.all[p], reference(p, stop), solver,
                                                  {max_evaluations, min_error, cost == Cost::time, is_first}, stop))
            append(numbers, outcome);
        return numbers;
    }

    std::string error_words(bool floors) const {
        return fmt::format("Errors: the worst {} against Taylor series in quad, {}, which agree.{}",
                           has_angles() ? "angle" : "place, as a part of the mechanism's size,",
                           problems.all.front().is_plain_chain() ? "in two formulations" : "at two tolerances",
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

std::string timing_caption(const WorkComparison::Studies& studies, int repeats) {
    if (repeats == 1) return "CPU time of one thread, warm, measured once.";
    const auto [typical, worst] = time_spread(studies);
    return fmt::format(
        "CPU time of one thread, warm, the median of {}; half of them lie within ± {:.1f} % of it, at worst within "
        "± {:.0f} %, shown as bars.",
        repeats, 100 * typical, 100 * worst);
}

const FigureKind work_precision_kind = kind_of<WorkPrecision>("work-precision");

}  // namespace doppel
