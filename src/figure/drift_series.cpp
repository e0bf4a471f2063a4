#include "analysis/drift.hpp"
#include "figure/series.hpp"
#include "scene/captions.hpp"

#include <fmt/ranges.h>

#include <numeric>

namespace doppel {
namespace {

/// A law of growth, and the hue of its curves; in the order of Growth::Kind.
struct GrowthStyle {
    std::string_view law;
    int hue;
};
constexpr std::array<GrowthStyle, 6> styles{{{"", 1}, {" ∝ √t", 2}, {" ∝ t", 0}, {" ∝ t²", 3}, {"", 4}, {"", 6}}};

const GrowthStyle& style_of(const Growth& growth) {
    return styles.at(static_cast<std::size_t>(growth.kind));
}

/// A trial is a run of a method.
class Drift final : public Series {
public:
    Drift(FigureReader& reader, const TomlReader& table, SeriesKeys& keys)
        : release_(reader.release()), evaluations_per_s_(keys.evaluations_per_s) {
        if (reader.only_keys) return;
        if (keys.methods.empty()) throw table.error("methods", "must name at least one");
        for (const auto model : {Model::angles, Model::constraints})
            for (const auto& name : methods_of(model, keys.methods)) add_run(name, model);
        for (const auto& name : keys.projected) {
            if (!find_method(name)->constraints)
                throw table.error("projected", "needs methods that integrate constraints; \"{}\" does not", name);
            add_run(name, Model::constraints, true);
        }
        check_distinct(table, "methods", keys.methods);
        check_distinct(table, "projected", keys.projected);
        // from 1 s on, rounded to three digits
        for (int i = 0; times_s_.empty() || times_s_.back() < keys.duration_s; ++i) {
            const int decade = i / keys.points_per_decade;
            const double part = std::pow(10, static_cast<double>(i % keys.points_per_decade) / keys.points_per_decade);
            times_s_.push_back(std::fmin(std::round(100 * part) / 100 * std::pow(10, decade), keys.duration_s));
        }
        trials_ = runs_.size();
        own_ = numbers_in<DriftCost>;
        each_ = 2;  // errors of the energy, and of the rods
        are_finite_ = {false};
        shown_ = each_ * trials_;
        settings_ = resolved_release(release_) + settings_text(keys);
        unit_ = "motions";
        columns_ = {"method", "model", "setting", "time_s", "energy_error", "length_error_m"};
        subtitle_ = fmt::format("{}; every method at some {:g} evaluations a second of motion", motion_words(release_),
                                evaluations_per_s_);
        // leaves room for names after the end
        axes_.x = {.label = "time, s", .low = 1, .high = 9 * times_s_.back(), .logarithmic = true};
        axes_.y = {.label = "maximum relative error of the energy to date", .high = 10, .logarithmic = true};
        none_words_ =
            fmt::format("no method has an error, or none reached {} s, the first point; use more evaluations_per_s",
                        times_s_.front());
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (std::size_t r = 0; r < runs_.size(); ++r) {
            const auto energy = values(numbers, each_ * r), rods = values(numbers, each_ * r + 1);
            const auto cost = row_of<DriftCost>(numbers[r]);
            for (std::size_t i = 0; i < times_s_.size(); ++i)
                if (!std::isnan(energy[i]))
                    add_row(table, runs_[r].motion.method, runs_[r].model, cost.setting,
                            std::fmin(times_s_[i], cost.failed_at_s), energy[i], rods[i]);
        }
    }

    std::optional<Part> part(double share) const override {
        constexpr double tries = 16;  // about the number of settings that are tried before a run
        return cut(*this, share, [](double time_s) { return time_s + tries * std::min(time_s, calibration_s); });
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        for (const bool of_rods : {false, true}) {
            auto plot = axes_;
            if (of_rods) plot.y.label = "maximum error of a rod to date, m, with constraints";
            for (const std::size_t run : longest_first(numbers))
                if (of_rods ? has_rods(run) : runs_[run].shows_energy) add_curves(numbers, run, of_rods, plot);
            if (!plot.curves.empty()) figure.panels.push_back(std::move(plot));
        }
        figure.captions.push_back(caption(numbers));
    }

private:
    struct Run {
        MotionSpec motion;
        std::string model, label;  // in the table; of the curve
        bool shows_energy;         // the energy is shown for the best model of a method
    };

