#include "figure/drift_growth.hpp"
#include "figure/drift_run.hpp"
#include "figure/kinds.hpp"
#include "integrate/methods.hpp"
#include "scene/resolved.hpp"
#include "scene/captions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace doppel {
namespace {

// what a trial's numbers begin with; then the energy errors and the length errors of all points
enum DriftEntry : std::size_t { setting, evaluations, cpu, broken, points };

/// How a kind of growth looks: one hue for all its curves, and its law beside their names.
struct GrowthLook {
    Growth::Kind kind;
    int hue;
    std::string_view law;
};
constexpr std::array looks{GrowthLook{Growth::Kind::bounded, 1, ""}, GrowthLook{Growth::Kind::root, 2, " ∝ √t"},
                           GrowthLook{Growth::Kind::linear, 0, " ∝ t"}, GrowthLook{Growth::Kind::steeper, 3, " ∝ t²"},
                           GrowthLook{Growth::Kind::breakdown, 6, ""}};

/// Of errors that each are the worst since the one before.
std::vector<double> worst_so_far(std::span<const double> errors) {
    std::vector<double> worst(errors.begin(), errors.end());
    for (std::size_t i = 1; i < worst.size(); ++i)
        if (!std::isnan(worst[i])) worst[i] = std::fmax(worst[i], worst[i - 1]);
    return worst;
}

/// What a method makes of energy and rods over a long time, every method at the same cost.
class Drift final : public FigureWork {
public:
    explicit Drift(FigureReader& reader) {
        spec_.release = reader.release();
        auto table = reader.table("drift");
        read_times(table);
        table.read_positive("evaluations_per_s", spec_.evaluations_per_s);
        constexpr double least = 10, most = 1e6;
        if (spec_.evaluations_per_s < least || spec_.evaluations_per_s > most)
            throw table.fault("evaluations_per_s", "must be from {} to {}; it is {}", least, most,
                              spec_.evaluations_per_s);
        for (const auto& method : doppel::methods())
            if (method.angles || method.constraints) methods_.emplace_back(method.name);
        if (const auto names = table.read_texts("methods")) methods_ = *names;
        if (const auto names = table.read_texts("projected")) projected_ = *names;
        if (methods_.empty()) throw table.fault("methods", "must name at least one");
        for (const auto& name : methods_)
            if (known(table, "methods", name).angles) runs_.push_back({name, Model::angles});
        for (const auto& name : methods_)
            if (find_method(name)->constraints) runs_.push_back({name, Model::constraints});
        for (const auto& name : projected_) {
            if (!known(table, "projected", name).constraints)
                throw table.fault("projected", "takes methods that step constraints; \"{}\" does not", name);
            runs_.push_back({name, Model::constraints, true});
        }
        check_distinct(table, "methods", methods_);
        check_distinct(table, "projected", projected_);
        table.finish();
    }

    std::size_t trials() const override { return runs_.size(); }
    std::string unit() const override { return "motions"; }

    void compute(std::size_t first, std::span<TrialNumbers> numbers, const std::atomic<bool>& stop) const override {
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            const auto run = drift(spec_, runs_[first + i], stop);
            numbers[i] = {run.setting, run.evaluations_per_s, run.cpu_s, run.broken_at_s};
            for (const auto* errors : {&run.energy_error, &run.length_error})
                numbers[i].insert(numbers[i].end(), errors->begin(), errors->end());
        }
    }

    bool fits(std::size_t /*trial*/, std::span<const double> numbers) const override {
        return numbers.size() == points + 2 * spec_.times_s.size() && all_finite(numbers.first(broken)) &&
               finite_or_none(numbers.subspan(broken));
    }

    std::vector<std::string> columns() const override {
        return {"method", "model", "setting", "time_s", "energy_error", "length_error_m"};
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (std::size_t run = 0; run < runs_.size(); ++run)
            for (std::size_t i = 0; i < spec_.times_s.size(); ++i) {
                if (std::isnan(energy(numbers[run])[i])) continue;
                table.add(runs_[run].name);
                table.add(model_words(runs_[run]));
                table.add(numbers[run][setting]);
                table.add(time(numbers[run], i));
                table.add(energy(numbers[run])[i]);
                table.add(rods(numbers[run])[i]);
                table.end_row();
            }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        figure.captions.push_back(cost_words(numbers));
        for (const bool of_rods : {false, true}) {
            Plot plot;
            // room for names beyond the end
            plot.x = {.label = "time, s", .low = 1, .high = 9 * spec_.times_s.back(), .logarithmic = true};
            plot.y = {.label = of_rods ? "worst error of a rod so far, m, in constraints"
                                       : "worst relative error of the energy so far",
                      .high = 100,
                      .logarithmic = true};
            for (const std::size_t run : longest_first(numbers))
                if (shows(run, of_rods)) add_curves(numbers[run], run, of_rods, plot);
            if (plot.curves.empty()) continue;
            figure.panels.push_back(std::move(plot));
            figure.captions.push_back(growth_caption(numbers, of_rods));
        }
    }

