#include "figure/parameter.hpp"
#include "figure/quantity.hpp"
#include "figure/spacing.hpp"
#include "scene/method_choice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace doppel {
namespace {

/// A quantity of pairs, and the Lyapunov exponent beside it, over a range of one parameter.
class Sweep final : public Experiment {
public:
    static constexpr std::string_view table_key = "sweep";
    Sweep() = default;
    explicit Sweep(FigureReader& reader) : pair_(reader.pair()) {
        auto table = reader.settings(*this);
        parameter_ = parameter_of(reader, table, "parameter", parameter_name_, pair_);
        check_range(table);
        settings_ = resolved_pair(pair_) + table.finish();
        if (!parameter_.is_of_method) step_all_alike(pair_, twins(0), reader.stop);
        const auto first = twins(0);
        measurements_.emplace_back(table, "quantity", quantity_, first, parameter_.keeps_method, exponent_duration_s_);
        if (exponent_ && quantity_ != Quantity::exponent)
            measurements_.emplace_back(table, "exponent", Quantity::exponent, first, parameter_.keeps_method,
                                       exponent_duration_s_);
        demand_apart(table, quantity_, parameter_, difference_, {make_scene(first), make_scene(twins(trials_ - 1))});
        subtitle_ = varied_subtitle(pair_, std::array{&std::as_const(parameter_)}, std::array{value(0)}, difference_,
                                    measurements_.front().words());
    }

    template <class Visit>
    void fields(Visit& visit) {
        visit(parameter_field("parameter", parameter_help), parameter_name_);
        visit({"from", "the first value"}, from_);
        visit({"to", "the last"}, to_);
        visit({"spacing", spacing_help}, spacing_);
        visit({"points", "how many values", "", from_to(2, most_trials), "as `step` says"}, points_);
        const Only of_steps{!points_ && spacing_ == Spacing::linear, "is for even values; give it, or points",
                            visit.from_command_line("points") || visit.from_command_line("spacing")};
        visit({"step", "between two values; from `from` to `to` a whole number of them", "", positive, "", of_steps},
              step_);
        visit({"difference", "of the parameter between the two of a pair"}, difference_);
        visit({"quantity", quantity_help}, quantity_);
        visit({"exponent", "the largest Lyapunov exponent of side a as well"}, exponent_);
        visit({"exponent_duration_s",
               "of the motion that an exponent is found by",
               "s",
               positive,
               "",
               {.holds = exponent_ || quantity_ == Quantity::exponent, .hides = true}},
              exponent_duration_s_);
    }

    std::size_t trials() const override { return trials_; }
    std::size_t together() const override { return measurements_.front().together(difference_ == step_ && !points_); }
    std::string unit() const override { return "pairs"; }
    std::string subtitle() const override { return subtitle_; }

    void compute(std::size_t first, std::span<TrialNumbers> numbers, const std::atomic<bool>& stop) const override {
        std::vector<Preset> pairs;
        for (std::size_t i = 0; i < numbers.size(); ++i) pairs.push_back(twins(first + i));
        for (const auto& measurement : measurements_) measurement.append(pairs, numbers, stop);
    }

    bool fits(std::size_t /*trial*/, std::span<const double> numbers) const override {
        const std::size_t first = measurements_.front().numbers();
        return numbers.size() >= first && measurements_.front().fits(numbers.first(first)) &&
               (measurements_.size() == 1 ? numbers.size() == first
                                          : measurements_.back().fits(numbers.subspan(first)));
    }

