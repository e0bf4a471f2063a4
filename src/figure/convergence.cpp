#include "figure/kinds.hpp"
#include "integrate/methods.hpp"
#include "scene/captions.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace doppel {
namespace {

/// One of the ladders: the methods of both sides, and the precision.
struct PairLadder {
    std::string method_a, method_b;
    Precision precision;
    std::size_t rungs;

    std::string name() const { return method_a == method_b ? method_a : method_a + "/" + method_b; }
    bool adaptive() const { return find_method(method_a)->adaptive; }
};

/// The numbers of a trial; distance and step NaN where the run broke down.
struct RungRow {
    double step, distance, steps;
};

/// The distance of the two sides of a pair over finer and finer steps, in double and in quad.
class Convergence final : public Experiment {
public:
    static constexpr std::string_view table_key = "convergence";
    Convergence() = default;
    explicit Convergence(FigureReader& reader) : pair_(reader.pair()) {
        auto table = reader.settings(*this);
        if (methods_.empty()) throw table.fault("methods", "must name at least one");
        check_distinct(table, "methods", methods_);
        for (const auto precision : {Precision::in_double, Precision::in_quad})
            for (const auto& name : methods_) add_ladder(table, name, precision);
        bool differ = false;
        for (const auto& [begin, ladder] : ladders_) {
            const auto scene = make_scene(pair_of(begin));
            check_methods(table, scene);
            differ |= !are_one(scene);
        }
        if (!differ)
            throw table.fault("methods",
                              "step two sides that are the same; let [b] differ from [a], or name methods "
                              "\"one/other\" for the two");
        settings_ = resolved_pair(pair_) + table.finish();
    }

    template <class Visit>
    void fields(Visit& visit) {
        constexpr auto halvings = from_to(1, 20);
        visit({"halvings", "of the step in double; the coarsest is a sample's interval", "", halvings}, halvings_);
        visit({"quad_halvings", "the same in quad", "", halvings}, quad_halvings_);
        visit({"decades", "of the tolerance in double, from 1e-3 on", "", from_to(1, 14)}, decades_);
        visit({"quad_decades", "the same in quad", "", from_to(1, 29)}, quad_decades_);
        visit({"mark_step_s", "a step that a line marks", "s", positive}, mark_step_);
        visit({"methods", "names of methods, or \"one/other\" for the two sides"}, methods_);
    }

    std::size_t trials() const override { return ladders_.back().first + ladders_.back().second.rungs; }

    bool fits(std::size_t /*trial*/, std::span<const double> numbers) const override {
        if (numbers.size() != numbers_in<RungRow>) return false;
        const auto [step, distance, steps] = row_of<RungRow>(numbers);
        return is_count(steps) && (all_finite(numbers) || (std::isnan(step) && std::isnan(distance)));
    }

    std::vector<std::string> columns() const override { return {"method", "precision", "step_s", "distance", "steps"}; }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (const auto& [begin, ladder] : ladders_)
            for (std::size_t rung = 0; rung < ladder.rungs; ++rung) {
                const auto [step, distance, steps] = row_of<RungRow>(numbers[begin + rung]);
                add_row(table, ladder.name(), ladder.precision == Precision::in_double ? "double" : "quad", step,
                        distance, steps);
            }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        Plot plot;
        plot.x = {.label = "step, s (the mean, where a tolerance chooses it)", .logarithmic = true};
        plot.y = {.label = fmt::format("greatest distance within {} s", pair_.duration_s.value()), .logarithmic = true};
        for (const auto& [begin, ladder] : ladders_) {
            const bool in_double = ladder.precision == Precision::in_double;
            Curve curve{
                .label = in_double ? "" : ladder.name(),
                .mark = Mark::both,
                .hue = static_cast<int>(std::find(methods_.begin(), methods_.end(), ladder.name()) - methods_.begin()),
                .dashed = in_double};
            for (std::size_t rung = 0; rung < ladder.rungs; ++rung) {
                const auto row = row_of<RungRow>(numbers[begin + rung]);
                add_point(curve, row.step, row.distance);
            }
            plot.curves.push_back(std::move(curve));
        }
        if (mark_step_)
            plot.rules.push_back(
                {Rule::Orientation::vertical, mark_step_->value(), fmt::format("{} s", mark_step_->text())});
        figure.panels.push_back(std::move(plot));
        figure.captions.push_back(words(numbers));
    }

    std::optional<std::string> nothing_to_draw(std::span<const TrialNumbers> numbers) const override {
        if (std::any_of(numbers.begin(), numbers.end(),
                        [](const auto& trial) { return row_of<RungRow>(trial).distance > 0; }))
            return std::nullopt;
        return fmt::format(
            "the two sides never part, or every run broke down within {} s: there is no distance to draw",
            pair_.duration_s.value());
    }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        std::vector<Finding> all;
        double least_in_double = NAN, least_in_quad = NAN;
        for (const auto& [begin, ladder] : ladders_) {
            const bool in_double = ladder.precision == Precision::in_double;
            auto& least = in_double ? least_in_double : least_in_quad;
            for (std::size_t rung = 0; rung < ladder.rungs; ++rung)
                least = std::fmin(least, row_of<RungRow>(numbers[begin + rung]).distance);
            if (!in_double) all.push_back({"slope_" + ladder.name(), slope(numbers, begin, ladder)});
        }
        all.push_back({"least_distance_in_double", least_in_double});
        all.push_back({"least_distance_in_quad", least_in_quad});
        return all;
    }

