#include "figure/kinds.hpp"
#include "figure/work_chart.hpp"
#include "integrate/methods.hpp"
#include "numeric/nan.hpp"
#include "scene/resolved.hpp"
#include "scene/captions.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace doppel {
namespace {

using namespace std::string_view_literals;

constexpr std::array costs{"time"sv, "evaluations"sv};
constexpr std::array all_models{Model::angles, Model::constraints, Model::mechanism};

/// What a person may want of the end, rad.
struct Accuracy {
    double error;
    const char *key, *words;
};
constexpr std::array<Accuracy, 4> accuracies{
    {{1e-3, "1e-3", "10⁻³"}, {1e-6, "1e-6", "10⁻⁶"}, {1e-9, "1e-9", "10⁻⁹"}, {1e-12, "1e-12", "10⁻¹²"}}};

/// What the accuracy of every method costs on a few problems. The trials: the truth about each problem, then all
/// ladders, and all of them again as often as they are to be timed, so that what else the machine does hits all alike.
class WorkPrecision final : public FigureWork {
public:
    explicit WorkPrecision(FigureReader& reader) {
        std::string cost = "time";
        reader.chart.read_choice("cost", cost, costs);
        cost_ = cost == "time" ? Cost::time : Cost::evaluations;
        auto table = reader.table("work_precision");
        problems_ = read_problems(table);
        truths_ = std::make_unique<Truths>(problems_.all.size());
        table.read_whole("repeats", repeats_, 1, 99);
        table.read_whole("most_evaluations", most_evaluations_, 100, 1'000'000'000);
        table.read_positive("least_error", least_error_);
        read_contenders(table);
        for (const auto& peer : reader.peers) contenders_.push_back({Model::angles, "", &peer});
        table.finish();
        for (std::size_t p = 0; p < problems_.all.size(); ++p)
            for (const auto& contender : contenders_)
                if (contender.serves(problems_.all[p])) ladders_.push_back({p, contender});
        if (ladders_.empty())
            throw table.fault("models", "must name one that serves; {} takes \"mechanism\"", problems_.all[0].name);
    }

    std::size_t trials() const override {
        return problems_.all.size() + ladders_.size() * static_cast<std::size_t>(repeats());
    }
    bool measures_time() const override { return cost_ == Cost::time; }
    std::string unit() const override { return "ladders"; }
    double units(std::size_t trial) const override { return trial < problems_.all.size() ? 0 : 1; }

    void compute(std::size_t first, std::span<TrialNumbers> numbers, const std::atomic<bool>& stop) const override {
        for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = computed(first + i, stop);
    }

    bool fits(std::size_t trial, std::span<const double> numbers) const override {
        if (trial < problems_.all.size()) return numbers.size() == 2 && finite_or_none(numbers);
        return is_ladder(numbers);
    }

    std::vector<std::string> columns() const override {
        return {"problem",
                "model",
                "method",
                "setting",
                has_angles() ? "angle_error_rad" : "place_error",
                "energy_error",
                "length_error_m",
                "cpu_seconds",
                "evaluations",
                "steps"};
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (const auto& ladder : merged_ladders(numbers))
            for (const auto& rung : ladder.rungs) {
                table.add(problems_.all[ladder.problem].name);
                table.add(name_of(ladder.contender.model));
                table.add(ladder.contender.name());
                for (const double number : {rung.setting, rung.error, rung.energy_error, rung.length_error, rung.cpu_s})
                    table.add_or_empty(number);
                for (const double count : {rung.evaluations, rung.steps})
                    std::isfinite(count) ? table.add(std::lround(count)) : table.add_empty();
                table.end_row();
            }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        if (figure.subtitle.empty()) figure.subtitle = problems_.subtitle;
        const auto ladders = merged_ladders(numbers);
        for (std::size_t p = 0; p < problems_.all.size(); ++p)
            figure.panels.push_back(work_plot({p, problems_.all[p], 0x1p-53 * numbers[p][0], ladders, cost_}));
        const bool floors = std::any_of(figure.panels.begin(), figure.panels.end(),
                                        [](const Plot& plot) { return !plot.rules.empty(); });
        figure.captions.push_back(legend_words(floors));
        if (const auto words = winner_words(ladders); !words.empty())
            figure.captions.push_back(
                fmt::format("The least {}: {}.", cost_ == Cost::time ? "time, µs" : "evaluations", words));
        if (const auto words = peer_words(ladders); !words.empty())
            figure.captions.push_back(fmt::format("The best of the others takes so many times as much: {}.", words));
        if (cost_ == Cost::time) figure.captions.push_back(spread_words(ladders));
    }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        std::vector<Finding> all;
        const auto ladders = merged_ladders(numbers);
        for (std::size_t p = 0; p < problems_.all.size(); ++p) {
            const auto& name = problems_.all[p].name;
            all.push_back({name + "_sensitivity", numbers[p][0]});
            all.push_back({name + "_reference_disagreement", numbers[p][1]});
            for (const auto& accuracy : accuracies) add_findings(ladders, p, accuracy, all);
        }
        if (cost_ == Cost::evaluations) return all;
        const auto [typical, worst] = spread_of(ladders);
        all.push_back({"spread_typical", typical});
        all.push_back({"spread_worst", worst});
        return all;
    }

