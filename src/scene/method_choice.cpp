#include "scene/method_choice.hpp"

#include "analysis/reference.hpp"
#include "scene/captions.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

namespace doppel {
namespace {

constexpr double margin = 0.8;   // of what is asked: what an error may come to, at the samples
constexpr double enough = 0.5;   // rad, of an error: nothing is known beyond
constexpr double nearly = 0.97;  // as far as the finest setting gets, where rounding keeps all from the end

/// A setting, tried.
struct Trial {
    int level;
    ErrorHistory history;
    long horizon;  // the last sample to which the accuracy holds; −1 = none

    /// Evaluations of the right-hand side a sample.
    double work() const {
        return static_cast<double>(history.effort.evaluations) /
               static_cast<double>(std::max(history.effort_samples, 1L));
    }
};

/// The loosest setting of one method that does.
class Search {
public:
    Search(const StepSettings& control, double accuracy, const ReferenceTrajectory& reference,
           const std::atomic<bool>& stop)
        : control_(control), allowed_(margin * accuracy), reference_(reference), stop_(stop) {}

    /// To the last of `samples`, or close to where the finest gets; which is taken if it does not get to `least`.
    Trial best(long samples, long least) {
        long goal = samples;
        if (tried(control_.start()).horizon < goal) {
            const auto& finest = tried(control_.finest());
            if (finest.horizon < least) return finest;
            if (finest.horizon < goal)
                goal = std::max(least, std::lround(nearly * static_cast<double>(finest.horizon)));
        }
        const auto does = [&](int level) { return tried(level).horizon >= goal; };
        // by growing strides from what the table suggests, then by halves
        int fine = control_.start(), loose = fine, stride = 1;
        if (does(fine)) {
            do {
                fine = loose;
                loose = std::max(fine - stride, -1);
                stride *= 2;
            } while (loose >= 0 && does(loose));
        } else {
            do {
                loose = fine;
                fine = std::min(loose + stride, control_.finest());
                stride *= 2;
            } while (!does(fine));
        }
        while (fine - loose > 1) {
            const int middle = (fine + loose) / 2;
            (does(middle) ? fine : loose) = middle;
        }
        return tried(fine);
    }

private:
    const Trial& tried(int level) {
        const auto known = trials_.find(level);
        if (known != trials_.end()) return known->second;
        auto history = error_history(control_.side(level).motion, reference_, enough, stop_);
        const long horizon = history.last_within(allowed_);
        return trials_.emplace(level, Trial{level, std::move(history), horizon}).first->second;
    }

    const StepSettings& control_;
    double allowed_;
    const ReferenceTrajectory& reference_;
    const std::atomic<bool>& stop_;
    std::map<int, Trial> trials_;
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
        return trial.history.at(static_cast<std::size_t>(std::lround(seconds * sample_hz.value()))) / margin;
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

/// The methods that are the table's cheapest for this accuracy or a finer one: of these nothing finer is left out, so that
/// less accuracy never takes more work.
std::vector<MeasuredMethod> cheapest_methods(const SideSpec& spec, double accuracy) {
    std::vector<MeasuredMethod> all;
    const auto is_new = [&](const MeasuredMethod& measured) {
        return std::none_of(all.begin(), all.end(), [&](const MeasuredMethod& known) {
            return known.model == measured.model && known.method == measured.method;
        });
    };
    constexpr int finest = 22;  // the table has an accuracy each half decade
    for (int half_decades = 0; half_decades <= finest; ++half_decades) {
        const double of_table = std::pow(10, -0.5 * half_decades);
        if (of_table > accuracy * 1.0001 && half_decades < finest) continue;
        const auto measured =
            measured_methods(spec, half_decades < finest ? of_table : std::min(accuracy, finest_in_table));
        if (!measured.empty() && is_new(measured.front())) all.push_back(measured.front());
    }
    if (all.empty()) throw bad_input("no method that serves this system was measured to reach accuracy = {}", accuracy);
    return all;
}

/// A method, and the trial of it that did best.
struct Found {
    StepSettings control;
    Trial trial;

