#include "figure/flip_checks.hpp"

#include "base/error.hpp"
#include "base/threads.hpp"
#include "scene/captions.hpp"

#include <boost/math/distributions/binomial.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace doppel {
namespace {

/// The share that at least so many of all have, with 95 % confidence, where `hits` of `trials` drawn by lot do
/// (Clopper & Pearson 1934).
double share_at_least(int hits, int trials) {
    return trials == 0 ? 0 : boost::math::binomial_distribution<>::find_lower_bound_on_p(trials, hits, 0.05);
}

/// A release drawn at random: the time to its flip in the map, and by the reference, s; infinite for none, NaN where the
/// motion broke down.
struct CheckRow {
    double time, reference;
};

double reference_time(const Pendulum<double>& pendulum, double duration) {
    constexpr double finer = 1e-14;
    try {
        return reference_flip(pendulum, duration, finer);
    } catch (const Error& error) {
        if (error.code() != ExitCode::method_failed) throw;
        return NAN;
    }
}

}  // namespace

TrialNumbers FlipChecks::compute(std::size_t trial, const std::atomic<bool>& stop) const {
    std::mt19937_64 random(trial);
    const auto drawn = [&](const Range& range) {
        return (range.high - range.low) * (static_cast<double>(random() >> 11) * 0x1p-53) + range.low;
    };
    TrialNumbers numbers;
    int tries = 1000;
    for (auto left = releases(trial); left > 0;) {
        throw_if_set(stop);
        auto p = pendulum_;
        p.angle[1] = radians(drawn(theta2_));
        p.angle[0] = radians(drawn(theta1_));
        // a part of the map may have no other releases
        if (flip_is_forbidden(p) && --tries > 0) continue;
        std::array<double, 1> time;
        first_flips(std::span(&p, 1), spec_, time, stop);
        append(numbers, CheckRow{time[0], reference_time(p, spec_.duration)});
        --left;
    }
    return numbers;
}

bool FlipChecks::fits(std::size_t trial, std::span<const double> numbers) const {
    return numbers.size() == releases(trial) * numbers_in<CheckRow> &&
           std::none_of(numbers.begin(), numbers.end(), [](double t) { return t < 0; });
}

FlipChecks::Found FlipChecks::found(std::span<const TrialNumbers> numbers) {
    constexpr double near = 0.01;
    std::vector<double> errors;
    Found all;
    for (const auto& trial : numbers)
        for (const auto& [ours, reference] : rows_of<CheckRow>(trial)) {
            if (std::isnan(ours) || std::isnan(reference)) continue;
            const bool both = std::isfinite(ours) && std::isfinite(reference);
            if (both) errors.push_back(std::abs(ours - reference));
            all.flip += std::isfinite(ours) || std::isfinite(reference);
            all.agreeing += both && errors.back() <= near;
        }
    if (errors.empty()) return all;
    std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
    all.median = errors[errors.size() / 2];
    return all;
}

std::string FlipChecks::words(std::span<const TrialNumbers> numbers) const {
    const auto of = found(numbers);
    const auto drawn = fmt::format(": of {} releases drawn by lot, ", count_);
    if (of.flip == 0) return drawn + fmt::format("none flips within {} s, nor by a reference at 10⁻¹⁴", spec_.duration);
    return drawn +
           fmt::format(
               "{} flip, {} of them within 0.01 s of a reference at 10⁻¹⁴ (so of all that flip, with 95 % confidence, "
               "{:.1f} % at least){}",
               of.flip, of.agreeing, 100 * share_at_least(of.agreeing, of.flip),
               std::isnan(of.median) ? "" : fmt::format(", half of them within {} s", scientific(of.median)));
}

std::vector<Finding> FlipChecks::findings(std::span<const TrialNumbers> numbers) const {
    const auto of = found(numbers);
    return {{"checked_releases", static_cast<double>(count_)},
            {"checked_that_flip", static_cast<double>(of.flip)},
            {"checked_within_10_ms", of.flip == 0 ? NAN : static_cast<double>(of.agreeing) / of.flip},
            {"within_10_ms_at_least", share_at_least(of.agreeing, of.flip)},
            {"checked_median_error_s", of.median}};
}

}  // namespace doppel
