#include "analysis/drift.hpp"

#include "analysis/watched_motion.hpp"
#include "integrate/methods.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// Settings have numbers, finer ones higher numbers: steps of 100/n s, and tolerances of three digits from 0.0999 down
/// to four times the machine epsilon.
constexpr long all_steps_s = 100;
constexpr long tolerances_a_decade = 900;
constexpr long finest_tolerance = 14 * tolerances_a_decade + 110;  // 8.89e-16

bool is_adaptive(const MotionSpec& motion) {
    return find_method(motion.method)->adaptive;
}

MotionSpec at_setting(MotionSpec motion, long n) {
    constexpr long samples_per_s = 4;  // at least, if steps are not longer
    if (is_adaptive(motion)) {
        motion.tolerance =
            parse_quad(fmt::format("{}e{}", 999 - n % tolerances_a_decade, -4 - n / tolerances_a_decade));
        motion.sample_interval = {1, samples_per_s};
    } else {
        motion.steps_per_sample = std::max(1L, n / (all_steps_s * samples_per_s));
        motion.sample_interval = *reduced(all_steps_s * motion.steps_per_sample, n);
    }
    return motion;
}

WatchedMotion watched(const MotionSpec& spec) {
    const auto chain = spec.chain->cast<double>();
    return {spec, chain.potential_range(), chain.reach()};
}

double time_of(const MotionSpec& spec, long sample) {
    return static_cast<double>(sample) * static_cast<double>(spec.sample_interval.numerator) /
           static_cast<double>(spec.sample_interval.denominator);
}

/// Evaluations per second between the first and the last sample (or the last before a failure); NaN with less than two.
double evaluation_rate(const MotionSpec& spec, double duration_s, const std::atomic<bool>& stop) {
    auto motion = watched(spec);
    double first = NAN, rate = NAN;
    for (long sample = 0; time_of(spec, sample) < duration_s && motion.advance(stop); ++sample)
        if (sample == 0)
            first = motion.evaluations();
        else
            rate = (motion.evaluations() - first) / time_of(spec, sample);
    return rate;
}

/// The motion at the finest setting within the cost. A setting that fails at once counts as too coarse.
MotionSpec calibrated(const MotionSpec& motion, double evaluations_per_s, double seconds,
                      const std::atomic<bool>& stop) {
    const double maximum = evaluations_per_s * (1 + 1e-9);
    const auto affordable = [&](long n) { return !(evaluation_rate(at_setting(motion, n), seconds, stop) > maximum); };
    const bool adaptive = is_adaptive(motion);
    if (adaptive && affordable(finest_tolerance)) return at_setting(motion, finest_tolerance);
    long coarse = adaptive ? 0 : 1;
    long fine = adaptive ? finest_tolerance : static_cast<long>(all_steps_s * maximum) + 1;
    while (fine - coarse > 1) {
        const long middle = coarse + (fine - coarse) / 2;
        (affordable(middle) ? coarse : fine) = middle;
    }
    return at_setting(motion, coarse);
}

}  // namespace

DriftRun drift(MotionSpec spec, double evaluations_per_s, std::span<const double> times_s,
               const std::atomic<bool>& stop) {
    spec.follows_turns = false;
    spec = calibrated(spec, evaluations_per_s, std::min(calibration_s, times_s.back()), stop);
    const auto lengths = spec.chain->cast<double>().length;
    const double shortest = *std::min_element(lengths.begin(), lengths.end());
    DriftRun made;
    made.errors.assign(2 * times_s.size(), NAN);
    made.setting = is_adaptive(spec) ? static_cast<double>(spec.tolerance)
                                     : quotient(spec.sample_interval, {spec.steps_per_sample, 1})->value();

    auto motion = watched(spec);
    long sample = 0;
    for (std::size_t point = 0; point < times_s.size() && std::isnan(made.failed_at_s); ++point)
        while (time_of(spec, sample + 1) <= times_s[point]) {
            ++sample;
            if (!motion.advance(stop) || motion.energy_error >= 1 || motion.length_error >= shortest) {
                made.failed_at_s = time_of(spec, sample);
                break;
            }
            auto &energy = made.errors[point], &length = made.errors[times_s.size() + point];
            energy = std::fmax(energy, motion.energy_error);
            length = std::fmax(length, motion.length_error);
        }
    made.evaluations_per_s = motion.evaluations() / time_of(spec, sample);
    return made;
}

Growth growth_of(std::span<const double> times_s, std::span<const double> errors, double failed_at_s) {
    constexpr double decades = 2;   // the range of time that the fit uses
    constexpr double least = 0.25;  // exponent of a growth: half-way between the powers 0 and ½
    std::vector<double> log_times, log_errors;
    for (std::size_t i = 0; i < errors.size(); ++i) {
        if (!(errors[i] > 0)) continue;
        log_times.push_back(std::log(std::fmin(times_s[i], failed_at_s)));
        log_errors.push_back(std::log(errors[i]));
    }
    // the slope of the least-squares line through the last points
    const auto fitted = [&](double back) {
        const auto first =
            std::ranges::lower_bound(log_times, log_times.back() - back * (1 + 1e-9)) - log_times.begin();
        using Numbers = Eigen::Map<const Eigen::ArrayXd>;
        const Numbers x(log_times.data() + first, std::ssize(log_times) - first),
            y(log_errors.data() + first, x.size());
        return ((x - x.mean()) * (y - y.mean())).sum() / (x - x.mean()).square().sum();
    };
    Growth growth;
    double last = 0;  // exponent of the last decade
    if (log_times.size() > 1) growth.exponent = fitted(decades * std::log(10)), last = fitted(std::log(10));
    const double p = growth.exponent;
    using Kind = Growth::Kind;
    // thresholds half-way between the powers 0, ½, 1 and 2; no error at all also counts as bounded, and so does one that
    // has reached its maximum: it grows no more in the last decade
    growth.kind = failed_at_s > 0                         ? Kind::failed
                  : !(last >= least)                      ? Kind::bounded
                  : p < least || std::abs(last - p) > 0.5 ? Kind::unsteady
                  : p >= 1.5                              ? Kind::steeper
                  : p >= 0.75                             ? Kind::linear
                                                          : Kind::root;
    return growth;
}

}  // namespace doppel
