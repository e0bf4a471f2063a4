#include "analysis/drift.hpp"

#include "figure/series.hpp"
#include "integrate/methods.hpp"
#include "scene/captions.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace doppel {
namespace {

/// The name of a law of growth, and the hue of its curves; in the order of Growth::Kind.
struct GrowthStyle {
    std::string_view words, law;
    int hue;
};
constexpr std::array styles{GrowthStyle{"stays bounded", "", 1}, GrowthStyle{"grows like √t", " ∝ √t", 2},
                            GrowthStyle{"grows linearly", " ∝ t", 0}, GrowthStyle{"grows like t²", " ∝ t²", 3},
                            GrowthStyle{"fails", "", 6}};

const GrowthStyle& style_of(const Growth& growth) {
    return styles.at(static_cast<std::size_t>(growth.kind));
}

/// The running maximum; NaN is kept.
std::vector<double> running_maximum(std::vector<double> worst) {
    for (std::size_t i = 1; i < worst.size(); ++i)
        if (!std::isnan(worst[i])) worst[i] = std::fmax(worst[i], worst[i - 1]);
    return worst;
}

/// Long-term errors of energy and rod lengths, every method at the same cost.
class Drift final : public Experiment {
public:
    Drift(FigureReader& reader, const TomlReader& table, SeriesKeys& keys)
        : release_(reader.release()), duration_s_(keys.duration_s), evaluations_per_s_(keys.evaluations_per_s) {
        if (reader.only_keys) return;
        find_times(keys.points_per_decade);
        const auto &methods = keys.methods, &projected = keys.projected;
        if (methods.empty()) throw table.error("methods", "must name at least one");
        for (const auto& name : methods)
            if (find_method(name)->angles) add_run(name, Model::angles);
        for (const auto& name : methods)
            if (find_method(name)->constraints) add_run(name, Model::constraints);
        for (const auto& name : projected) {
            if (!find_method(name)->constraints)
                throw table.error("projected", "needs methods that integrate constraints; \"{}\" does not", name);
            add_run(name, Model::constraints, Stabilise::projection);
        }
        check_distinct(table, "methods", methods);
        check_distinct(table, "projected", projected);
        settings_ = resolved_release(release_) + settings_text(keys);
        unit_ = "motions";
        columns_ = {"method", "model", "setting", "time_s", "energy_error", "length_error_m"};
        subtitle_ = fmt::format("{}; every method at some {:g} evaluations a second of motion", motion_words(release_),
                                evaluations_per_s_);
    }

    std::size_t trials() const override { return runs_.size(); }

    bool fits(std::size_t /*trial*/, std::span<const double> numbers) const override {
        constexpr std::size_t finite = 3;  // all members of DriftCost except the last
        return numbers.size() == numbers_in<DriftCost> + 2 * times_s_.size() && all_finite(numbers.first(finite)) &&
               finite_or_none(numbers.subspan(finite));
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (std::size_t r = 0; r < runs_.size(); ++r) {
            const auto run = run_of(numbers[r]);
            for (std::size_t i = 0; i < times_s_.size(); ++i)
                if (!std::isnan(run.energy_error[i]))
                    add_row(table, runs_[r].method, model_words(runs_[r]), run.setting, time(run, i),
                            run.energy_error[i], run.length_error[i]);
        }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        for (const bool of_rods : {false, true}) {
            Plot plot;
            // leaves room for names after the end
            plot.x = {.label = "time, s", .low = 1, .high = 9 * times_s_.back(), .logarithmic = true};
            plot.y = {.label = of_rods ? "maximum error of a rod to date, m, with constraints"
                                       : "maximum relative error of the energy to date",
                      .high = 10,
                      .logarithmic = true};
            for (const std::size_t run : longest_first(numbers))
                if (shows(run, of_rods)) add_curves(run_of(numbers[run]), curve_words(run), of_rods, plot);
            if (plot.curves.empty()) continue;
            figure.panels.push_back(std::move(plot));
        }
        figure.captions.push_back(error_caption(numbers));
    }

    std::optional<std::string> nothing_to_draw(std::span<const TrialNumbers> numbers) const override {
        for (const auto& trial : numbers)
            if (std::any_of(trial.begin() + numbers_in<DriftCost>, trial.end(), [](double x) { return x > 0; }))
                return std::nullopt;
        return fmt::format("no method has an error, or none reached {} s, the first point; use more evaluations_per_s",
                           times_s_.front());
    }

    Json findings(std::span<const TrialNumbers> numbers) const override {
        Json all;
        for (std::size_t r = 0; r < runs_.size(); ++r) {
            const auto run = run_of(numbers[r]);
            auto name = fmt::format("{}_{}", runs_[r].method, model_words(runs_[r]));
            std::ranges::replace(name, ' ', '_');
            all[name + "_setting"] = run.setting;
            all[name + "_evaluations_per_s"] = run.evaluations_per_s;
            all[name + "_cpu_s"] = run.cpu_s;
            for (const bool of_rods : {false, true}) {
                if (of_rods && runs_[r].model == Model::angles) continue;
                const auto found = growth(run, of_rods);
                const auto quantity = name + (of_rods ? "_rods_" : "_energy_");
                all[quantity + "growth"] = std::string(style_of(found).words);
                all[quantity + "exponent"] = found.exponent;
                if (run.failed_at_s > 0) all[quantity + "doubling_s"] = found.doubling_s;
            }
            if (run.failed_at_s > 0) all[name + "_broken_at_s"] = run.failed_at_s;
        }
        return all;
    }

private:
    /// Sets times from 1 s on, rounded to three digits.
    void find_times(int points_per_decade) {
        for (int i = 0;; ++i) {
            const int decade = i / points_per_decade;
            const double part = std::pow(10, static_cast<double>(i % points_per_decade) / points_per_decade);
            const double time = std::round(100 * part) / 100 * std::pow(10, decade);
            if (time >= duration_s_) break;
            times_s_.push_back(time);
        }
        times_s_.push_back(duration_s_);
    }