    std::optional<std::string> nothing_to_draw(std::span<const TrialNumbers> numbers) const override {
        for (const auto& trial : numbers)
            for (const auto& errors : {energy(trial), rods(trial)})
                if (std::any_of(errors.begin(), errors.end(), [](double x) { return x > 0; })) return std::nullopt;
        return fmt::format(
            "no method makes an error, or none came as far as {} s, the first point: more evaluations_per_s take it "
            "further",
            spec_.times_s.front());
    }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        std::vector<Finding> all;
        for (std::size_t run = 0; run < runs_.size(); ++run) {
            const auto& trial = numbers[run];
            auto name = fmt::format("{}_{}", runs_[run].name, model_words(runs_[run]));
            std::replace(name.begin(), name.end(), ' ', '_');
            all.push_back({name + "_setting", trial[setting]});
            all.push_back({name + "_evaluations_per_s", trial[evaluations]});
            all.push_back({name + "_cpu_s", trial[cpu]});
            for (const bool of_rods : {false, true}) {
                if (of_rods && runs_[run].model == Model::angles) continue;
                const auto found = growth(trial, of_rods);
                const auto quantity = name + (of_rods ? "_rods_" : "_energy_");
                all.push_back({quantity + "growth", std::string(growth_words(found.kind))});
                all.push_back({quantity + "exponent", found.exponent});
                if (found.broken_at_s > 0) all.push_back({quantity + "doubling_s", found.doubling_s});
            }
            if (trial[broken] > 0) all.push_back({name + "_broken_at_s", trial[broken]});
        }
        return all;
    }

    std::string resolved() const override {
        const auto list = [](const std::vector<std::string>& names) {
            std::vector<std::string> quoted;
            for (const auto& name : names) quoted.push_back(toml_text(name));
            return fmt::format("{}", fmt::join(quoted, ", "));
        };
        return resolved_release(spec_.release) +
               fmt::format(
                   "\n[drift]\nduration_s = {}\npoints_per_decade = {}\nevaluations_per_s = {}\nmethods = [{}]\n"
                   "projected = [{}]\n",
                   spec_.times_s.back(), points_per_decade_, spec_.evaluations_per_s, list(methods_), list(projected_));
    }

