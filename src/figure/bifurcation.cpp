#include "figure/kinds.hpp"
#include "figure/parameter.hpp"
#include "figure/spacing.hpp"
#include "scene/captions.hpp"
#include "scene/method_choice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace doppel {
namespace {

/// How many values there are that are more than `apart` from the next.
std::size_t distinct(std::vector<double> values, double apart) {
    std::sort(values.begin(), values.end());
    std::size_t count = values.empty() ? 0 : 1;
    for (std::size_t i = 1; i < values.size(); ++i) count += values[i] - values[i - 1] > apart;
    return count;
}

/// A driven pendulum once a period of its drive, long after its release, over a range of one parameter: where a motion of
/// one period becomes one of two, four and at last none. Of side a.
class Bifurcation final : public Experiment {
public:
    static constexpr std::string_view table_key = "bifurcation";
    Bifurcation() = default;
    explicit Bifurcation(FigureReader& reader) : pair_(reader.pair()) {
        auto table = reader.settings(*this);
        parameter_ = parameter_of(reader, table, "parameter", parameter_name_, pair_);
        if (!(from_ < to_)) throw table.fault("to", "must be above from ({}); it is {}", text_of(from_), text_of(to_));
        parameter_.demand(table, "from", from_);
        parameter_.demand(table, "to", to_);
        if (static_cast<std::size_t>(link_) > pair_.a.links())
            throw table.fault("link", "must be 1 to {}, the number of links; it is {}", pair_.a.links(), link_);
        settings_ = resolved_pair(pair_) + table.finish();
        if (!parameter_.is_of_method) step_all_alike(pair_, at(0), reader.stop);
        for (const std::size_t end : {std::size_t(0), trials() - 1}) {
            const auto scene = make_scene(at(end));  // reports faults now
            period_of(table, scene.preset.a);
        }
        subtitle_ = varied_subtitle(pair_, std::array{&std::as_const(parameter_)}, std::array{from_}, 0,
                                    {.label = {}, .columns = {}, .is_of_side_a = true});
    }