    void add_run(const std::string& method, Model model, Stabilise stabilise = Stabilise::none) {
        runs_.push_back({.chain = chain_of(release_), .model = model, .method = method, .stabilise = stabilise});
    }

    static bool is_projected(const MotionSpec& run) { return run.stabilise == Stabilise::projection; }
    static std::string model_words(const MotionSpec& run) {
        return is_projected(run) ? "projected constraints" : std::string(name_of(run.model));
    }

    TrialNumbers compute_trial(std::size_t trial, const std::atomic<bool>& stop) const override {
        const auto run = drift(runs_[trial], evaluations_per_s_, times_s_, stop);
        TrialNumbers numbers;
        append<DriftCost>(numbers, run);
        for (const auto* errors : {&run.energy_error, &run.length_error})
            numbers.insert(numbers.end(), errors->begin(), errors->end());
        return numbers;
    }
    DriftRun run_of(const TrialNumbers& trial) const {
        const auto energy = trial.begin() + numbers_in<DriftCost>;
        const auto rods = energy + static_cast<std::ptrdiff_t>(times_s_.size());
        return {row_of<DriftCost>(trial), {energy, rods}, {rods, trial.end()}};
    }

    /// The time of a point, or of an earlier failure, s.
    double time(const DriftRun& run, std::size_t point) const { return std::fmin(times_s_[point], run.failed_at_s); }
    Growth growth(const DriftRun& run, bool of_rods) const {
        return growth_of(times_s_, running_maximum(of_rods ? run.length_error : run.energy_error), run.failed_at_s);
    }

    /// The energy is shown for the best model of a method; the rods for all models with rods.
    bool shows(std::size_t run, bool of_rods) const {
        if (of_rods || runs_[run].model == Model::angles) return of_rods == (runs_[run].model == Model::constraints);
        return !is_projected(runs_[run]) && !find_method(runs_[run].method)->angles;
    }
    std::string curve_words(std::size_t run) const {
        return runs_[run].method + (is_projected(runs_[run]) ? " projected" : "");
    }

    /// Curves that end early are drawn last, so that their labels are at their ends.
    std::vector<std::size_t> longest_first(std::span<const TrialNumbers> numbers) const {
        std::vector<std::size_t> order(runs_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t r) {
            return std::fmin(times_s_.back(), row_of<DriftCost>(numbers[r]).failed_at_s);
        });
        return order;
    }

    /// Adds a line, with a mark if the run fails.
    void add_curves(const DriftRun& run, const std::string& name, bool of_rods, Plot& plot) const {
        const auto found = growth(run, of_rods);
        const auto& style = style_of(found);
        Curve curve{.label = name, .hue = style.hue};
        curve.label += style.law;
        const auto errors = running_maximum(of_rods ? run.length_error : run.energy_error);
        for (std::size_t i = 0; i < errors.size(); ++i) {
            if (!(errors[i] > 0)) continue;
            add_point(curve, time(run, i), errors[i]);
        }
        if (curve.x.empty()) return;
        if (found.kind == Growth::Kind::failed)
            plot.curves.push_back(
                {.x = {curve.x.back()}, .y = {curve.y.back()}, .mark = Mark::points, .hue = curve.hue});
        plot.curves.push_back(std::move(curve));
    }

    /// The final energy errors, and how to read the curves.
    std::string error_caption(std::span<const TrialNumbers> numbers) const {
        std::vector<std::string> bounded;
        bool breaks = false;
        for (std::size_t run = 0; run < runs_.size(); ++run) {
            const auto kind = growth(run_of(numbers[run]), false).kind;
            breaks |= kind == Growth::Kind::failed;
            if (shows(run, false) && kind == Growth::Kind::bounded) bounded.push_back(curve_words(run));
        }
        return fmt::format("{}; ∝ tells how the others grow{}.",
                           bounded.empty()
                               ? "No method keeps the error of the energy bounded"
                               : fmt::format("The error of the energy stays bounded with {}", fmt::join(bounded, ", ")),
                           breaks ? ", a dot marks a failed run" : "");
    }

    SideSpec release_;
    double duration_s_, evaluations_per_s_;
    std::vector<double> times_s_;  // of the points, ascending; the last is the end of the run
    std::vector<MotionSpec> runs_;
};

}  // namespace

std::shared_ptr<const Experiment> make_drift(FigureReader& reader, const TomlReader& table, SeriesKeys& keys) {
    return std::make_shared<Drift>(reader, table, keys);
}

}  // namespace doppel
