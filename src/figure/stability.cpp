#include "analysis/linear_stability.hpp"
#include "figure/stability_spec.hpp"
#include "numeric/nan.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace doppel {
namespace {

/// How well each method keeps energy, over its step or tolerance and a parameter of the release: where it blows up, and
/// where linear theory says that it must. A trial is a column of one method's map: all releases at one step.
class Stability final : public FigureWork {
public:
    explicit Stability(FigureReader& reader) : spec_(read_stability_spec(reader)) {}

    std::size_t trials() const override { return spec_.methods.size() * columns_; }
    std::string unit() const override { return "releases"; }
    double units(std::size_t) const override { return spec_.rows.count; }

    void compute(std::size_t first, std::span<TrialNumbers> numbers, const std::atomic<bool>& stop) const override {
        for (std::size_t i = 0; i < numbers.size(); ++i)
            numbers[i] = greatest_energy_errors(run_of(first + i), spec_.releases, stop);
    }

    bool fits(std::size_t /*trial*/, std::span<const double> numbers) const override {
        // an error, or none for a blow-up
        return numbers.size() == spec_.releases.size() &&
               std::none_of(numbers.begin(), numbers.end(), [](double x) { return x < 0 || x > blow_up; });
    }

    std::vector<std::string> columns() const override {
        return {"method", "step_s", "tolerance", std::string(spec_.parameter->name), "energy_error"};
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (std::size_t trial = 0; trial < numbers.size(); ++trial)
            for (int row = 0; row < spec_.rows.count; ++row) {
                table.add(method_of(trial).name);
                table.add_or_empty(method_of(trial).adaptive ? nan_value : pace_of(trial));
                table.add_or_empty(method_of(trial).adaptive ? pace_of(trial) : nan_value);
                table.add(spec_.rows.middle(row));
                table.add_or_empty(numbers[trial][static_cast<std::size_t>(row)]);
                table.end_row();
            }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        constexpr std::size_t many = 8, side_by_side = 4;
        if (spec_.methods.size() > many) figure.columns = side_by_side;
        for (std::size_t m = 0; m < spec_.methods.size(); ++m) {
            const auto& method = *spec_.methods[m];
            const auto &cells = spec_.columns_of(method), &rows = spec_.rows;
            Plot plot{.title = std::string(method.name)};
            plot.x = {.label = method.adaptive ? "tolerance" : "step, s",
                      .low = cells.from,
                      .high = cells.to,
                      .logarithmic = true};
            plot.y = {.low = rows.from, .high = rows.to, .logarithmic = rows.logarithmic};
            // named once a line
            if (figure.columns == 0 || m % side_by_side == 0) plot.y.label = std::string(spec_.parameter->label);
            if (spec_.parameter->every > 0) plot.y.every = spec_.parameter->every;
            plot.map = map_of(numbers, m);
            if (!method.adaptive) draw_limit(method.name, plot);
            figure.panels.push_back(std::move(plot));
        }
        figure.captions.push_back(fmt::format(
            "Dashed: the step at which linear theory has small oscillations gain {:g} times their energy in {:g} s; "
            "Gauss collocation has none. A blow-up: an error beyond {:g} times the energy released, a number that is "
            "none, or a method that gives up, as gauss and rattle do where they do not find their stages or "
            "multipliers.",
            blow_up, spec_.duration.value(), blow_up));
    }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        std::vector<Finding> all;
        for (std::size_t m = 0; m < spec_.methods.size(); ++m) {
            const auto& method = *spec_.methods[m];
            double blown = 0, least = nan_value;
            for (std::size_t trial = m * columns_; trial < (m + 1) * columns_; ++trial) {
                for (const double error : numbers[trial]) blown += std::isnan(error);
                if (std::isnan(numbers[trial].front())) least = std::fmin(least, pace_of(trial));
            }
            const double cells = static_cast<double>(columns_ * spec_.releases.size());
            all.push_back({fmt::format("share_blown_up_{}", method.name), blown / cells});
            // of the lowest row
            all.push_back({fmt::format("first_blow_up_{}", method.name), least});
            if (method.adaptive) continue;
            all.push_back({fmt::format("linear_limit_s_{}", method.name), limit_at(method.name, 0)});
        }
        return all;
    }

    std::string resolved() const override { return spec_.resolved(); }

private:
    const MethodEntry& method_of(std::size_t trial) const { return *spec_.methods[trial / columns_]; }
    StabilityRun run_of(std::size_t trial) const {
        return spec_.run(method_of(trial), static_cast<int>(trial % columns_));
    }
    /// The step, s, or the tolerance.
    double pace_of(std::size_t trial) const {
        const auto run = run_of(trial);
        return method_of(trial).adaptive ? static_cast<double>(run.tolerance) : run.step();
    }

    HeatMap map_of(std::span<const TrialNumbers> numbers, std::size_t method) const {
        const auto& cells = spec_.columns_of(*spec_.methods[method]);
        HeatMap map{
            .columns = columns_,
            .rows = spec_.releases.size(),
            .x_low = cells.from,
            .x_high = cells.to,
            .y_low = spec_.rows.from,
            .y_high = spec_.rows.to,
            .label = fmt::format("greatest energy error in {:g} s, of the energy released", spec_.duration.value()),
            .none_label = "blow-up",
            .none_is_bad = true,
            .low = least_shown,
            .high = blow_up,
            .logarithmic = true,
            .shares_bar = spec_.methods.size() > 1};
        for (std::size_t row = 0; row < map.rows; ++row)
            for (std::size_t column = 0; column < map.columns; ++column) {
                const double error = numbers[method * columns_ + column][row];
                // no error at all is as small as any
                map.values.push_back(static_cast<float>(error < least_shown ? least_shown : error));
            }
        return map;
    }

    /// Where linear theory has a row blow up, s; not a number where nowhere.
    double limit_at(std::string_view method, std::size_t row) const {
        const auto modes = small_oscillations(spec_.releases[row].cast<double>());
        return step_limit(method, modes, spec_.duration.value(), blow_up).value_or(nan_value);
    }

    /// A rule where it is the same for all rows, else a curve.
    void draw_limit(std::string_view method, Plot& plot) const {
        Curve curve{.label = "linear limit", .dashed = true, .quiet = true};
        for (std::size_t row = 0; row < spec_.releases.size(); ++row) {
            curve.x.push_back(limit_at(method, row));
            curve.y.push_back(spec_.rows.middle(static_cast<int>(row)));
        }
        const auto [least, most] = std::minmax_element(curve.x.begin(), curve.x.end());
        constexpr double alike = 1e-4;
        if (std::isnan(*least)) return;
        if (*most < *least * (1 + alike)) {
            plot.rules.push_back({Rule::Way::vertical, *least, fmt::format("limit {:.3g} s", *least)});
            return;
        }
        curve.y.front() = spec_.rows.from;
        curve.y.back() = spec_.rows.to;
        plot.curves.push_back(std::move(curve));
    }

    static constexpr double least_shown = 1e-12;

    StabilitySpec spec_;
    std::size_t columns_ = static_cast<std::size_t>(spec_.steps.count);
};

}  // namespace

std::shared_ptr<const FigureWork> read_stability(FigureReader& reader) {
    return std::make_shared<Stability>(reader);
}

}  // namespace doppel
