#include "analysis/difference.hpp"
#include "analysis/exponent.hpp"
#include "analysis/twins.hpp"
#include "figure/kinds.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace doppel {
namespace {

/// The numbers of a trial; without the exponent, the first alone.
struct SweepRow {
    double average, exponent, uncertainty;
};

/// The study's sweeps: the average ln(d/d₀) of twins, and the Lyapunov exponent, over a range of one parameter.
class Sweep final : public Experiment {
public:
    static constexpr std::string_view table_key = "sweep";
    Sweep() = default;
    explicit Sweep(FigureReader& reader) : pair_(reader.pair()) {
        auto table = reader.settings(*this);
        exponent_spec_.transient_s = exponent_spec_.duration_s / 10;
        if (pair_.a.links() < parameter_->links || !pair_.a.particles.empty())
            throw table.fault("parameter", "\"{}\" takes a chain of {} links", parameter_->name, parameter_->links);
        check_range(table);
        if (exponent_ && pair_.a.is_mechanism())
            throw table.fault("exponent", "is that of a plain chain, without forces and constraints of its own");
        settings_ = resolved_pair(pair_) + table.finish();
        const auto scene = make_scene(twins(0));
        make_scene(twins(trials_ - 1));  // reports faults now
        run_ = fast_run(scene);
        subtitle_ = words(scene);
    }

    template <class Visit>
    void fields(Visit& visit) {
        static constexpr std::array<std::string_view, 4> names{"theta1_deg", "theta2_deg", "mass_ratio",
                                                               "length_ratio"};
        parameter_field(visit, names, parameter_);
        visit({"from", "the first value"}, from_);
        visit({"to", "the last"}, to_);
        visit({"step", "between two values; from `from` to `to` a whole number of them", "", positive}, step_);
        visit({"difference", "of the parameter between the two of a pair"}, difference_);
        visit({"exponent", "the largest Lyapunov exponent of side a as well"}, exponent_);
        visit({"exponent_duration_s",
               "with `exponent`: of the motion that it is found by",
               "s",
               positive,
               "",
               {.holds = exponent_, .hides = true}},
              exponent_spec_.duration_s);
    }

    std::size_t trials() const override { return trials_; }
    std::size_t together() const override {
        // a twin that two neighbouring trials share is stepped once
        return run_ ? twins_block() / (shares_twins() ? 1 : 2) - (shares_twins() ? 1 : 0) : 1;
    }
    std::string unit() const override { return "pairs"; }
    std::string subtitle() const override { return subtitle_; }

    void compute(std::size_t first, std::span<TrialNumbers> numbers, const std::atomic<bool>& stop) const override {
        std::vector<double> averages(numbers.size());
        if (run_) {
            std::vector<Twins> all;
            for (std::size_t i = 0; i < numbers.size(); ++i) {
                const auto scene = make_scene(twins(first + i));
                all.push_back({scene.a.motion.chain->cast<double>(), scene.b.motion.chain->cast<double>()});
            }
            average_log_ratios(all, *run_, averages, stop);
        } else {
            for (std::size_t i = 0; i < numbers.size(); ++i) averages[i] = watched_average(first + i, stop);
        }
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            numbers[i] = {averages[i]};
            if (!exponent_) continue;
            const auto scene = make_scene(twins(first + i));
            const auto exponent = largest_exponent(scene.a.motion.chain->cast<double>(), exponent_spec_, stop);
            numbers[i].insert(numbers[i].end(), {exponent.value, exponent.uncertainty});
        }
    }

    bool fits(std::size_t /*trial*/, std::span<const double> numbers) const override {
        if (numbers.size() != (exponent_ ? 3 : 1) || std::isinf(numbers[0])) return false;
        return all_finite(numbers.subspan(1));
    }