private:
    /// The order of convergence: with steps between the two finest, with tolerances over the middle third.
    static double slope(std::span<const TrialNumbers> numbers, std::size_t begin, const PairLadder& ladder) {
        const std::size_t fine_rung = ladder.adaptive() ? 2 * ladder.rungs / 3 : ladder.rungs - 1;
        const auto fine = row_of<RungRow>(numbers[begin + fine_rung]);
        const auto coarse = row_of<RungRow>(numbers[begin + (ladder.adaptive() ? ladder.rungs / 3 : ladder.rungs - 2)]);
        return std::log(coarse.distance / fine.distance) / std::log(coarse.step / fine.step);
    }

    /// The caption.
    std::string words(std::span<const TrialNumbers> numbers) const {
        std::string slopes;
        double least_double = NAN, least_quad = NAN;
        for (const auto& finding : findings(numbers)) {
            const double value = std::get<double>(finding.value);
            if (finding.key == "least_distance_in_double") least_double = value;
            if (finding.key == "least_distance_in_quad") least_quad = value;
            if (const std::string_view start = "slope_"; finding.key.starts_with(start) && value < steepest)
                slopes +=
                    fmt::format("{}{} {:.2f}", slopes.empty() ? "" : ", ", finding.key.substr(start.size()), value);
        }
        return fmt::format(
            "The distance falls by the power of each method's order; slopes in quad: {}. The least is {} in double and "
            "{} in quad.",
            slopes, scientific(least_double), scientific(least_quad));
    }

    void add_ladder(TomlReader& table, const std::string& name, Precision precision) {
        const auto slash = name.find('/');
        PairLadder ladder{name.substr(0, slash), slash == std::string::npos ? name : name.substr(slash + 1), precision,
                          0};
        const auto *a = find_method(ladder.method_a), *b = find_method(ladder.method_b);
        if (!a || !b || a->adaptive != b->adaptive)
            throw table.fault("methods",
                              "must be names of methods (doppel list methods), or \"one/other\" for the two "
                              "sides, both with steps or both with a tolerance; \"{}\" is not",
                              name);
        const bool in_double = precision == Precision::in_double;
        ladder.rungs = static_cast<std::size_t>(a->adaptive ? in_double ? decades_ : quad_decades_
                                                            : (in_double ? halvings_ : quad_halvings_) + 1);
        ladders_.emplace_back(ladders_.empty() ? 0 : trials(), ladder);
    }

    static void check_methods(const TomlReader& table, const Scene& scene) {
        for (const auto* side : {&scene.a, &scene.b})
            if (!serves(side->method, side->motion.model))
                throw table.fault("methods", "must serve the sides' models; \"{}\" does not serve {}",
                                  side->method.name, name_of(side->motion.model));
    }

    /// The pair at one rung: the sample's interval halved again and again, or the tolerance a tenth each time.
    Preset pair_of(std::size_t trial) const {
        const auto [ladder, rung] = place_of(trial);
        auto pair = pair_;
        pair.a.integrator = ladder.method_a;
        pair.b.integrator = ladder.method_b;
        for (auto* side : {&pair.a, &pair.b}) {
            side->precision = ladder.precision;
            side->step_s.reset();
            side->tolerance.reset();
            side->accuracy.reset();
            if (ladder.adaptive()) {
                side->tolerance = Quad(1);
                for (std::size_t i = 0; i < rung + first_decade; ++i) *side->tolerance /= 10;
            } else {
                side->step_s = *quotient({1, std::int64_t{1} << rung}, pair.sample_hz);
            }
        }
        return pair;
    }

    std::pair<PairLadder, std::size_t> place_of(std::size_t trial) const {
        const auto next =
            std::find_if(ladders_.begin(), ladders_.end(), [&](const auto& l) { return l.first > trial; });
        const auto& [begin, ladder] = *std::prev(next);
        return {ladder, trial - begin};
    }

    TrialNumbers compute_trial(std::size_t trial, const std::atomic<bool>& stop) const override {
        const auto scene = make_scene(pair_of(trial));
        PairRun run(scene);
        double most = 0;
        try {
            for (long n = 0; n <= scene.samples; ++n) most = std::fmax(most, run.next(stop).distance);
        } catch (const BreakDown&) {
            return numbers_of(RungRow{NAN, NAN, 0});
        }
        const auto steps = static_cast<double>(run.effort_a().steps + run.effort_b().steps);
        return numbers_of(RungRow{2 * pair_.duration_s.value() / steps, most, steps});
    }

    static constexpr std::size_t first_decade = 3;
    static constexpr double steepest = 15;  // a slope beyond is that of a method without an order of its own

    Preset pair_;
    std::vector<std::string> methods_{"euler", "midpoint", "rk4", "gauss6/rattle6", "dop853"};
    int halvings_ = 10, quad_halvings_ = 6, decades_ = 11, quad_decades_ = 24;
    std::optional<Rational> mark_step_;                        // marked by a line
    std::vector<std::pair<std::size_t, PairLadder>> ladders_;  // each with its first trial
};

}  // namespace

const FigureKind convergence_kind = kind_of<Convergence>("convergence", FigureKind::System::pair);

}  // namespace doppel