    /// Further; or as far, or short of the end nearly so, with less work.
    bool beats(const Found& other, long end) const {
        const auto reaches = [&](const Found& one, const Found& two) {
            const long goal = two.trial.horizon;
            return static_cast<double>(one.trial.horizon) >= (goal == end ? 1 : nearly) * static_cast<double>(goal);
        };
        if (reaches(*this, other) && reaches(other, *this)) return trial.work() < other.trial.work();
        return trial.horizon > other.trial.horizon;
    }
};

std::string why_words(const SideSpec& spec, const StepSettings& chosen, double accuracy) {
    const auto all = measured_methods(spec, accuracy);
    const auto of_method = [&](bool same) {
        return std::find_if(all.begin(), all.end(),
                            [&](const auto& one) { return (one.method == chosen.method().name) == same; });
    };
    const auto taken = of_method(true), rival = of_method(false);
    const bool cheapest = taken == all.begin();
    auto words = cheapest ? fmt::format("the cheapest way to {} rad that was measured", scientific(accuracy))
                          : fmt::format("takes less work here than {}, the cheapest way to {} rad that was measured",
                                        all.front().method, scientific(accuracy));
    if (cheapest && rival != all.end() && rival->cost > taken->cost)
        words += fmt::format("; {} would take {:.1f} times as long", rival->method, rival->cost / taken->cost);
    return words;
}

}  // namespace

MethodChooser::MethodChooser(const SideSpec& spec, const Rational& duration, const Rational& sample_hz,
                             const std::atomic<bool>& stop)
    : spec_(spec),
      duration_(duration),
      sample_hz_(sample_hz),
      stop_(stop),
      time_unit_(time_unit_of(spec, duration.value())),
      samples_(product(duration, sample_hz)->numerator) {
    const StepSettings any(spec, sample_hz, cheapest_methods(spec, finest_in_table).front(), time_unit_);
    const auto side = any.side(any.finest());
    reference_ = reference_trajectory(side.motion, samples_, side.reach, enough, stop);
}

Side MethodChooser::choose(double accuracy) const {
    const double swing = std::min(duration_.value(), 2 * pi * time_unit_);
    const long swing_samples = std::min(samples_, std::lround(std::ceil(swing * sample_hz_.value() * (1 - 1e-9))));
    std::optional<Found> best;
    for (const auto& measured : cheapest_methods(spec_, accuracy)) {
        const StepSettings control(spec_, sample_hz_, measured, time_unit_);
        Found found{control, Search(control, accuracy, reference_, stop_).best(samples_, swing_samples)};
        if (!best || found.beats(*best, samples_)) best.emplace(std::move(found));
    }
    const auto& [control, trial] = *best;
    const auto& history = trial.history;
    if (trial.horizon < swing_samples)
        throw history.failure.empty()
            ? out_of_reach(accuracy, trial, spec_, swing, sample_hz_, samples_)
            : method_failed("the motion breaks down within {:.2g} s: {}",
                            static_cast<double>(history.error.size()) / sample_hz_.value(), history.failure);

    auto side = control.side(trial.level);
    side.choice = MethodChoice{
        .accuracy = accuracy,
        .estimated_error = std::max(history.at(static_cast<std::size_t>(trial.horizon)), least_error(spec_.precision)),
        .horizon = trial.horizon,
        .verified_by = reference_.description(),
        .evaluations = trial.work() * static_cast<double>(samples_)};
    side.why = why_words(spec_, control, accuracy);
    return side;
}

Side choose_side(const SideSpec& spec, const Rational& duration, const Rational& sample_hz,
                 const std::atomic<bool>& stop) {
    return MethodChooser(spec, duration, sample_hz, stop).choose(static_cast<double>(*spec.accuracy));
}

}  // namespace doppel