    std::vector<std::string> columns() const override {
        std::vector<std::string> names{parameter_.name};
        for (const auto& measurement : measurements_)
            names.insert(names.end(), measurement.words().columns.begin(), measurement.words().columns.end());
        return names;
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (std::size_t i = 0; i < trials_; ++i) {
            table.add(static_cast<double>(value(i)));
            for (const double number : numbers[i]) table.add_or_empty(std::isfinite(number) ? number : NAN);
            table.end_row();
        }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        Plot plot;
        plot.x = {.label = parameter_.label,
                  .low = static_cast<double>(from_),
                  .high = static_cast<double>(to_),
                  .logarithmic = spacing_ == Spacing::logarithmic};
        if (parameter_.every > 0) plot.x.every = parameter_.every;
        std::size_t column = 0;
        for (const auto& measurement : measurements_) {
            const auto& words = measurement.words();
            const bool is_first = &measurement == &measurements_.front();
            (is_first ? plot.y : plot.right.emplace()) = {.label = words.label, .logarithmic = words.logarithmic};
            auto drawn = curve(numbers, column);
            if (measurements_.size() > 1) drawn.label = is_first ? label_of_first() : "Lyapunov exponent";
            drawn.right = !is_first;
            drawn.hue = is_first ? 0 : 1;
            if (measurement.numbers() > 1) {
                drawn.uncertainty = curve(numbers, column + 1).y;
                figure.captions.push_back(exponent_words(drawn, curve(numbers, column + 2).y));
            }
            plot.curves.push_back(std::move(drawn));
            column += measurement.numbers();
        }
        figure.panels.push_back(std::move(plot));
    }

    std::optional<std::string> nothing_to_draw(std::span<const TrialNumbers> numbers) const override {
        if (measurements_.size() > 1) return std::nullopt;
        Drawn drawn;
        for (const auto& trial : numbers) drawn.add(trial[0]);
        return nothing_drawn(quantity_, measurements_.front().words(), drawn, fmt::format("{}", trials_),
                             pair_.duration_s.text());
    }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        const auto& column = measurements_.front().words().columns.front();
        double least = NAN, most = NAN, regular = 0;
        for (const auto& trial : numbers) {
            if (std::isinf(trial[0])) continue;
            least = std::fmin(least, trial[0]);
            most = std::fmax(most, trial[0]);
            if (measurements_.back().numbers() > 1)
                regular += is_regular({trial[trial.size() - 3], trial[trial.size() - 2]});
        }
        std::vector<Finding> all{{"least_" + column, least}, {"greatest_" + column, most}};
        if (const auto missing = without(numbers); missing > 0)
            all.push_back({measurements_.front().words().none_is_bad ? "trials_broken_down" : "trials_without",
                           static_cast<double>(missing)});
        if (measurements_.back().numbers() > 1) all.push_back({"regular_trials", regular});
        return all;
    }

private:
    static constexpr int most_trials = 10'000'000;

    /// Finds the number of trials.
    void check_range(const TomlReader& table) {
        if (to_ < from_) throw table.fault("to", "must not be below from ({}); it is {}", text_of(from_), text_of(to_));
        if (spacing_ == Spacing::logarithmic && !points_)
            throw table.fault("spacing", "\"logarithmic\" takes points, the number of values");
        if (spacing_ == Spacing::logarithmic && !(from_ > 0))
            throw table.fault("from", "must be > 0 for equal ratios; it is {}", text_of(from_));
        if (parameter_.is_of_one_side && difference_ != 0)
            throw table.fault("difference", "must be 0 for {}, which both sides do not differ in", parameter_.name);
        for (const auto& [key, end] : {std::pair{"from", from_},
                                       {"to", to_},
                                       {"difference", Quad(from_ + difference_)},
                                       {"difference", Quad(to_ + difference_)}})
            parameter_.demand(table, key, end);
        if (points_) {
            trials_ = static_cast<std::size_t>(*points_);
            return;
        }
        const Quad steps = (to_ - from_) / step_;
        if (!(steps < most_trials))
            throw table.fault("to", "must be at most {} steps from \"from\"; it is {}", most_trials, text_of(to_));
        const long whole = std::lround(static_cast<double>(steps));
        constexpr double slack = 1e-12;  // of decimals that are no whole number of steps by rounding alone
        if (std::abs(static_cast<double>(steps - Quad(static_cast<double>(whole)))) > slack)
            throw table.fault("step", "must divide the way from {} to {}; it is {}", text_of(from_), text_of(to_),
                              text_of(step_));
        if (parameter_.is_whole && step_ != round(step_))
            throw table.fault("step", "must be a whole number, as {} is; it is {}", parameter_.name, text_of(step_));
        trials_ = static_cast<std::size_t>(whole) + 1;
    }