    void add_run(const std::string& method, Model model, bool is_projected = false) {
        runs_.push_back({{.chain = chain_of(release_),
                          .model = model,
                          .method = method,
                          .stabilise = is_projected ? Stabilise::projection : Stabilise::none},
                         is_projected ? "projected constraints" : std::string(name_of(model)),
                         method + (is_projected ? " projected" : ""),
                         model == Model::angles || (!is_projected && !find_method(method)->angles)});
    }
    bool has_rods(std::size_t run) const { return runs_[run].motion.model == Model::constraints; }

    TrialNumbers compute(std::size_t trial, const std::atomic<bool>& stop) const override {
        const auto run = drift(runs_[trial].motion, evaluations_per_s_, times_s_, stop);
        TrialNumbers numbers;
        append<DriftCost>(numbers, run);
        numbers.insert(numbers.end(), run.errors.begin(), run.errors.end());
        return numbers;
    }

    /// The maximum error to date; NaN is kept.
    std::vector<double> maximum(std::span<const TrialNumbers> numbers, std::size_t run, bool of_rods) const {
        const auto errors = values(numbers, each_ * run + (of_rods ? 1 : 0));
        std::vector<double> worst(errors.begin(), errors.end());
        for (std::size_t i = 1; i < worst.size(); ++i)
            if (!std::isnan(worst[i])) worst[i] = std::fmax(worst[i], worst[i - 1]);
        return worst;
    }
    Growth growth(std::span<const TrialNumbers> numbers, std::size_t run, bool of_rods) const {
        return growth_of(times_s_, maximum(numbers, run, of_rods), row_of<DriftCost>(numbers[run]).failed_at_s);
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
    void add_curves(std::span<const TrialNumbers> numbers, std::size_t run, bool of_rods, Plot& plot) const {
        const auto found = growth(numbers, run, of_rods);
        const auto& style = style_of(found);
        Curve curve{.label = runs_[run].label, .hue = style.hue};
        curve.label += style.law;
        const auto errors = maximum(numbers, run, of_rods);
        const double end_s = row_of<DriftCost>(numbers[run]).failed_at_s;
        for (std::size_t i = 0; i < errors.size(); ++i)
            if (errors[i] > 0) add_point(curve, std::fmin(times_s_[i], end_s), errors[i]);
        if (curve.x.empty()) return;
        if (found.kind == Growth::Kind::failed)
            plot.curves.push_back(
                {.x = {curve.x.back()}, .y = {curve.y.back()}, .mark = Mark::points, .hue = curve.hue});
        plot.curves.push_back(std::move(curve));
    }

    /// The final energy errors, and how to read the curves.
    std::string caption(std::span<const TrialNumbers> numbers) const override {
        std::vector<std::string> bounded;
        constexpr double long_s = 10000;  // what is bounded for so long is called bounded
        const auto until = times_s_.back() < long_s ? fmt::format(" for {:g} s", times_s_.back()) : "";
        bool breaks = false, grow = false;
        for (std::size_t run = 0; run < runs_.size(); ++run) {
            const auto found = growth(numbers, run, false);
            breaks |= found.kind == Growth::Kind::failed;
            grow |=
                !style_of(found).law.empty() || (has_rods(run) && !style_of(growth(numbers, run, true)).law.empty());
            if (runs_[run].shows_energy && found.kind == Growth::Kind::bounded) bounded.push_back(runs_[run].label);
        }
        return fmt::format("{}{}{}.",
                           bounded.empty() ? "No method keeps the error of the energy bounded"
                                           : fmt::format("The error of the energy stays bounded{} with {}", until,
                                                         fmt::join(bounded, ", ")),
                           grow ? "; ∝ tells how the others grow" : "",
                           breaks ? fmt::format("{} a dot marks a failed run", grow ? "," : ";") : "");
    }

    SideSpec release_;
    double evaluations_per_s_;
    std::vector<Run> runs_;
};

}  // namespace

std::shared_ptr<const Experiment> drift_series(FigureReader& reader, const TomlReader& table, SeriesKeys& keys) {
    return std::make_shared<Drift>(reader, table, keys);
}

}  // namespace doppel
