#include "analysis/drift.hpp"

#include "analysis/breakdown.hpp"
#include "base/clock.hpp"
#include "integrate/methods.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

constexpr double calibration_s = 200;
constexpr long samples_per_s = 4;  // at least, where steps are not longer

/// Settings are numbered, the finer the higher: steps of 100/n s, and tolerances of three digits from 0.0999 down to
/// four roundings.
constexpr long all_steps_s = 100;
constexpr long tolerances_a_decade = 900;
constexpr long finest_tolerance = 14 * tolerances_a_decade + 110;  // 8.89e-16

Quad tolerance_of(long n) {
    return parse_quad(fmt::format("{}e{}", 999 - n % tolerances_a_decade, -4 - n / tolerances_a_decade));
}

/// The method with its n-th setting.
MotionSpec motion_of(const DriftSpec& spec, const DriftMethod& method, long n) {
    MotionSpec motion{.chain = spec.release,
                      .model = method.model,
                      .method = method.name,
                      .stabilise = method.projected ? Stabilise::projection : Stabilise::none,
                      .follows_turns = false};
    if (find_method(method.name)->adaptive) {
        motion.tolerance = tolerance_of(n);
        motion.sample_interval = {1, samples_per_s};
    } else {
        motion.steps_per_sample = std::max(1L, n / (all_steps_s * samples_per_s));
        motion.sample_interval = *reduced(all_steps_s * motion.steps_per_sample, n);
    }
    return motion;
}

/// A motion watched from sample to sample.
class WatchedMotion {
public:
    explicit WatchedMotion(const MotionSpec& spec)
        : motion_(make_motion(spec)),
          interval_(spec.sample_interval),
          chain_(spec.chain->cast<double>()),
          proportion_(motion_->observe(), chain_.potential_range(), chain_.reach()) {}

    /// False where the method breaks down.
    bool advance(const std::atomic<bool>& stop) {
        ++sample_;
        if (!advanced(*motion_, stop)) return false;
        const auto seen = motion_->observe();
        energy_error_ = proportion_.energy_error(seen);
        length_error_ = seen.length_error;
        return proportion_.holds(seen);
    }
    /// Of the last sample, or of that so many later, s.
    double time(long later = 0) const {
        return static_cast<double>(sample_ + later) * static_cast<double>(interval_.numerator) /
               static_cast<double>(interval_.denominator);
    }
    double energy_error() const { return energy_error_; }
    double length_error() const { return length_error_; }  // m
    double evaluations() const { return static_cast<double>(motion_->effort().evaluations); }

private:
    std::unique_ptr<Motion> motion_;
    Rational interval_;
    Pendulum<double> chain_;
    Proportion proportion_;
    double energy_error_ = 0, length_error_ = 0;
    long sample_ = 0;
};

/// Evaluations a second between the first sample and the last, or the last before a breakdown; NaN where there are not
/// two.
double evaluation_rate(const MotionSpec& spec, double duration_s, const std::atomic<bool>& stop) {
    WatchedMotion motion(spec);
    double first = NAN, rate = NAN;
    while (motion.time() < duration_s && motion.advance(stop))
        if (std::isnan(first))
            first = motion.evaluations();
        else
            rate = (motion.evaluations() - first) / motion.time(-1);
    return rate;
}

/// The finest setting within the cost. One that breaks down at once is too coarse.
long calibrated(const DriftSpec& spec, const DriftMethod& method, const std::atomic<bool>& stop) {
    const double seconds = std::min(calibration_s, spec.times_s.back());
    const double most = spec.evaluations_per_s * (1 + 1e-9);
    const auto affordable = [&](long n) {
        return !(evaluation_rate(motion_of(spec, method, n), seconds, stop) > most);
    };
    const bool adaptive = find_method(method.name)->adaptive;
    if (adaptive && affordable(finest_tolerance)) return finest_tolerance;
    long coarse = adaptive ? 0 : 1;
    long fine = adaptive ? finest_tolerance : static_cast<long>(all_steps_s * most) + 1;
    while (fine - coarse > 1) {
        const long middle = coarse + (fine - coarse) / 2;
        (affordable(middle) ? coarse : fine) = middle;
    }
    return coarse;
}

