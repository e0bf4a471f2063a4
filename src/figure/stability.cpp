#include "analysis/energy_stability.hpp"
#include "analysis/linear_stability.hpp"
#include "figure/kinds.hpp"
#include "numeric/nan.hpp"
#include "scene/resolved.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace doppel {
namespace {

/// Cells from `from` to `to`, evenly or in even ratios.
struct Cells {
    double from, to;
    int count;
    bool logarithmic;

    double middle(int cell) const {
        const double part = (cell + 0.5) / count;
        return logarithmic ? from * std::pow(to / from, part) : from + part * (to - from);
    }
};

/// The energy error of each method over its step or tolerance and a parameter of the release, and the limit of linear
/// theory. A trial is a column of one method's map: all releases at one step.
class Stability final : public FigureWork {
public:
    explicit Stability(FigureReader& reader) : release_(reader.release()) {
        auto table = reader.table("stability");
        read_rows(table);
        read_methods(table);
        read_columns(table);
        settings_ = table.finish();
        make_releases(reader.table("system"), table);
    }

    std::size_t trials() const override { return methods_.size() * columns_; }
    std::string unit() const override { return "releases"; }
    double units(std::size_t) const override { return rows_.count; }

    bool fits(std::size_t /*trial*/, std::span<const double> numbers) const override {
        // an error, or none for a blow-up
        return numbers.size() == releases_.size() &&
               std::none_of(numbers.begin(), numbers.end(), [](double x) { return x < 0 || x > blow_up; });
    }

    std::vector<std::string> columns() const override {
        return {"method", "step_s", "tolerance", std::string(parameter_->name), "energy_error"};
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (std::size_t trial = 0; trial < numbers.size(); ++trial) {
            const auto& method = method_of(trial);
            const double pace = pace_of(trial);
            for (int row = 0; row < rows_.count; ++row)
                add_row(table, method.name, method.adaptive ? nan_value : pace, method.adaptive ? pace : nan_value,
                        rows_.middle(row), numbers[trial][static_cast<std::size_t>(row)]);
        }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        constexpr std::size_t many = 8, side_by_side = 4;
        if (methods_.size() > many) figure.columns = side_by_side;
        for (std::size_t m = 0; m < methods_.size(); ++m) {
            const auto& method = *methods_[m];
            const auto &cells = columns_of(method), &rows = rows_;
            Plot plot{.title = std::string(method.name)};
            plot.x = {.label = method.adaptive ? "tolerance" : "step, s",
                      .low = cells.from,
                      .high = cells.to,
                      .logarithmic = true};
            plot.y = {.low = rows.from, .high = rows.to, .logarithmic = rows.logarithmic};
            if (figure.columns == 0 || m % side_by_side == 0) plot.y.label = std::string(parameter_->label);
            if (!rows.logarithmic) plot.y.every = 45;
            plot.map = map_of(numbers, m);
            if (!method.adaptive) draw_limit(method.name, plot);
            figure.panels.push_back(std::move(plot));
        }
        figure.captions.push_back(fmt::format(
            "Dashed: the step at which linear theory has small oscillations gain {:g} times their energy in {:g} s; "
            "Gauss collocation has none. A blow-up: an error beyond {:g} times the energy released, NaN, or a method "
            "that gives up, as gauss and rattle do where they do not find their stages or multipliers.",
            blow_up, duration_.value(), blow_up));
    }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        std::vector<Finding> all;
        for (std::size_t m = 0; m < methods_.size(); ++m) {
            const auto& method = *methods_[m];
            double blown = 0, least = nan_value;
            for (std::size_t trial = m * columns_; trial < (m + 1) * columns_; ++trial) {
                for (const double error : numbers[trial]) blown += std::isnan(error);
                if (std::isnan(numbers[trial].front())) least = std::fmin(least, pace_of(trial));
            }
            const double cells = static_cast<double>(columns_ * releases_.size());
            all.push_back({fmt::format("share_blown_up_{}", method.name), blown / cells});
            // of the lowest row
            all.push_back({fmt::format("first_blow_up_{}", method.name), least});
            if (method.adaptive) continue;
            all.push_back({fmt::format("linear_limit_s_{}", method.name), limit_at(method.name, 0)});
        }
        return all;
    }

