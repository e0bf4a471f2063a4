#include "scene/choice.hpp"

#include "analysis/error_course.hpp"
#include "scene/assemble.hpp"
#include "scene/choose.hpp"
#include "scene/cost_table.hpp"
#include "scene/wording.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

constexpr double margin = 2;        // by which an estimate stays below what is asked
constexpr double enough = 0.5;      // rad, of an error: nothing is known beyond
constexpr double finer_by = 1e-3;   // the finer run's tolerance
constexpr int most_trials = 12;     // of settings
constexpr double no_better = 0.25;  // of what is asked: where a looser setting would not do

/// How finely to step: a tolerance, or steps to a sample.
struct Setting {
    double tolerance = 0;
    long steps = 1;
};

/// The least of 1, 2, 3, 4, 6, 8, 12 … that is `least` or more.
long round_steps(double least) {
    for (long n = 1;; n *= 2) {
        if (static_cast<double>(n) >= least) return n;
        if (n > 1 && static_cast<double>(n / 2 * 3) >= least) return n / 2 * 3;
    }
}

/// The largest of 1e-k and 3e-k that is `most` or less.
double round_tolerance(double most) {
    const int decade = static_cast<int>(std::floor(std::log10(most) + 1e-9));
    const double one = std::pow(10, decade);
    return 3 * one <= most * (1 + 1e-9) ? 3 * one : one;
}

/// One model and method for a side, at any setting.
class Way {
public:
    Way(const SideSpec& spec, const Rational& sample_hz, const MeasuredWay& measured, double time_unit)
        : spec_(spec), sample_hz_(sample_hz), method_(*find_method(measured.method)) {
        spec_.accuracy.reset();
        spec_.integrator = measured.method;
        spec_.model = measured.model == Model::angles        ? ModelChoice::angles
                      : measured.model == Model::constraints ? ModelChoice::constraints
                                                             : ModelChoice::mechanism;
        const bool quad = spec.precision == Precision::in_quad;
        finest_ = quad ? 1e-30 : 1e-14;
        finest_check_ = quad ? 1e-33 : 1e-15;
        start_ = method_.adaptive
                     ? Setting{.tolerance = round_tolerance(std::clamp(measured.setting, finest_, 1e-2))}
                     : Setting{.steps = round_steps(1 / (sample_hz.value() * measured.setting * time_unit))};
    }

    const Setting& start() const { return start_; }
    const MethodEntry& method() const { return method_; }

    Side side(const Setting& setting) const {
        auto spec = spec_;
        if (method_.adaptive)
            spec.tolerance = parse_quad(fmt::format("{:.0e}", setting.tolerance));
        else
            spec.step_s = quotient({1, setting.steps}, sample_hz_);
        return make_side(spec, sample_hz_);
    }

    /// Errs a thousandth as much, or as little as the precision allows; with steps, a sixteenth.
    Setting finer(const Setting& setting) const {
        if (method_.adaptive) return {.tolerance = std::max(setting.tolerance * finer_by, finest_check_)};
        return {.steps = setting.steps * std::max(2L, 16L >> (method_.order - 1))};
    }

    /// A setting that errs `factor` times as much, > or < 1; nothing where it is too fine, or the same.
    std::optional<Setting> scaled(const Setting& setting, double factor) const {
        Setting next = setting;
        if (method_.adaptive) {
            next.tolerance = round_tolerance(std::clamp(setting.tolerance * factor, finest_, 1e-2));
            if (next.tolerance == setting.tolerance) return std::nullopt;
            return next;
        }
        const double steps = static_cast<double>(setting.steps) * std::pow(factor, -1.0 / method_.order);
        next.steps = round_steps(std::max(1.0, steps));
        constexpr long most_steps = 100'000;
        if (next.steps == setting.steps || next.steps > most_steps) return std::nullopt;
        return next;
    }

private:
    SideSpec spec_;
    Rational sample_hz_;
    MethodEntry method_;
    double finest_, finest_check_;  // tolerances
    Setting start_;
};

/// A setting, tried.
struct Trial {
    Setting setting;
    ErrorCourse course;
    long rounding_horizon;  // the last sample to which rounding leaves the accuracy
    long horizon;           // the last one to which both do

