#include "scene/forecast.hpp"

#include "analysis/reference.hpp"
#include "scene/captions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

constexpr double diverged_error = 0.5;  // rad: a run with this error has diverged

/// Results of some runs: the samples at which they diverge, and the largest and smallest error of the others.
struct Ends {
    std::vector<long> lost;
    double min_error = diverged_error, max_error = 0;
};

Ends ends_of_fine_runs(const Side& side, const ReferenceTrajectory& reference, long samples,
                       const std::atomic<bool>& stop) {
    Ends ends;
    const auto add = [&](const std::vector<double>& error) {
        if (static_cast<long>(error.size()) <= samples || error.back() > diverged_error) {
            ends.lost.push_back(static_cast<long>(error.size()) - 1);
        } else {
            ends.min_error = std::min(ends.min_error, error.back());
            ends.max_error = std::max(ends.max_error, error.back());
        }
    };
    if (reference.is_wider) {
        for (const char* tolerance : {"3e-14", "1e-14", "3e-15", "2e-15", "1e-15"})
            add(error_history(by_taylor_series(side.motion, parse_quad(tolerance)), reference, diverged_error, stop)
                    .error);
    } else {
        add(reference.uncertainty);
    }
    return ends;
}

/// A chain of point masses without other parts.
bool is_plain_chain(const MotionSpec& motion) {
    if (motion.physical) return false;
    if (!motion.chain || !motion.parts) return motion.chain.has_value();
    return motion.parts->constraints.size() == motion.chain->links() && motion.parts->forces.size() <= 1;
}

Forecast::Kind kind_of(const Pendulum<double>& pendulum, const Exponent& exponent) {
    if (exponent.is_of_equilibrium()) return exponent.value > 0 ? Forecast::Kind::unstable : Forecast::Kind::regular;
    // a single link is regular, because it keeps its energy, even if its exponent decreases slowly near the upright
    // position
    return pendulum.links() == 1 || is_regular(exponent) ? Forecast::Kind::regular : Forecast::Kind::chaotic;
}

/// After the end, errors grow further by the exponent, whose mean over a time t varies like 1/√t.
std::optional<Forecast::Limit> limit_of(const Ends& ends, const Scene& scene, const Forecast& seen) {
    std::optional<Forecast::Limit> limit;
    if (!ends.lost.empty()) {
        const auto [first, last] = std::minmax_element(ends.lost.begin(), ends.lost.end());
        limit = {scene.time(*first), scene.time(*last)};
    }
    if (ends.max_error == 0) return limit;
    if (!seen.exponent || seen.kind == Forecast::Kind::regular) return std::nullopt;
    const auto time_to_grow = [&](double error, int sign) {
        const ExponentSpec spec;
        const double mean = seen.exponent->value, growth = std::log(diverged_error / error), time = growth / mean;
        const double spread = seen.exponent->uncertainty * std::sqrt((spec.duration_s - spec.transient_s) / time);
        return growth / std::max(mean + sign * spread, 0.5 * mean);
    };
    const double end = scene.time(scene.samples);
    const double first = end + time_to_grow(ends.max_error, 1), last = end + time_to_grow(ends.min_error, -1);
    return Forecast::Limit{limit ? limit->from : first, last};
}

}  // namespace

bool Forecast::is_off() const {
    return error > diverged_error;
}

Forecast forecast_of(const Scene& scene, const Side& side, const std::atomic<bool>& stop) {
    const auto known = side.choice ? side.choice->reference : nullptr;
    const auto& reference =
        known ? *known : reference_trajectory(side.motion, scene.samples, side.reach, diverged_error, stop);
    const auto history = error_history(side.motion, reference, diverged_error, stop);
    if (history.error.empty()) throw method_failed("the method fails at once");
    Forecast seen{.error = history.error.back(), .error_s = scene.time(static_cast<long>(history.error.size()) - 1)};

    constexpr std::size_t max_links = 12;
    if (is_plain_chain(side.motion) && side.motion.chain->links() <= max_links) {
        const auto pendulum = side.motion.chain->cast<double>();
        seen.exponent = largest_exponent(pendulum, {}, stop);
        seen.kind = kind_of(pendulum, *seen.exponent);
    }
    if (reference.failure.empty())
        seen.limit = limit_of(ends_of_fine_runs(side, reference, scene.samples, stop), scene, seen);
    return seen;
}

std::string error_words(const Side& side, double from_s) {
    return fmt::format("error above half {} from {} s on", side.has_angles ? "a rad" : "its size",
                       with_digits(from_s, 3));
}

std::optional<std::string> early_error(const Scene& scene, const Side& side, long last, const std::atomic<bool>& stop) {
    if (side.replay || (side.choice && side.choice->horizon >= last)) return std::nullopt;
    if (side.choice)
        return fmt::format("the accuracy is kept up to {} s", with_digits(scene.time(side.choice->horizon), 3));
    for (const double max_work : {0.0, max_quad_work}) {
        const auto reference = reference_trajectory(side.motion, last, side.reach, diverged_error, stop, max_work);
        const auto history = error_history(side.motion, reference, diverged_error, stop);
        if (history.error.empty() || !(history.error.back() > diverged_error)) return std::nullopt;
        const auto first = history.error.size() - 1;
        constexpr double matters = 0.02;  // of the error: then a reference in double is not exact enough
        if (max_work == 0 && reference.uncertainty[first] > matters * diverged_error) continue;
        return static_cast<long>(first) <= last ? std::optional(error_words(side, scene.time(static_cast<long>(first))))
                                                : std::nullopt;
    }
    return std::nullopt;
}

}  // namespace doppel