/// The slope of the straight line through the points, by least squares; NaN where there are not two.
double slope(const std::vector<double>& x, const std::vector<double>& y) {
    const auto n = static_cast<double>(x.size());
    double mean_x = 0, mean_y = 0, above = 0, below = 0;
    for (std::size_t i = 0; i < x.size(); ++i) mean_x += x[i] / n, mean_y += y[i] / n;
    for (std::size_t i = 0; i < x.size(); ++i) {
        above += (x[i] - mean_x) * (y[i] - mean_y);
        below += (x[i] - mean_x) * (x[i] - mean_x);
    }
    return above / below;
}

}  // namespace

DriftRun drift(const DriftSpec& spec, const DriftMethod& method, const std::atomic<bool>& stop) {
    const auto setting = motion_of(spec, method, calibrated(spec, method, stop));
    const std::vector<double> none(spec.times_s.size(), NAN);
    DriftRun made{.broken_at_s = NAN, .energy_error = none, .length_error = none};
    made.setting = find_method(method.name)->adaptive
                       ? static_cast<double>(setting.tolerance)
                       : quotient(setting.sample_interval, {setting.steps_per_sample, 1})->value();
    const auto lengths = setting.chain->cast<double>().length;
    const double shortest = *std::min_element(lengths.begin(), lengths.end());

    const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    WatchedMotion motion(setting);
    for (std::size_t point = 0; point < none.size() && std::isnan(made.broken_at_s); ++point)
        while (motion.time(1) <= spec.times_s[point]) {
            if (!motion.advance(stop) || motion.energy_error() >= 1 || motion.length_error() >= shortest) {
                made.broken_at_s = motion.time();
                break;
            }
            made.energy_error[point] = std::fmax(made.energy_error[point], motion.energy_error());
            made.length_error[point] = std::fmax(made.length_error[point], motion.length_error());
        }
    made.cpu_s = seconds_of(CLOCK_THREAD_CPUTIME_ID) - start;
    made.evaluations_per_s = motion.evaluations() / motion.time();
    return made;
}

Growth growth_of(std::span<const double> times_s, std::span<const double> errors, double broken_at_s) {
    constexpr double decades = 2, doublings = 2;  // that the fits go back, of time
    std::vector<double> times, log_times, log_errors;
    for (std::size_t i = 0; i < errors.size(); ++i) {
        if (!(errors[i] > 0)) continue;
        times.push_back(std::fmin(times_s[i], broken_at_s));
        log_times.push_back(std::log(times.back()));
        log_errors.push_back(std::log(errors[i]));
    }
    const auto fitted = [&](const std::vector<double>& x, double back) {
        std::size_t first = 0;
        while (first < x.size() && log_times[first] < log_times.back() - back * (1 + 1e-9)) ++first;
        const auto from = static_cast<std::ptrdiff_t>(first);
        return slope({x.begin() + from, x.end()}, {log_errors.begin() + from, log_errors.end()});
    };
    Growth growth{.exponent = times.size() < 2 ? 0 : fitted(log_times, decades * std::log(10)),
                  .doubling_s = NAN,
                  .broken_at_s = broken_at_s};
    using Kind = Growth::Kind;
    if (broken_at_s > 0) {
        growth.kind = Kind::breakdown;
        growth.doubling_s = std::log(2) / fitted(times, doublings * std::log(2));
    } else {
        // half-way between the powers 0, ½, 1 and 2; no error at all is bounded, too
        const double p = growth.exponent;
        growth.kind = p >= 1.5 ? Kind::steeper : p >= 0.75 ? Kind::linear : p >= 0.25 ? Kind::root : Kind::bounded;
    }
    return growth;
}

}  // namespace doppel
