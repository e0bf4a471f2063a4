#include "library_chart.hpp"

#include "base/error.hpp"
#include "figure/work_precision.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace doppel {
namespace {

class LibraryChart final : public Experiment {
public:
    LibraryChart(std::shared_ptr<const Experiment> own, std::vector<ExternalMethod> methods)
        : own_(std::move(own)),
          compared_(dynamic_cast<const WorkComparison&>(*own_)),
          problems_(compared_.problems),
          methods_(std::move(methods)) {
        for (std::size_t p = 0; p < problems_.size(); ++p)
            for (std::size_t m = 0; m < methods_.size() && problems_[p].is_plain_chain(); ++m)
                studies_.emplace_back(p, m);
        unit_ = own_->unit();
        subtitle_ = own_->subtitle();
        columns_ = own_->columns();
        settings_ = own_->resolved();
    }

    std::size_t trials() const override { return own_->trials() + rounds() * studies_.size(); }
    bool measures_time() const override { return own_->measures_time(); }
    double units(std::size_t trial) const override { return trial < problems_.size() ? 0 : 1; }

    bool fits(std::size_t trial, std::span<const double> numbers) const override {
        // studies of any method have the same numbers
        return own_->fits(trial < problems_.size() ? trial : problems_.size(), numbers);
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        own_->write_rows(own(numbers), table);
        constexpr double none = NAN;
        const auto all = studies(numbers);
        for (std::size_t p = 0; p < all.size(); ++p)
            for (const auto& study : all[p])
                for (const auto& outcome : study.outcomes) {
                    const auto add = [&](const auto& error) {
                        add_row(table, problems_[p].name, "angles", "peer:" + study.solver.method, outcome.setting,
                                error, none, none, outcome.cpu_s, outcome.evaluations, outcome.steps);
                    };
                    outcome.failed() ? add("failed") : add(outcome.error);
                }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        const auto theirs = studies(numbers);
        const auto ours = compared_.merged_studies(own(numbers));
        const auto best = ranked(ours, compared_.cost, accuracies).front();
        auto named = ranked(theirs, compared_.cost, accuracies);
        const bool are_all = named.size() <= best_shown;
        named.resize(std::min(named.size(), best_shown));
        named.push_back(best);
        own_->draw(own(numbers), figure);
        for (std::size_t p = 0; p < problems_.size(); ++p) {
            std::vector<StepStudy> shown;
            std::ranges::copy_if(ours[p], std::back_inserter(shown),
                                 [&](const auto& study) { return study.solver.method == best; });
            shown.insert(shown.end(), theirs[p].begin(), theirs[p].end());
            const double floor = 0x1p-53 * numbers[p].front();  // of its sensitivity
            auto& plot = figure.panels[p];
            plot = work_plot({problems_[p], floor, ours[p], shown, compared_.cost, named, compared_.names});
            colour(named, plot);
        }
        figure.captions.front() = fmt::format(
            "In colour {} of other libraries{} and Doppel’s best; the pale band is the Pareto front of all of "
            "Doppel’s.",
            are_all ? "all methods" : "the five best methods",
            are_all ? "" : " (by the mean rank at 10⁻³, 10⁻⁶, 10⁻⁹ and 10⁻¹² rad)");
        if (measures_time()) figure.captions.back() = timing_caption(together(ours, theirs), compared_.repeats);
    }

    std::optional<std::string> nothing_to_draw(std::span<const TrialNumbers> numbers) const override {
        return own_->nothing_to_draw(own(numbers));
    }

private:
    static WorkComparison::Studies together(WorkComparison::Studies all, const WorkComparison::Studies& more) {
        for (std::size_t p = 0; p < all.size(); ++p) all[p].insert(all[p].end(), more[p].begin(), more[p].end());
        return all;
    }