    Quad value(std::size_t trial) const {
        const Quad number(static_cast<double>(trial));
        if (!points_) return parameter_.taken(from_ + step_ * number);
        if (trial + 1 == trials_) return parameter_.taken(to_);
        const Quad share = number / Quad(static_cast<double>(trials_ - 1));
        if (spacing_ == Spacing::linear) return parameter_.taken(from_ + (to_ - from_) * share);
        const double ratio = static_cast<double>(Quad(to_ / from_));
        return parameter_.taken(from_ * Quad(std::pow(ratio, static_cast<double>(share))));
    }

    Preset twins(std::size_t trial) const {
        auto pair = pair_;
        parameter_.set(pair, value(trial), difference_);
        return pair;
    }

    /// How many pairs have no such number. Of two that are one there is no ratio to their first distance: it is not
    /// missing.
    std::size_t without(std::span<const TrialNumbers> numbers) const {
        std::size_t missing = 0;
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            if (std::isfinite(numbers[i][0])) continue;
            const auto pair = twins(i);
            missing += quantity_ != Quantity::divergence || !released_alike(pair.a, pair.b);
        }
        return missing;
    }

    std::string label_of_first() const {
        if (quantity_ == Quantity::divergence) return "average of ln(d/d₀)";
        const auto& label = measurements_.front().words().label;
        return label.substr(0, label.rfind(", "));
    }

    /// Counts the regular releases, and takes equilibria out of the curve: their exponent is not that of a motion.
    std::string exponent_words(Curve& exponents, const std::vector<double>& unsettled) const {
        long regular = 0, changing = 0;
        bool contracts = false;
        std::string equilibria;
        for (std::size_t i = 0; i < trials_; ++i) {
            const double exponent = exponents.y[i], uncertainty = exponents.uncertainty[i];
            regular += is_regular({exponent, uncertainty});
            changing += !is_regular({exponent, uncertainty}) && unsettled[i] != 0;
            contracts = contracts || exponent < -1.5 * uncertainty;
            if (exponent == 0 || uncertainty != 0) continue;
            equilibria += fmt::format(" At {:g}{}, {} equilibrium, it is {:.2f} 1/s.", exponents.x[i],
                                      parameter_.angle ? "°" : "", exponent > 0 ? "an unstable" : "a stable", exponent);
            exponents.y[i] = NAN;
        }
        return fmt::format("{} of {} releases are {}. Its band holds two of three runs four times as long{}.{}",
                           regular, trials_,
                           contracts ? "regular or settle: their exponent is not above 0"
                                     : "regular: their exponent cannot be told from 0",
                           changing == 0 ? ""
                                         : fmt::format(", but not for {} whose stretches differ by more than chance (a "
                                                       "transient, or orbits that stick): there it is too narrow",
                                                       changing),
                           equilibria);
    }

    Curve curve(std::span<const TrialNumbers> numbers, std::size_t column) const {
        Curve made;
        for (std::size_t i = 0; i < trials_; ++i) add_point(made, static_cast<double>(value(i)), numbers[i][column]);
        return made;
    }

    Preset pair_;
    std::string parameter_name_ = "theta1_deg";
    Parameter parameter_;
    Quad from_ = 0, to_ = 180, step_ = 1, difference_ = 0;
    Spacing spacing_ = Spacing::linear;
    std::optional<int> points_;
    Quantity quantity_ = Quantity::divergence;
    std::size_t trials_ = 0;
    bool exponent_ = false;
    double exponent_duration_s_ = ExponentSpec{}.duration_s;
    std::vector<Measurement> measurements_;  // of the quantity, and of the exponent where it is asked for besides
    std::string subtitle_;
};

}  // namespace

const FigureKind sweep_kind = kind_of<Sweep>("sweep", FigureKind::System::pair);

}  // namespace doppel