    Trial(const Setting& of, ErrorCourse found, double allowed) : setting(of), course(std::move(found)) {
        const auto last_within = [&](const auto& error) {
            long last = -1;
            while (last + 1 < static_cast<long>(course.rounding.size()) && error(last + 1) <= allowed) ++last;
            return last;
        };
        rounding_horizon = last_within([&](long n) { return course.rounding[static_cast<std::size_t>(n)]; });
        horizon = last_within([&](long n) { return course.error(static_cast<std::size_t>(n)); });
    }
    bool meets() const { return horizon == rounding_horizon; }
    double truncation() const {
        return rounding_horizon < 0 ? 0 : course.truncation[static_cast<std::size_t>(rounding_horizon)];
    }
};

/// Settings of one way, tried until one does.
class Search {
public:
    Search(const Way& way, double accuracy, long samples, const std::atomic<bool>& stop)
        : way_(way), allowed_(accuracy / margin), samples_(samples), stop_(stop) {}

    Trial best() const {
        auto trial = tried(way_.start());
        for (int i = 0; i < most_trials && !trial.meets(); ++i) {
            const auto next = way_.scaled(trial.setting, tightening(trial));
            if (!next) break;
            trial = tried(*next);
        }
        if (!trial.meets() || trial.truncation() > no_better * allowed_) return trial;
        // perhaps too good: one looser, if it does as well
        const double room = trial.truncation() > 0 ? no_better * 2 * allowed_ / trial.truncation() : 1e3;
        if (const auto looser = way_.scaled(trial.setting, std::min(room, 1e6))) {
            auto other = tried(*looser);
            if (other.meets() && other.horizon >= trial.horizon &&
                other.course.effort.evaluations < trial.course.effort.evaluations)
                return other;
        }
        return trial;
    }

private:
    Trial tried(const Setting& setting) const {
        const auto side = way_.side(setting);
        return {setting,
                error_course(side.motion, way_.side(way_.finer(setting)).motion, samples_, side.reach, enough, stop_),
                allowed_};
    }

    /// What factor the error is to shrink by: where it is not yet small, it tells little.
    double tightening(const Trial& trial) const {
        const double error = trial.truncation();
        return error > 0.05 || !(error > 0) ? 1e-3 : std::clamp(no_better * allowed_ / error, 1e-6, 0.3);
    }

    const Way& way_;
    double allowed_;
    long samples_;
    const std::atomic<bool>& stop_;
};

/// Those of the table that the side may take.
std::vector<MeasuredWay> allowed_ways(const SideSpec& spec, double accuracy) {
    const std::size_t links = spec.particles.empty() ? spec.links() : spec.particles.size();
    // what only quad can do is not in the table: there, the order is that of its last digits
    constexpr double finest_in_table = 1e-11;
    auto ways = measured_ways(links, std::max(accuracy, finest_in_table));
    const auto fits = [&](const MeasuredWay& way) {
        const auto& method = *find_method(way.method);
        if (way.model == Model::mechanism ? !spec.is_mechanism() && spec.model != ModelChoice::mechanism
                                          : spec.is_mechanism())
            return false;
        if (spec.stabilise != Stabilise::none && (way.model == Model::angles || !method.angles)) return false;
        if (spec.model == ModelChoice::automatic) return true;
        return way.model == Model::angles        ? spec.model == ModelChoice::angles
               : way.model == Model::constraints ? spec.model == ModelChoice::constraints
                                                 : spec.model == ModelChoice::mechanism;
    };
    std::erase_if(ways, [&](const MeasuredWay& way) { return !fits(way); });
    for (auto& way : ways)
        if (find_method(way.method)->adaptive) way.setting *= std::min(1.0, accuracy / finest_in_table);
    return ways;
}

/// √(l/g) of the mean link, s; of what knows no gravity, a sixtieth of the run.
double time_unit_of(const SideSpec& spec, double duration) {
    if (spec.gravity_m_per_s2 == 0) return duration / 60;
    double length = 1;
    if (spec.particles.empty()) {
        const auto chain = chain_of(spec).cast<double>();
        length = chain.reach() / static_cast<double>(chain.links());
    }
    return std::sqrt(length / static_cast<double>(spec.gravity_m_per_s2));
}