    /// Where a trial belongs: to the figure of Doppel's methods, or to a study of another library's.
    struct Place {
        bool is_own;
        std::size_t number;  // of the trial in that figure, or of the study
    };
    Place place_of(std::size_t trial) const {
        const auto first = problems_.size(), each = own_studies() + studies_.size();
        if (trial < first) return {true, trial};
        const auto round = (trial - first) / each, within = (trial - first) % each;
        if (within < own_studies()) return {true, first + round * own_studies() + within};
        return {false, within - own_studies()};
    }
    std::size_t rounds() const { return measures_time() ? static_cast<std::size_t>(compared_.repeats) : 1; }
    std::size_t own_studies() const { return (own_->trials() - problems_.size()) / rounds(); }

    TrialNumbers compute(std::size_t trial, const std::atomic<bool>& stop) const override {
        const auto [is_own, number] = place_of(trial);
        if (is_own) return own_->compute(number, stop);
        const auto& [p, m] = studies_[number];
        const auto& problem = problems_[p];
        const auto& method = methods_[m];
        auto settings = settings_of(problem, {Model::angles, method.name}, method.adaptive, compared_.max_evaluations);
        std::erase_if(settings, [&](const MotionSpec& setting) {
            return setting_of(setting) < method.minimum || setting_of(setting) > method.maximum;
        });
        const auto make = [&](const MotionSpec& setting) {
            return method.make(setting.chain->cast<double>(), problem.duration(), setting_of(setting));
        };
        auto outcomes =
            run_settings(problem, compared_.reference(p, stop), settings,
                         {compared_.max_evaluations, compared_.min_error, measures_time(), false}, stop, make);
        if (outcomes.empty()) outcomes.emplace_back();
        TrialNumbers numbers;
        for (const auto& outcome : outcomes) append(numbers, outcome);
        return numbers;
    }

    /// The numbers of the figure of Doppel's methods.
    std::vector<TrialNumbers> own(std::span<const TrialNumbers> numbers) const {
        std::vector<TrialNumbers> all;
        for (std::size_t trial = 0; trial < numbers.size(); ++trial)
            if (place_of(trial).is_own) all.push_back(numbers[trial]);
        return all;
    }

    /// Those of other libraries, for each problem.
    WorkComparison::Studies studies(std::span<const TrialNumbers> numbers) const {
        WorkComparison::Studies all(problems_.size());
        for (std::size_t i = 0; i < studies_.size(); ++i) {
            std::vector<std::vector<StepResult>> measured;
            for (std::size_t trial = 0; trial < numbers.size(); ++trial)
                if (const auto place = place_of(trial); !place.is_own && place.number == i)
                    measured.push_back(rows_of<StepResult>(numbers[trial]));
            const auto& [p, m] = studies_[i];
            all[p].push_back(merged({Model::angles, methods_[m].name}, measured));
        }
        return all;
    }

    /// Gives each named method a colour of its own; Doppel's, the last, is named so.
    static void colour(const std::vector<std::string>& named, Plot& plot) {
        for (auto curve = plot.curves.begin(); curve != plot.curves.end(); ++curve) {
            const auto name = std::ranges::find(named, curve->label);
            if (curve->quiet || curve->label.empty() || name == named.end()) continue;
            if (*name == named.back()) {
                curve->label += " of Doppel";
                continue;
            }
            curve->hue = static_cast<int>(name - named.begin()) + 1;
            // the range of its times follows
            if (const auto next = std::next(curve); next != plot.curves.end() && next->background == Background::line)
                next->hue = curve->hue;
        }
    }

    std::shared_ptr<const Experiment> own_;
    const WorkComparison& compared_;
    const std::vector<WorkProblem>& problems_;
    std::vector<ExternalMethod> methods_;
    std::vector<std::pair<std::size_t, std::size_t>> studies_;  // the problem and the method of each
};

}  // namespace

FigurePreset library_chart(const PresetText& source, const std::vector<Override>& overrides,
                           std::vector<ExternalMethod> methods) {
    auto figure = read_figure(source, overrides);
    if (figure.kind != "work-precision")
        throw bad_input("{}: kind must be \"work-precision\"; it is \"{}\"", source.path, figure.kind);
    figure.experiment = std::make_shared<LibraryChart>(figure.experiment, std::move(methods));
    return figure;
}

}  // namespace doppel