private:
    /// From the first second on, at three digits.
    void read_times(TomlReader& table) {
        double duration = 1e5;
        table.read_positive("duration_s", duration);
        constexpr double least = 10, most = 1e8;
        if (duration < least || duration > most)
            throw table.fault("duration_s", "must be from {} to {}; it is {}", least, most, duration);
        table.read_whole("points_per_decade", points_per_decade_, 1, 100);
        for (int i = 0;; ++i) {
            const int decade = i / points_per_decade_;
            const double part = std::pow(10, static_cast<double>(i % points_per_decade_) / points_per_decade_);
            const double time = std::round(100 * part) / 100 * std::pow(10, decade);
            if (time >= duration) break;
            spec_.times_s.push_back(time);
        }
        spec_.times_s.push_back(duration);
    }

    static const MethodEntry& known(const TomlReader& table, std::string_view key, const std::string& name) {
        const auto* method = find_method(name);
        if (method && (method->angles || method->constraints)) return *method;
        throw table.fault(key, "must be names of methods (doppel list methods); \"{}\" is none", name);
    }

    static std::string model_words(const DriftMethod& run) {
        return run.projected ? "projected constraints" : std::string(name_of(run.model));
    }

    std::span<const double> energy(const TrialNumbers& trial) const {
        return std::span(trial).subspan(points, spec_.times_s.size());
    }
    std::span<const double> rods(const TrialNumbers& trial) const {
        return std::span(trial).subspan(points + spec_.times_s.size());
    }
    /// Of a point, or of the breakdown that came before it, s.
    double time(const TrialNumbers& trial, std::size_t point) const {
        return std::fmin(spec_.times_s[point], trial[broken]);
    }
    std::vector<double> worst(const TrialNumbers& trial, bool of_rods) const {
        return worst_so_far(of_rods ? rods(trial) : energy(trial));
    }
    Growth growth(const TrialNumbers& trial, bool of_rods) const {
        return growth_of(spec_.times_s, worst(trial, of_rods), trial[broken]);
    }

    /// The energy in the best model that a method serves; the rods in all that have any.
    bool shows(std::size_t run, bool of_rods) const {
        if (of_rods || runs_[run].model == Model::angles) return of_rods == (runs_[run].model == Model::constraints);
        return !runs_[run].projected && !find_method(runs_[run].name)->angles;
    }
    std::string curve_words(std::size_t run) const {
        return runs_[run].name + (runs_[run].projected ? " projected" : "");
    }

    /// So that those that end among others are named at their ends.
    std::vector<std::size_t> longest_first(std::span<const TrialNumbers> numbers) const {
        std::vector<std::size_t> order(runs_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(), [&](std::size_t one, std::size_t other) {
            return time(numbers[one], spec_.times_s.size() - 1) > time(numbers[other], spec_.times_s.size() - 1);
        });
        return order;
    }

    /// A line, and a mark where it breaks down.
    void add_curves(const TrialNumbers& trial, std::size_t run, bool of_rods, Plot& plot) const {
        const auto found = growth(trial, of_rods);
        const auto& look =
            *std::find_if(looks.begin(), looks.end(), [&](const auto& l) { return l.kind == found.kind; });
        Curve curve{.label = curve_words(run), .hue = look.hue};
        curve.label += look.law;
        const auto errors = worst(trial, of_rods);
        for (std::size_t i = 0; i < errors.size(); ++i) {
            if (!(errors[i] > 0)) continue;
            curve.x.push_back(time(trial, i));
            curve.y.push_back(errors[i]);
        }
        if (curve.x.empty()) return;
        if (found.kind == Growth::Kind::breakdown)
            plot.curves.push_back(
                {.x = {curve.x.back()}, .y = {curve.y.back()}, .mark = Mark::points, .hue = curve.hue});
        plot.curves.push_back(std::move(curve));
    }

    /// What all took, and who took less.
    std::string cost_words(std::span<const TrialNumbers> numbers) const {
        std::string exceptions;
        for (std::size_t run = 0; run < runs_.size(); ++run) {
            constexpr double within = 0.02;
            const double taken = numbers[run][evaluations];
            if (numbers[run][broken] > 0 || std::abs(taken / spec_.evaluations_per_s - 1) < within) continue;
            exceptions += fmt::format("{} {} in {} {:.0f}", exceptions.empty() ? ";" : ",", curve_words(run),
                                      name_of(runs_[run].model), taken);
        }
        return fmt::format("Each takes {:g} evaluations of the right-hand side a second of motion{}.",
                           spec_.evaluations_per_s, exceptions);
    }

    /// Who grows how, with the fitted exponents.
    std::string growth_caption(std::span<const TrialNumbers> numbers, bool of_rods) const {
        std::string words;
        for (const auto& look : looks) {
            std::string names;
            for (std::size_t run = 0; run < runs_.size(); ++run) {
                const auto found = growth(numbers[run], of_rods);
                if (!shows(run, of_rods) || found.kind != look.kind) continue;
                names += fmt::format("{} {}", names.empty() ? ":" : ",", curve_words(run));
                if (found.kind == Growth::Kind::breakdown)
                    names += fmt::format(" after {} s", roughly(found.broken_at_s));
                else
                    names += fmt::format(" ({:.2f})", found.exponent);
                if (found.doubling_s > 0) names += fmt::format(" (doubling in {} s)", roughly(found.doubling_s));
            }
            if (!names.empty())
                words += fmt::format("{} {}{}", words.empty() ? "" : ";", growth_words(look.kind), names);
        }
        return fmt::format("{}{}.", of_rods ? "The rods’ error" : "The energy’s error", words);
    }

    DriftSpec spec_;
    int points_per_decade_ = 10;
    std::vector<std::string> methods_, projected_;
    std::vector<DriftMethod> runs_;
};

}  // namespace

std::shared_ptr<const FigureWork> read_drift(FigureReader& reader) {
    return std::make_shared<Drift>(reader);
}

}  // namespace doppel