/// Below it no number of the table can be known, rad.
double least_error(Precision precision) {
    return 2 * pi *
           (precision == Precision::in_quad ? static_cast<double>(std::numeric_limits<Quad>::epsilon())
                                            : std::numeric_limits<double>::epsilon());
}

/// What would be within reach, for whoever asked for more.
Error out_of_reach(double accuracy, const Trial& trial, const SideSpec& spec, double swing, const Rational& sample_hz,
                   long samples) {
    const bool quad = spec.precision == Precision::in_quad;
    const auto within = [&](double seconds) {
        const auto n = static_cast<std::size_t>(std::lround(seconds * sample_hz.value()));
        return trial.course.error(n) * margin;
    };
    const double to_end = within(static_cast<double>(samples) / sample_hz.value());
    const auto up = [](double value) {
        const double digit = std::pow(10, std::floor(std::log10(value)));
        return fmt::format("{:.0e}", std::ceil(value / digit) * digit);
    };
    return bad_input(
        "accuracy = {:.3g} rad is beyond {} here: it would hold for {:.2g} s; within reach are {} for {:.2g} s{}{}",
        accuracy, quad ? "quad" : "double", std::max(0.0, static_cast<double>(trial.horizon) / sample_hz.value()),
        std::isfinite(within(swing)) ? up(within(swing)) : "none", swing,
        to_end < enough ? fmt::format(" and {} to the end", up(to_end)) : "",
        quad ? "" : "; precision = \"quad\" reaches further");
}

std::string why_words(const std::vector<MeasuredWay>& ways, const Way& chosen, double accuracy) {
    auto words = fmt::format("the cheapest way to {} rad that was measured", scientific(accuracy));
    const auto rival =
        std::find_if(ways.begin(), ways.end(), [&](const auto& way) { return way.method != chosen.method().name; });
    const auto taken =
        std::find_if(ways.begin(), ways.end(), [&](const auto& way) { return way.method == chosen.method().name; });
    if (rival != ways.end() && rival->cost > taken->cost)
        words += fmt::format("; {} would take {:.1f} times as long", rival->method, rival->cost / taken->cost);
    return words;
}

}  // namespace

Side choose_side(const SideSpec& spec, const Rational& duration, const Rational& sample_hz,
                 const std::atomic<bool>& stop) {
    const auto accuracy = static_cast<double>(*spec.accuracy);
    const long samples = product(duration, sample_hz)->numerator;
    const auto ways = allowed_ways(spec, accuracy);
    if (ways.empty())
        throw bad_input("no method that serves this system was measured to reach accuracy = {}", accuracy);
    const double time_unit = time_unit_of(spec, duration.value()),
                 swing = std::min(duration.value(), 2 * pi * time_unit);
    std::optional<Trial> best;
    std::optional<Way> best_way;
    constexpr std::size_t most_ways = 3;  // the first does, but for systems very unlike those of the table
    for (std::size_t i = 0; i < std::min(ways.size(), most_ways); ++i) {
        const Way way(spec, sample_hz, ways[i], time_unit);
        auto trial = Search(way, accuracy, samples, stop).best();
        if (!best || trial.horizon > best->horizon) {
            best = std::move(trial);
            best_way = way;
        }
        if (best->horizon == best->rounding_horizon && best->horizon >= 0) break;
    }
    auto side = best_way->side(best->setting);
    if (static_cast<double>(best->horizon) / sample_hz.value() < swing * (1 - 1e-9))
        throw best->course.failure.empty()
            ? out_of_reach(accuracy, *best, spec, swing, sample_hz, samples)
            : method_failed("the motion breaks down within {:.2g} s: {}",
                            static_cast<double>(best->course.truncation.size()) / sample_hz.value(),
                            best->course.failure);

    const auto finer = best_way->side(best_way->finer(best->setting));
    const auto at = static_cast<std::size_t>(best->horizon);
    const double seen = static_cast<double>(best->course.truncation.size() - 1);
    side.choice = Choice{.accuracy = accuracy,
                         .estimated_error = std::max(best->course.error(at), least_error(spec.precision)),
                         .horizon = best->horizon,
                         .verified_by = pace_words(finer),
                         .evaluations = static_cast<double>(best->course.effort.evaluations) *
                                        (seen > 0 ? static_cast<double>(samples) / seen : 1)};
    side.why = why_words(ways, *best_way, accuracy);
    return side;
}

}  // namespace doppel
