#include "figure/drift_growth.hpp"

#include "numeric/nan.hpp"

#include <cmath>
#include <vector>

namespace doppel {
namespace {

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
                  .doubling_s = nan_value,
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

std::string_view growth_words(Growth::Kind kind) {
    switch (kind) {
        case Growth::Kind::bounded:
            return "stays bounded";
        case Growth::Kind::root:
            return "grows like √t";
        case Growth::Kind::linear:
            return "grows linearly";
        case Growth::Kind::steeper:
            return "grows like t²";
        case Growth::Kind::breakdown:
            break;
    }
    return "breaks down";
}

}  // namespace doppel