    template <class Visit>
    void fields(Visit& visit) {
        visit(parameter_field("parameter", parameter_help), parameter_name_);
        visit({"from", "the first value"}, from_);
        visit({"to", "the last"}, to_);
        visit({"points", "how many values", "", from_to(2, 1'000'000)}, points_);
        visit({"link", "whose rate is shown", "", from_to(1, 10'000)}, link_);
        visit({"transient_periods", "of the drive, that pass first", "", from_to(0, 1'000'000)}, transient_periods_);
        visit({"periods", "of the drive, shown", "", from_to(1, 100'000)}, periods_);
    }

    std::size_t trials() const override { return static_cast<std::size_t>(points_); }
    std::string unit() const override { return "values"; }
    std::string subtitle() const override { return subtitle_; }

    bool fits(std::size_t /*trial*/, std::span<const double> numbers) const override {
        return numbers.size() == 2 * static_cast<std::size_t>(periods_);
    }

    std::vector<std::string> columns() const override {
        return {parameter_.name, "period", "theta_rad", "omega_rad_per_s"};
    }
    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (std::size_t i = 0; i < numbers.size(); ++i)
            for (std::size_t n = 0; n + 1 < numbers[i].size(); n += 2) {
                table.add(static_cast<double>(value(i)));
                table.add(static_cast<long>(n / 2) + transient_periods_);
                for (const double number : {numbers[i][n], numbers[i][n + 1]})
                    table.add_or_empty(std::isfinite(number) ? number : NAN);
                table.end_row();
            }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        Plot plot;
        plot.x = {.label = parameter_.label, .low = static_cast<double>(from_), .high = static_cast<double>(to_)};
        plot.y = {.label = fmt::format("rate ω{} once a period of the drive, rad/s",
                                       subscript(static_cast<std::size_t>(link_)))};
        Curve curve{.mark = Mark::points};
        for (std::size_t i = 0; i < numbers.size(); ++i)
            for (std::size_t n = 1; n < numbers[i].size(); n += 2) {
                curve.x.push_back(static_cast<double>(value(i)));
                curve.y.push_back(numbers[i][n]);
            }
        plot.curves.push_back(std::move(curve));
        figure.panels.push_back(std::move(plot));
        figure.captions.push_back(fmt::format("{} periods of the drive each, after {} that pass first.",
                                              grouped(periods_), grouped(transient_periods_)));
    }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        std::array<double, 5> of_period{};
        double irregular = 0;
        for (const auto& trial : numbers) {
            const auto count = distinct(rates_of(trial), 1e-4);
            if (count >= 1 && count <= 4)
                of_period[count] += 1;
            else if (count > 16)
                irregular += 1;
        }
        return {{"values_of_one_period", of_period[1]},
                {"values_of_two_periods", of_period[2]},
                {"values_of_four_periods", of_period[4]},
                {"values_of_more_than_16", irregular}};
    }

    std::optional<std::string> nothing_to_draw(std::span<const TrialNumbers> numbers) const override {
        for (const auto& trial : numbers)
            if (!trial.empty() && std::isfinite(trial[0])) return std::nullopt;
        return "the motion broke down at every value";
    }

private:
    TrialNumbers compute_trial(std::size_t trial, const std::atomic<bool>& stop) const override {
        const auto scene = make_scene(at(trial), stop);
        auto spec = scene.a.motion;
        spec.sample_interval = *quotient({1, 1}, *drive_of(scene.preset.a));
        if (!scene.a.method.adaptive)  // steps that fall on the periods
            spec.steps_per_sample = std::max(1L, std::lround(spec.sample_interval.value() / scene.a.step.value()));
        TrialNumbers numbers;
        const auto all = 2 * static_cast<std::size_t>(periods_);
        try {
            const auto motion = make_motion(spec);
            for (int n = 0; n < transient_periods_; ++n) motion->advance(stop);
            for (int n = 0; n < periods_; ++n) {
                motion->advance(stop);
                const auto bob = motion->observe().bobs[static_cast<std::size_t>(link_ - 1)];
                numbers.push_back(std::remainder(bob.theta, 2 * pi));
                numbers.push_back(bob.omega);
            }
        } catch (const Error& fault) {
            if (fault.code() != ExitCode::method_failed) throw;
        }
        numbers.resize(all, NAN);
        return numbers;
    }

    static std::vector<double> rates_of(const TrialNumbers& trial) {
        std::vector<double> rates;
        for (std::size_t n = 1; n < trial.size(); n += 2)
            if (std::isfinite(trial[n])) rates.push_back(trial[n]);
        return rates;
    }

    /// The frequency of what drives a side, Hz; nothing where nothing does, or several differ.
    static std::optional<Rational> drive_of(const SideSpec& side) {
        std::vector<Quad> all;
        if (side.physical.pivot.amplitude_m != 0) all.push_back(side.physical.pivot.frequency_hz);
        for (const auto& torque : side.physical.torques) all.push_back(torque.frequency_hz);
        if (all.empty() || std::any_of(all.begin(), all.end(), [&](const Quad& f) { return f != all[0]; })) return {};
        const auto frequency = parse_rational(text_of(all[0]));
        return frequency && frequency->numerator > 0 ? frequency : std::nullopt;
    }
    static void period_of(const TomlReader& table, const SideSpec& side) {
        if (!drive_of(side))
            throw table.fault("parameter",
                              "is of a pendulum that is driven, [system.pivot] or [[system.torque]], at one "
                              "frequency of at most 18 digits");
    }

    Quad value(std::size_t trial) const { return from_ + (to_ - from_) * Quad(trial) / Quad(points_ - 1); }
    Preset at(std::size_t trial) const {
        auto pair = pair_;
        parameter_.set_both(pair, value(trial));
        return pair;
    }

    Preset pair_;
    std::string parameter_name_ = "system.pivot.amplitude_m";
    Parameter parameter_;
    Quad from_ = Quad(1) / 10, to_ = Quad(3) / 10;
    int points_ = 400, link_ = 1, transient_periods_ = 200, periods_ = 100;
    std::string subtitle_;
};

}  // namespace

const FigureKind bifurcation_kind = kind_of<Bifurcation>("bifurcation", FigureKind::System::pair);

}  // namespace doppel