    std::vector<std::string> columns() const override {
        std::vector<std::string> names{std::string(parameter_->name), "average_log_ratio"};
        if (exponent_) names.insert(names.end(), {"exponent_per_s", "exponent_uncertainty_per_s"});
        return names;
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (std::size_t i = 0; i < trials_; ++i) {
            const auto row = row_of_trial(numbers[i]);
            const auto parameter = static_cast<double>(value(i));
            if (exponent_)
                add_row(table, parameter, row.average, row.exponent, row.uncertainty);
            else
                add_row(table, parameter, row.average);
        }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        Plot plot;
        plot.x = {.label = std::string(parameter_->label),
                  .low = static_cast<double>(from_),
                  .high = static_cast<double>(to_)};
        if (parameter_->every > 0) plot.x.every = parameter_->every;
        plot.y = {.label = fmt::format("average of ln(d/d₀) over {} s", pair_.duration_s.value()), .low = 0};
        plot.curves.push_back(curve(numbers, &SweepRow::average, exponent_ ? "average of ln(d/d₀)" : ""));
        if (exponent_) {
            plot.right = PlotAxis{.label = "largest Lyapunov exponent, 1/s", .low = 0};
            auto exponents = curve(numbers, &SweepRow::exponent, "Lyapunov exponent");
            exponents.uncertainty = curve(numbers, &SweepRow::uncertainty, "").y;
            exponents.hue = 1;
            exponents.right = true;
            figure.captions.push_back(exponent_words(numbers, exponents));
            plot.curves.push_back(std::move(exponents));
        }
        figure.panels.push_back(std::move(plot));
    }

    std::optional<std::string> nothing_to_draw(std::span<const TrialNumbers> numbers) const override {
        if (exponent_ || broken_down(numbers) < trials_) return std::nullopt;
        return fmt::format(
            "every one of the {} pairs broke down within {} s; take a finer step or tolerance, or a shorter "
            "scene.duration_s",
            trials_, pair_.duration_s.value());
    }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        std::vector<Finding> all;
        double least = NAN, most = NAN, regular = 0;
        for (const auto& trial : numbers) {
            const auto row = row_of_trial(trial);
            least = std::fmin(least, row.average);
            most = std::fmax(most, row.average);
            if (exponent_ && is_regular({row.exponent, row.uncertainty})) ++regular;
        }
        all.push_back({"least_average_log_ratio", least});
        all.push_back({"greatest_average_log_ratio", most});
        if (const auto broken = broken_down(numbers); broken > 0)
            all.push_back({"trials_broken_down", static_cast<double>(broken)});
        if (exponent_) all.push_back({"regular_trials", regular});
        return all;
    }