    std::string resolved() const override {
        std::vector<std::string> models, methods;
        for (const auto model : models_) models.push_back(toml_text(std::string(name_of(model))));
        for (const auto& method : methods_) methods.push_back(toml_text(method));
        return fmt::format(
            "\n[work_precision]\n{}models = [{}]\nmethods = [{}]\nrepeats = {}\nmost_evaluations = {}\nleast_error = "
            "{}\n",
            problems_.resolved, fmt::join(models, ", "), fmt::join(methods, ", "), repeats_, most_evaluations_,
            least_error_);
    }

    std::string resolved_chart() const override {
        return fmt::format("cost = \"{}\"\n", costs[cost_ == Cost::time ? 0 : 1]);
    }

private:
    int repeats() const { return cost_ == Cost::time ? repeats_ : 1; }
    bool has_angles() const { return problems_.all.front().side.has_angles; }

    void read_contenders(TomlReader& table) {
        if (const auto names = table.read_texts("models")) {
            models_.clear();
            for (const auto& name : *names) {
                const auto found = std::find_if(all_models.begin(), all_models.end(),
                                                [&](Model model) { return name_of(model) == name; });
                if (found == all_models.end())
                    throw table.fault("models", "are of angles, constraints, mechanism; \"{}\" is not", name);
                models_.push_back(*found);
            }
        }
        if (const auto names = table.read_texts("methods"))
            methods_ = *names;
        else
            for (const auto& method : methods()) methods_.emplace_back(method.name);
        for (const auto& name : methods_)
            if (!find_method(name))
                throw table.fault("methods", "must be names of methods (doppel list methods); \"{}\" is not", name);
        check_distinct(table, "methods", methods_);
        for (const auto model : models_)
            for (const auto& name : methods_) {
                const auto& method = *find_method(name);
                const bool serves = model == Model::angles        ? method.angles
                                    : model == Model::constraints ? method.constraints
                                                                  : method.mechanism;
                if (serves) contenders_.push_back({model, name});
            }
        if (contenders_.empty())
            throw table.fault(table.has("methods") ? "methods" : "models",
                              "must leave a method with a model that it serves");
    }

    TrialNumbers computed(std::size_t trial, const std::atomic<bool>& stop) const {
        const std::size_t problems = problems_.all.size();
        const std::size_t ladder = trial < problems ? 0 : (trial - problems) % ladders_.size();
        const std::size_t p = trial < problems ? trial : ladders_[ladder].first;
        const auto& problem = problems_.all[p];
        const auto& truth = truths_->of(p, problem, stop);
        if (trial < problems) return {truth.sensitivity, truth.reference.disagreement};
        const bool first = trial - problems < ladders_.size();
        return flattened(climb(problem, truth, ladders_[ladder].second,
                               {most_evaluations_, least_error_, cost_ == Cost::time, first}, stop));
    }

    std::vector<Ladder> merged_ladders(std::span<const TrialNumbers> numbers) const {
        std::vector<Ladder> all;
        for (std::size_t i = 0; i < ladders_.size(); ++i) {
            std::vector<std::vector<Rung>> repeats;
            for (std::size_t trial = problems_.all.size() + i; trial < numbers.size(); trial += ladders_.size())
                repeats.push_back(rungs_of(numbers[trial]));
            all.push_back(merged(ladders_[i].first, ladders_[i].second, repeats));
        }
        return all;
    }

    void add_findings(const std::vector<Ladder>& ladders, std::size_t p, const Accuracy& accuracy,
                      std::vector<Finding>& all) const {
        const auto key = fmt::format("{}_{}_", problems_.all[p].name, accuracy.key);
        const auto* best = cheapest(p, ladders, cost_, accuracy.error, false);
        const auto* peer = cheapest(p, ladders, cost_, accuracy.error, true);
        const auto words = [](const Ladder& l) {
            return l.contender.peer ? l.contender.peer->name
                                    : fmt::format("{}, {}", l.contender.method, name_of(l.contender.model));
        };
        if (best) {
            all.push_back({key + "best", words(*best)});
            all.push_back({key + "cost", *cost_at(*best, cost_, accuracy.error)});
        }
        if (peer) {
            all.push_back({key + "best_peer", words(*peer)});
            all.push_back({key + "peer_cost", *cost_at(*peer, cost_, accuracy.error)});
        }
        if (best && peer)
            all.push_back(
                {key + "peer_ratio", *cost_at(*peer, cost_, accuracy.error) / *cost_at(*best, cost_, accuracy.error)});
    }