    std::string resolved() const override { return resolved_release(release_) + settings_; }

private:
    void read_rows(SettingsReader& table) {
        constexpr std::array<std::string_view, 2> parameters{"theta1_deg", "mass_ratio"};
        parameter_ = &read_parameter(table, parameters);
        rows_.logarithmic = parameter_->is_ratio;
        if (rows_.logarithmic && release_.links() != 2)
            throw table.fault("parameter", "\"{}\" takes two links; [system] has {}", parameter_->name,
                              release_.links());
        const double most = rows_.logarithmic ? 1e6 : 180;
        rows_.from = rows_.logarithmic ? 0.01 : 0;
        rows_.to = rows_.logarithmic ? 10 : 180;
        table.read_number("from", rows_.from);
        table.read_number("to", rows_.to);
        if (!(rows_.logarithmic ? rows_.from > 0 : rows_.from >= 0))
            throw table.fault("from", "must be {} 0; it is {}", rows_.logarithmic ? ">" : "at least", rows_.from);
        if (!(rows_.to > rows_.from && rows_.to <= most))
            throw table.fault("to", "must be more than from = {} and at most {}; it is {}", rows_.from, most, rows_.to);
        table.read_whole("rows", rows_.count, 1, 10'000);
    }

    void read_methods(SettingsReader& table) {
        constexpr std::array<std::string_view, 3> models{"auto", "angles", "constraints"};
        table.read_choice("model", model_, models);
        std::vector<std::string> names;
        for (const bool adaptive : {false, true})
            for (const auto& method : doppel::methods())
                if (method.adaptive == adaptive && serves(method, model_of(method))) names.emplace_back(method.name);
        table.read_texts("methods", names);
        if (names.empty()) throw table.fault("methods", "must name at least one");
        for (const auto& name : names) {
            const auto* method = &method_named(table, name);
            if (!serves(*method, model_of(*method)))
                throw table.fault("methods", "must serve model = \"{}\"; \"{}\" does not", model_, name);
            methods_.push_back(method);
        }
        check_distinct(table, "methods", names);
    }

    /// The range of the methods that go by a tolerance, or of those that do not.
    void read_range(SettingsReader& table, bool adaptive, std::string_view from, std::string_view to, Cells& cells) {
        for (const auto key : {from, to})
            if (table.has(key) && !has(adaptive))
                throw table.fault(key, "is for methods {}, of which none is named",
                                  adaptive ? "that go by a tolerance" : "of fixed step");
        if (!has(adaptive)) return;
        table.read_positive(from, cells.from);
        table.read_positive(to, cells.to);
        if (!(cells.to > cells.from))
            throw table.fault(to, "must be more than {} = {}; it is {}", from, cells.from, cells.to);
    }

    void read_columns(SettingsReader& table) {
        table.read_positive_ratio("duration_s", duration_);
        read_range(table, false, "step_from_s", "step_to_s", steps_);
        read_range(table, true, "tolerance_from", "tolerance_to", tolerances_);
        table.read_whole("columns", steps_.count, 1, 10'000);
        tolerances_.count = steps_.count;
        columns_ = static_cast<std::size_t>(steps_.count);
        const double duration = duration_.value();
        constexpr double most_steps = 1e8, finest = 1e-15;
        if (steps_.to > duration)
            throw table.fault("step_to_s", "must be at most duration_s = {}; it is {}", duration, steps_.to);
        if (duration / steps_.from > most_steps)
            throw table.fault("step_from_s", "must leave at most {} steps; it is {}", most_steps, steps_.from);
        if (tolerances_.from < finest)
            throw table.fault("tolerance_from", "must be at least {}; it is {}", finest, tolerances_.from);
    }

    /// Errors are parts of the energy of a release, which must have some.
    void make_releases(const TomlReader& system, const TomlReader& table) {
        if (!(release_.gravity_m_per_s2 > 0))
            throw system.fault("gravity_m_per_s2", "must be > 0, for small oscillations; it is {}",
                               text_of(release_.gravity_m_per_s2));
        for (int row = 0; row < rows_.count; ++row) {
            auto side = release_;
            parameter_->set(side, Quad(rows_.middle(row)));
            auto p = chain_of(side);
            constexpr double least = 1e-10;
            if (!(released_energy(p.cast<double>()) > least * p.cast<double>().potential_range()))
                throw table.fault("parameter", "= \"{}\": at {} the pendulum hangs at rest, without energy to keep",
                                  parameter_->name, rows_.middle(row));
            releases_.push_back(std::move(p));
        }
    }

    Model model_of(const MethodEntry& method) const {
        return model_ == "angles" || (model_ == "auto" && method.angles) ? Model::angles : Model::constraints;
    }
    /// Whether there is a method that goes by a tolerance, or one that does not.
    bool has(bool adaptive) const {
        return std::any_of(methods_.begin(), methods_.end(),
                           [&](auto* method) { return method->adaptive == adaptive; });
    }
    const Cells& columns_of(const MethodEntry& method) const { return method.adaptive ? tolerances_ : steps_; }

    TrialNumbers compute_trial(std::size_t trial, const std::atomic<bool>& stop) const override {
        return greatest_energy_errors(run_of(trial), releases_, stop);
    }

    const MethodEntry& method_of(std::size_t trial) const { return *methods_[trial / columns_]; }
    /// How a method steps all releases in a column of its map.
    StabilityRun run_of(std::size_t trial) const {
        const auto& method = method_of(trial);
        StabilityRun run{.method = std::string(method.name), .model = model_of(method), .duration = duration_};
        const double pace = columns_of(method).middle(static_cast<int>(trial % columns_));
        if (method.adaptive) {
            run.tolerance = Quad(pace);
            return run;
        }
        // whole steps to a sample, whole samples to the duration
        const double whole = duration_.value() / pace;
        run.steps_per_sample = std::max(1L, static_cast<long>(std::ceil(whole / static_cast<double>(run.samples))));
        run.samples = std::max(1L, std::lround(whole / static_cast<double>(run.steps_per_sample)));
        return run;
    }
    /// The step, s, or the tolerance.
    double pace_of(std::size_t trial) const {
        const auto run = run_of(trial);
        return method_of(trial).adaptive ? static_cast<double>(run.tolerance) : run.step();
    }

    HeatMap map_of(std::span<const TrialNumbers> numbers, std::size_t method) const {
        const auto& cells = columns_of(*methods_[method]);
        HeatMap map{.columns = columns_,
                    .rows = releases_.size(),
                    .x_low = cells.from,
                    .x_high = cells.to,
                    .y_low = rows_.from,
                    .y_high = rows_.to,
                    .label = fmt::format("greatest energy error in {:g} s, of the energy released", duration_.value()),
                    .none_label = "blow-up",
                    .none_is_bad = true,
                    .low = least_shown,
                    .high = blow_up,
                    .logarithmic = true,
                    .shares_bar = methods_.size() > 1};
        for (std::size_t row = 0; row < map.rows; ++row)
            for (std::size_t column = 0; column < map.columns; ++column) {
                const double error = numbers[method * columns_ + column][row];
                map.values.push_back(static_cast<float>(error < least_shown ? least_shown : error));
            }
        return map;
    }

    /// The step at which linear theory has a row blow up, s; NaN where there is none.
    double limit_at(std::string_view method, std::size_t row) const {
        const auto modes = small_oscillations(releases_[row].cast<double>());
        return step_limit(method, modes, duration_.value(), blow_up).value_or(nan_value);
    }

    /// A rule where it is the same for all rows, else a curve.
    void draw_limit(std::string_view method, Plot& plot) const {
        Curve curve{.label = "linear limit", .dashed = true, .quiet = true};
        for (std::size_t row = 0; row < releases_.size(); ++row) {
            add_point(curve, limit_at(method, row), rows_.middle(static_cast<int>(row)));
        }
        const auto [least, most] = std::minmax_element(curve.x.begin(), curve.x.end());
        constexpr double alike = 1e-4;
        if (std::isnan(*least)) return;
        if (*most < *least * (1 + alike)) {
            plot.rules.push_back({Rule::Orientation::vertical, *least, fmt::format("limit {:.3g} s", *least)});
            return;
        }
        curve.y.front() = rows_.from;
        curve.y.back() = rows_.to;
        plot.curves.push_back(std::move(curve));
    }

    static constexpr double least_shown = 1e-12;

    SideSpec release_;
    const ReleaseParameter* parameter_ = nullptr;
    std::vector<const MethodEntry*> methods_;
    std::string model_ = "auto";  // angles where a method serves them
    Rational duration_{10, 1};    // s
    Cells rows_{0, 180, 72, false};
    Cells steps_{0.002, 1, 100, true}, tolerances_{1e-13, 1, 100, true};  // s; as many columns of either
    std::size_t columns_ = 0;
    std::vector<Pendulum<Quad>> releases_;  // of each row
};

}  // namespace

const FigureKind stability_kind{"stability", read_as<Stability>};

}  // namespace doppel