private:
    SweepRow row_of_trial(const TrialNumbers& numbers) const {
        return exponent_ ? row_of<SweepRow>(numbers) : SweepRow{numbers[0], NAN, NAN};
    }

    /// Finds the number of trials.
    void check_range(const TomlReader& table) {
        constexpr long most = 10'000'000;
        const Quad steps = (to_ - from_) / step_;
        if (!(steps >= 0 && steps < most))
            throw table.fault("to", "must be \"from\" and at most {} steps more; it is {}", most, text_of(to_));
        const long whole = std::lround(static_cast<double>(steps));
        constexpr double slack = 1e-12;  // of decimals that are no whole number of steps by rounding alone
        if (std::abs(static_cast<double>(steps - Quad(static_cast<double>(whole)))) > slack)
            throw table.fault("step", "must divide the way from {} to {}; it is {}", text_of(from_), text_of(to_),
                              text_of(step_));
        trials_ = static_cast<std::size_t>(whole) + 1;
        constexpr double most_degrees = 1e6;  // as of [system] angle_deg
        for (const auto& [key, end] : {std::pair{"from", from_}, {"to", to_}, {"difference", Quad(to_ + difference_)}})
            if (!parameter_->is_ratio && abs(end) > most_degrees)
                throw table.fault(key, "must keep all angles from -{0} to {0}°; one is {1}", most_degrees,
                                  text_of(end));
        if (!parameter_->is_ratio) return;
        if (from_ <= 0) throw table.fault("from", "must be > 0, as ratios are; it is {}", text_of(from_));
        if (from_ + difference_ <= 0)
            throw table.fault("difference", "must leave the twin's ratio > 0; it is {}", text_of(difference_));
    }

    Quad value(std::size_t trial) const { return from_ + step_ * Quad(static_cast<double>(trial)); }
    bool shares_twins() const { return difference_ == step_; }

    /// Of twins that are released alike there is no ratio to their first distance.
    std::size_t broken_down(std::span<const TrialNumbers> numbers) const {
        const auto pair = twins(0);
        if (released_alike(pair.a, pair.b)) return 0;
        return static_cast<std::size_t>(
            std::count_if(numbers.begin(), numbers.end(), [](const auto& trial) { return std::isnan(trial[0]); }));
    }

    Preset twins(std::size_t trial) const {
        auto pair = pair_;
        parameter_->set(pair.a, value(trial));
        parameter_->set(pair.b, value(trial) + difference_);
        return pair;
    }

    /// How all twins are stepped in lanes, where they can be: explicit methods of fixed step on plain chains in double.
    std::optional<TwinRun> fast_run(const Scene& scene) const {
        TwinRun run{.sample_interval = 1 / pair_.sample_hz.value(), .samples = scene.samples};
        const auto take = [](const Side& side, TwinSide& into) {
            const auto& motion = side.motion;
            into = {motion.model, motion.method, motion.steps_per_sample};
            return !side.choice && motion.model != Model::mechanism && motion.precision == Precision::in_double &&
                   motion.stabilise == Stabilise::none && Batch::serves(motion.method);
        };
        if (!take(scene.a, run.a) || !take(scene.b, run.b)) return std::nullopt;
        return run;
    }

    std::string words(Scene scene) const {
        // the difference of all twins is named on its own
        parameter_->set(scene.preset.b, from_);
        const auto apart = text_of(difference_ < 0 ? Quad(-difference_) : difference_);
        if (parameter_->is_ratio) {
            std::string label(parameter_->label);
            label.insert(label.find(" ratio") + 6, "s");
            return pair_subtitle(scene, {}, difference_ == 0 ? "" : fmt::format("{} apart by {}", label, apart));
        }
        return pair_subtitle(scene, parameter_->links - 1,
                             difference_ == 0 ? "" : fmt::format("twins {}° apart", apart));
    }

    /// A twins' average by the sample loop of the films: any model, method and precision.
    double watched_average(std::size_t trial, const std::atomic<bool>& stop) const {
        const auto scene = make_scene(twins(trial), stop);
        PairRun run(scene);
        const double start = run.next(stop).distance;
        double sum = 0;
        long counted = 0;
        try {
            for (long n = 1; n <= scene.samples; ++n)
                if (const auto ratio = log_ratio(run.next(stop).distance, start)) {
                    sum += *ratio;
                    ++counted;
                }
        } catch (const BreakDown&) {
            return NAN;
        }
        return sum / static_cast<double>(counted);
    }

    /// Counts the regular releases, and takes equilibria out of the curve: their exponent is not that of a motion.
    std::string exponent_words(std::span<const TrialNumbers> numbers, Curve& exponents) const {
        long regular = 0;
        std::string equilibria;
        for (std::size_t i = 0; i < trials_; ++i) {
            const auto row = row_of_trial(numbers[i]);
            regular += is_regular({row.exponent, row.uncertainty});
            if (row.exponent == 0 || row.uncertainty != 0) continue;
            equilibria += fmt::format(" At {:g}{}, an unstable equilibrium, it is {:.2f} 1/s.", exponents.x[i],
                                      parameter_->is_ratio ? "" : "°", row.exponent);
            exponents.y[i] = NAN;
        }
        return fmt::format(
            "{} of {} releases are regular: their exponent cannot be told from 0. Its band is one standard "
            "deviation.{}",
            regular, trials_, equilibria);
    }

    Curve curve(std::span<const TrialNumbers> numbers, double SweepRow::*number, std::string label) const {
        Curve made{.label = std::move(label)};
        for (std::size_t i = 0; i < trials_; ++i) {
            made.x.push_back(static_cast<double>(value(i)));
            made.y.push_back(row_of_trial(numbers[i]).*number);
        }
        return made;
    }

    Preset pair_;
    const ReleaseParameter* parameter_ = &release_parameter("theta1_deg");
    Quad from_ = 0, to_ = 180, step_ = 1, difference_ = 0;
    std::size_t trials_ = 0;
    bool exponent_ = false;
    ExponentSpec exponent_spec_;
    std::optional<TwinRun> run_;
    std::string subtitle_;
};

}  // namespace

const FigureKind sweep_kind = kind_of<Sweep>("sweep", FigureKind::System::pair);

}  // namespace doppel
