#include "analysis/stability.hpp"

#include "figure/kinds.hpp"
#include "figure/spacing.hpp"
#include "figure/system_words.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace doppel {
namespace {

/// The energy error of each method over its step or tolerance and a parameter of the release, and the limit of linear
/// theory. A trial is a column of one method's map: all releases at one step.
class Stability final : public Experiment {
public:
    static constexpr std::string_view table_key = "stability";
    Stability() = default;
    explicit Stability(FigureReader& reader) : release_(reader.release()) {
        auto table = reader.settings(*this);
        check_rows(table);
        find_methods(table);
        check_columns(table);
        settings_ = resolved_release(release_) + table.finish();
        make_releases(reader.document.table(reader.top, "system"), table);
    }

    template <class Visit>
    void fields(Visit& visit) {
        static constexpr std::array<std::string_view, 2> parameters{"theta1_deg", "mass_ratio"};
        static constexpr std::array<std::string_view, 3> models{"auto", "angles", "constraints"};
        parameter_field(visit, parameters, parameter_);
        if (parameter_->is_ratio) rows_ = {0.01, 10, rows_.count, Spacing::logarithmic};
        visit({"from", "the lowest release", "", {}, "0; of ratios 0.01"}, rows_.from);
        visit({"to", "the highest, to 180; of ratios to 1e6", "", {}, "180; of ratios 10"}, rows_.to);
        visit({"rows", "releases", "", from_to(1, 10'000)}, rows_.count);
        visit({.key = "model", .help = "the equations; auto: angles where the method serves them", .names = models},
              model_);
        method_names_ = names_that_serve();
        visit({.key = "methods", .help = "names of methods", .absent = "all of the model", .known = names_of_methods()},
              method_names_);
        visit({"duration_s", "of each motion", "s", positive}, duration_);
        const Only fixed{named(false), "is for methods of fixed step, of which none is named"};
        const Only adaptive{named(true), "is for methods that go by a tolerance, of which none is named"};
        constexpr Bounds tolerances{.low = 1e-15, .is_positive = true};
        visit({"step_from_s", "the finest step", "s", positive, "", fixed}, steps_.from);
        visit({"step_to_s", "the coarsest", "s", positive, "", fixed}, steps_.to);
        visit({"tolerance_from", "of adaptive methods: the finest", "", tolerances, "", adaptive}, tolerances_.from);
        visit({"tolerance_to", "of adaptive methods: the coarsest", "", positive, "", adaptive}, tolerances_.to);
        visit({"columns", "steps, or tolerances", "", from_to(1, 10'000)}, steps_.count);
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
                add_row(table, method.name, method.adaptive ? NAN : pace, method.adaptive ? pace : NAN,
                        rows_.middle(row), numbers[trial][static_cast<std::size_t>(row)]);
        }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        // as many columns as leave methods of either sort rows of their own
        constexpr std::size_t many = 6, few = 3;
        const auto stepped = std::count_if(methods_.begin(), methods_.end(), [](auto* m) { return !m->adaptive; });
        if (methods_.size() > many) figure.columns = stepped % few == 0 ? few : few + 1;
        figure.shares_axes = true;
        for (std::size_t m = 0; m < methods_.size(); ++m) {
            const auto& method = *methods_[m];
            const auto &cells = columns_of(method), &rows = rows_;
            Plot plot{.title = std::string(method.name)};
            plot.x = {.label = method.adaptive ? "tolerance" : "step, s",
                      .low = cells.from,
                      .high = cells.to,
                      .logarithmic = true};
            plot.y = {.label = std::string(parameter_->label),
                      .low = rows.from,
                      .high = rows.to,
                      .logarithmic = rows.is_logarithmic()};
            if (!rows.is_logarithmic()) plot.y.every = 45;
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

    std::optional<std::string> nothing_to_draw(std::span<const TrialNumbers> numbers) const override {
        for (const auto& trial : numbers)
            if (std::any_of(trial.begin(), trial.end(), [](double error) { return std::isfinite(error); }))
                return std::nullopt;
        return "every release blows up at every step and tolerance; take finer ones";
    }

    std::string subtitle() const override { return swept_words(release_, parameter_->is_ratio); }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        std::vector<Finding> all;
        for (std::size_t m = 0; m < methods_.size(); ++m) {
            const auto& method = *methods_[m];
            double blown = 0, least = NAN;
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

private:
    void check_rows(const TomlReader& table) const {
        const bool is_ratio = parameter_->is_ratio;
        if (is_ratio && release_.links() != 2)
            throw table.fault("parameter", "\"{}\" takes two links; [system] has {}", parameter_->name,
                              release_.links());
        if (!(is_ratio ? rows_.from > 0 : rows_.from >= 0))
            throw table.fault("from", "must be {} 0; it is {}", is_ratio ? ">" : "at least", rows_.from);
        if (const double most = is_ratio ? 1e6 : 180; !(rows_.to > rows_.from && rows_.to <= most))
            throw table.fault("to", "must be more than from = {} and at most {}; it is {}", rows_.from, most, rows_.to);
    }

    /// Those of fixed step first.
    std::vector<std::string> names_that_serve() const {
        std::vector<std::string> names;
        for (const bool adaptive : {false, true})
            for (const auto& method : doppel::methods())
                if (method.adaptive == adaptive && serves(method, model_of(method))) names.emplace_back(method.name);
        return names;
    }

    void find_methods(const TomlReader& table) {
        if (method_names_.empty()) throw table.fault("methods", "must name at least one");
        for (const auto& name : method_names_) {
            const auto* method = &method_named(table, name);
            if (!serves(*method, model_of(*method)))
                throw table.fault("methods", "must serve model = \"{}\"; \"{}\" does not", model_, name);
            methods_.push_back(method);
        }
        check_distinct(table, "methods", method_names_);
    }

    void check_columns(const TomlReader& table) {
        for (const auto& [from, to, cells] :
             {std::tuple{"step_from_s", "step_to_s", steps_}, {"tolerance_from", "tolerance_to", tolerances_}})
            if (!(cells.to > cells.from))
                throw table.fault(to, "must be more than {} = {}; it is {}", from, cells.from, cells.to);
        tolerances_.count = steps_.count;
        columns_ = static_cast<std::size_t>(steps_.count);
        constexpr double most_steps = 1e8;
        if (steps_.to > duration_.value())
            throw table.fault("step_to_s", "must be at most duration_s = {}; it is {}", duration_.value(), steps_.to);
        if (duration_.value() / steps_.from > most_steps)
            throw table.fault("step_from_s", "must leave at most {} steps; it is {}", most_steps, steps_.from);
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
    /// Whether a method is named that goes by a tolerance, or one that does not; unknown names are told later.
    bool named(bool adaptive) const {
        return std::any_of(method_names_.begin(), method_names_.end(), [&](const auto& name) {
            const auto* method = find_method(name);
            return !method || method->adaptive == adaptive;
        });
    }
    const CellRange& columns_of(const MethodEntry& method) const { return method.adaptive ? tolerances_ : steps_; }

    TrialNumbers compute_trial(std::size_t trial, const std::atomic<bool>& stop) const override {
        const auto run = run_of(trial);
        return greatest_energy_errors(run.motion, releases_, run.samples, stop);
    }

    const MethodEntry& method_of(std::size_t trial) const { return *methods_[trial / columns_]; }
    /// How a method steps a release, and how often its energy is sampled.
    struct Run {
        MotionSpec motion;
        long samples = 100;
    };
    Run run_of(std::size_t trial) const {
        const auto& method = method_of(trial);
        Run run;
        run.motion.method = method.name;
        run.motion.model = model_of(method);
        run.motion.follows_turns = false;
        const double pace = columns_of(method).middle(static_cast<int>(trial % columns_));
        if (method.adaptive) {
            run.motion.tolerance = Quad(pace);
        } else {
            // whole steps to a sample, whole samples to the duration
            const double whole = duration_.value() / pace;
            auto& steps = run.motion.steps_per_sample;
            steps = std::max(1L, static_cast<long>(std::ceil(whole / static_cast<double>(run.samples))));
            run.samples = std::max(1L, std::lround(whole / static_cast<double>(steps)));
        }
        run.motion.sample_interval = *quotient(duration_, {run.samples, 1});
        return run;
    }
    /// The step, s, or the tolerance.
    double pace_of(std::size_t trial) const {
        const auto run = run_of(trial);
        return method_of(trial).adaptive
                   ? static_cast<double>(run.motion.tolerance)
                   : duration_.value() / static_cast<double>(run.samples * run.motion.steps_per_sample);
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
        return step_limit(method, modes, duration_.value(), blow_up).value_or(NAN);
    }

    /// A rule where it is the same for all rows, else a curve.
    void draw_limit(std::string_view method, Plot& plot) const {
        Curve curve{.dashed = true, .quiet = true};
        for (std::size_t row = 0; row < releases_.size(); ++row)
            add_point(curve, limit_at(method, row), rows_.middle(static_cast<int>(row)));
        const auto [least, most] = std::minmax_element(curve.x.begin(), curve.x.end());
        constexpr double alike = 1e-4;
        if (std::isnan(*least)) return;
        if (*most < *least * (1 + alike)) {
            plot.rules.push_back({Rule::Orientation::vertical, *least, ""});
            plot.note = fmt::format("limit {:.3g} s", *least);
            return;
        }
        curve.y.front() = rows_.from;
        curve.y.back() = rows_.to;
        plot.curves.push_back(std::move(curve));
    }

    static constexpr double least_shown = 1e-12;

    SideSpec release_;
    const ReleaseParameter* parameter_ = &release_parameter("theta1_deg");
    std::vector<std::string> method_names_;
    std::vector<const MethodEntry*> methods_;
    std::string model_ = "auto";  // angles where a method serves them
    Rational duration_{10, 1};    // s
    CellRange rows_{0, 180, 72};
    CellRange steps_{0.002, 1, 100, Spacing::logarithmic},
        tolerances_{1e-13, 1, 100, Spacing::logarithmic};  // s; as many columns of either
    std::size_t columns_ = 0;
    std::vector<Pendulum<Quad>> releases_;  // of each row
};

}  // namespace

const FigureKind stability_kind = kind_of<Stability>("stability", FigureKind::System::release);

}  // namespace doppel
