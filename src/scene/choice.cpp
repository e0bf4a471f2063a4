#include "scene/choice.hpp"

#include "analysis/error_course.hpp"
#include "scene/assemble.hpp"
#include "scene/way.hpp"
#include "scene/wording.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

constexpr double margin = 2;        // by which an estimate stays below what is asked
constexpr double enough = 0.5;      // rad, of an error: nothing is known beyond
constexpr int most_trials = 12;     // of settings
constexpr double no_better = 0.25;  // of what is asked: where a looser setting would not do

/// A setting, tried.
struct Trial {
    Pace setting;
    ErrorCourse course;
    long rounding_horizon;  // the last sample to which rounding leaves the accuracy
    long horizon;           // the last one to which both do

    Trial(const Pace& of, ErrorCourse found, double allowed) : setting(of), course(std::move(found)) {
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
    Trial tried(const Pace& setting) const {
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

/// A way, and the trial of it that did best.
struct Found {
    Way way;
    Trial trial;

    /// Nearly as far as `sample`: no way gets much further than rounding leaves.
    bool reaches(long sample) const {
        constexpr double nearly = 0.9;
        return trial.horizon >= 0 && static_cast<double>(trial.horizon) >= nearly * static_cast<double>(sample);
    }
};

/// What the search for one side goes by.
struct Question {
    const SideSpec& spec;
    Rational sample_hz;
    double accuracy, time_unit;  // rad, s
    long samples;
    const std::atomic<bool>& stop;
};

/// The first of the ways that does; or the one that comes furthest.
Found best_of(const std::vector<MeasuredWay>& ways, const Question& question) {
    if (ways.empty())
        throw bad_input("no method that serves this system was measured to reach accuracy = {}", question.accuracy);
    std::optional<Found> best;
    constexpr std::size_t most_ways = 3;  // the first does, but for systems very unlike those of the table
    for (std::size_t i = 0; i < std::min(ways.size(), most_ways); ++i) {
        const Way way(question.spec, question.sample_hz, ways[i], question.time_unit);
        auto trial = Search(way, question.accuracy, question.samples, question.stop).best();
        if (!best || trial.horizon > best->trial.horizon) best.emplace(Found{way, std::move(trial)});
        if (best->reaches(best->trial.rounding_horizon)) break;
    }
    return *std::move(best);
}

/// The cheapest for the accuracy; where rounding cuts the run short, the cheapest close to it.
Found searched(const Question& question) {
    auto found = best_of(allowed_ways(question.spec, question.accuracy), question);
    if (found.trial.rounding_horizon == question.samples) return found;
    auto fine = best_of(allowed_ways(question.spec, finest_in_table), question);
    const auto work = [](const Found& of) { return of.trial.course.effort.evaluations; };
    return fine.reaches(found.trial.horizon) && work(fine) < work(found) ? std::move(fine) : std::move(found);
}

std::string why_words(const SideSpec& spec, const Way& chosen, double accuracy) {
    auto words = fmt::format("the cheapest way to {} rad that was measured", scientific(accuracy));
    const auto ways = allowed_ways(spec, accuracy);
    const auto of_method = [&](bool same) {
        return std::find_if(ways.begin(), ways.end(),
                            [&](const auto& way) { return (way.method == chosen.method().name) == same; });
    };
    const auto taken = of_method(true), rival = of_method(false);
    if (taken != ways.end() && rival != ways.end() && rival->cost > taken->cost)
        words += fmt::format("; {} would take {:.1f} times as long", rival->method, rival->cost / taken->cost);
    return words;
}

}  // namespace

Side choose_side(const SideSpec& spec, const Rational& duration, const Rational& sample_hz,
                 const std::atomic<bool>& stop) {
    const auto accuracy = static_cast<double>(*spec.accuracy);
    const long samples = product(duration, sample_hz)->numerator;
    const double time_unit = time_unit_of(spec, duration.value()),
                 swing = std::min(duration.value(), 2 * pi * time_unit);
    const auto [way, trial] = searched({spec, sample_hz, accuracy, time_unit, samples, stop});
    const auto& course = trial.course;
    if (static_cast<double>(trial.horizon) / sample_hz.value() < swing * (1 - 1e-9))
        throw course.failure.empty()
            ? out_of_reach(accuracy, trial, spec, swing, sample_hz, samples)
            : method_failed("the motion breaks down within {:.2g} s: {}",
                            static_cast<double>(course.truncation.size()) / sample_hz.value(), course.failure);

    auto side = way.side(trial.setting);
    const auto finer = way.side(way.finer(trial.setting));
    const double seen = static_cast<double>(course.truncation.size() - 1);
    side.choice = Choice{
        .accuracy = accuracy,
        .estimated_error = std::max(course.error(static_cast<std::size_t>(trial.horizon)), least_error(spec.precision)),
        .horizon = trial.horizon,
        .verified_by = pace_words(finer),
        .evaluations =
            static_cast<double>(course.effort.evaluations) * (seen > 0 ? static_cast<double>(samples) / seen : 1)};
    side.why = why_words(spec, way, accuracy);
    return side;
}

}  // namespace doppel