    std::string legend_words(bool floors) const {
        return fmt::format(
            "Each method by its best model on the problem, its other models faint; the pale band is the front: no "
            "method "
            "here errs less at less cost.{}{} Errors are those of the worst {} against Taylor series in quad, {}, "
            "which "
            "agree.",
            contenders_.back().peer ? " In grey, methods of other libraries." : "",
            floors ? " Dashed across: the rounding of a double, and what the motion makes of it." : "",
            has_angles() ? "angle" : "place, as a part of the mechanism's size,",
            problems_.all.front().plain ? "in angles and as particles on rods" : "at two tolerances");
    }

    /// The cheapest at each accuracy, a problem after the other.
    std::string winner_words(const std::vector<Ladder>& ladders) const {
        std::string words;
        for (const auto& accuracy : accuracies) {
            std::vector<std::string> winners;
            std::string last;
            for (std::size_t p = 0; p < problems_.all.size(); ++p) {
                const auto* best = cheapest(p, ladders, cost_, accuracy.error, false);
                if (!best) continue;
                const auto& method = best->contender.method;
                winners.push_back((method == last ? "" : method + " ") +
                                  cost_words(*cost_at(*best, cost_, accuracy.error)));
                last = method;
            }
            if (winners.empty()) continue;
            words += fmt::format("{}{} by {}", words.empty() ? "" : "; ", accuracy.words, fmt::join(winners, ", "));
        }
        return words;
    }

    /// How many times as long the best of the peers takes, at each accuracy a problem after the other; empty without
    /// any.
    std::string peer_words(const std::vector<Ladder>& ladders) const {
        std::string words;
        for (const auto& accuracy : accuracies) {
            std::vector<std::string> ratios;
            for (std::size_t p = 0; p < problems_.all.size(); ++p) {
                const auto* ours = cheapest(p, ladders, cost_, accuracy.error, false);
                const auto* peer = cheapest(p, ladders, cost_, accuracy.error, true);
                if (ours && peer)
                    ratios.push_back(fmt::format(
                        "{:.1f}", *cost_at(*peer, cost_, accuracy.error) / *cost_at(*ours, cost_, accuracy.error)));
            }
            if (!ratios.empty())
                words += fmt::format("{}{} at {}", words.empty() ? "" : "; ", fmt::join(ratios, ", "), accuracy.words);
        }
        return words;
    }

    std::string cost_words(double cost) const {
        const double number = cost_ == Cost::time ? 1e6 * cost : cost;
        return number < 1000 ? fmt::format("{:.3g}", number) : grouped(std::lround(number));
    }

    /// Typical and worst spread of the times that are shown.
    static std::pair<double, double> spread_of(const std::vector<Ladder>& ladders) {
        std::vector<double> all;
        for (const auto& ladder : ladders)
            for (const std::size_t i : useful_rungs(ladder, Cost::time, {0, 1})) all.push_back(ladder.spread[i]);
        if (all.empty()) return {nan_value, nan_value};
        std::sort(all.begin(), all.end());
        return {all[all.size() / 2], all.back()};
    }

    std::string spread_words(const std::vector<Ladder>& ladders) const {
        const auto [typical, worst] = spread_of(ladders);
        return fmt::format(
            "CPU time of one thread, warm, the median of {}; half of them lie within ± {:.1f} % of it, at worst within "
            "± "
            "{:.0f} %, shown as bars.",
            repeats_, 100 * typical, 100 * worst);
    }

    Cost cost_;
    WorkProblems problems_;
    std::unique_ptr<Truths> truths_;
    int repeats_ = 5, most_evaluations_ = 300'000;
    double least_error_ = 1e-16;
    std::vector<Model> models_{all_models.begin(), all_models.end()};
    std::vector<std::string> methods_;
    std::vector<Contender> contenders_;
    std::vector<std::pair<std::size_t, Contender>> ladders_;  // of a problem each
};

}  // namespace

std::shared_ptr<const FigureWork> read_work_precision(FigureReader& reader) {
    return std::make_shared<WorkPrecision>(reader);
}

}  // namespace doppel
