#include "fit/beginning.hpp"

#include "base/error.hpp"
#include "fit/flow.hpp"
#include "fit/variation.hpp"
#include "track/regression.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

using enum FitParameter;

/// A segment, and the one of the division of which it is a part.
struct Part {
    TrackSegment segment;
    std::size_t whole = 0;
    ArmState<double> start{};
};

/// Each segment in `most` parts, or a half, a quarter … as many where these would be too short.
std::vector<Part> parts_of(const Track& track, const std::vector<TrackSegment>& segments, std::size_t most) {
    constexpr std::size_t least_samples = 8;
    constexpr double least_s = 0.15;
    std::vector<Part> parts;
    for (std::size_t k = 0; k < segments.size(); ++k) {
        const auto& times = track.pieces[segments[k].piece].time_s;
        const double begin = times[segments[k].first], length = times[segments[k].last - 1] - begin;
        auto count = most;
        while (count > 1 &&
               (length < least_s * static_cast<double>(count) || segments[k].size() < least_samples * count))
            count /= 2;
        auto first = segments[k].first;
        for (std::size_t part = 1; part <= count; ++part) {
            const double end = begin + length * static_cast<double>(part) / static_cast<double>(count);
            auto last = static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), end) - times.begin());
            if (part == count) last = segments[k].last;
            if (last < first + least_samples && part < count) continue;  // a gap
            parts.push_back({{segments[k].piece, first, last}, k});
            first = last;
        }
    }
    return parts;
}

/// Whether the motion of one part follows the samples of the next to its end, and an error of its start grows no more
/// than a hundredfold until then: beyond, the cost has many minima, and normal equations lose their digits.
bool leads(const Track& track, const Fit& fit, const Part& one, const Part& next) {
    constexpr double near = 0.3, most_growth = 100;  // rad; of an angle, per angle or per rate over the pendulum's own
    const auto& piece = track.pieces[one.segment.piece];
    using Number = Dual<double, 4>;
    ArmState<Number> start;
    for (std::size_t q = 0; q < 4; ++q) start[q] = Number::variable(one.start[q], static_cast<Eigen::Index>(q));
    const VaryingArms<4> arms{.arms = arms_of(fit.model, fit.parameters), .direction = {}};
    Flow<Number, VaryingArms<4>> flow(arms, start, fit.rules.step_s);
    const double rate = std::sqrt(fit.parameters[index_of(gravity_2)]);
    for (auto i = next.segment.first; i < next.segment.last; ++i) {
        const double t = piece.time_s[i] - piece.time_s[one.segment.first];
        if (!flow.reach(t)) return false;
        for (std::size_t arm = 0; arm < 2; ++arm) {
            if (!piece.is_outlier[arm][i] && std::abs(flow.angle_value(arm, t) - piece.angle[arm][i]) > near)
                return false;
            const auto& by = flow.state()[arm].tangent;
            if (std::hypot(by.head<2>().norm(), rate * by.tail<2>().norm()) > most_growth) return false;
        }
    }
    return true;
}

std::vector<Part> joined(const Track& track, const Fit& fit, const std::vector<Part>& parts) {
    std::vector<Part> result;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        result.push_back(parts[k]);
        const bool pair = k + 1 < parts.size() && parts[k + 1].whole == parts[k].whole;
        if (pair && leads(track, fit, parts[k], parts[k + 1])) result.back().segment.last = parts[++k].segment.last;
    }
    return result;
}

/// Parts that do not follow their samples, halved; what begins anew is guessed.
std::vector<Part> without_lost(const Track& track, const Fit& fit, const std::vector<Part>& parts) {
    constexpr double lost = 0.1;  // rad, rms
    constexpr std::size_t least_samples = 16;
    std::vector<Part> result;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const auto& sums = fit.sums[k];
        const auto& segment = parts[k].segment;
        const bool is_lost = sums.squares > lost * lost * static_cast<double>(sums.count);
        if (!is_lost || segment.size() < least_samples) {
            result.push_back(parts[k]);
            continue;
        }
        const auto middle = segment.first + segment.size() / 2;
        for (const auto& half :
             {TrackSegment{segment.piece, segment.first, middle}, TrackSegment{segment.piece, middle, segment.last}})
            result.push_back({half, parts[k].whole, guessed_start(track, half)});
    }
    return result;
}

/// Fits the parts; their starts move along.
Fit fitted(const Track& track, std::vector<Part>& parts, Fit fit, int jobs, const std::atomic<bool>& stop) {
    std::vector<TrackSegment> segments;
    fit.starts.clear();
    fit.sums.clear();  // of another division, or another model
    for (const auto& part : parts) {
        segments.push_back(part.segment);
        fit.starts.push_back(part.start);
    }
    fit = fit_model(track, segments, std::move(fit),
                    {.most_passes = 10, .finds_step = false, .relative = 1e-3, .jobs = jobs}, stop);
    for (std::size_t k = 0; k < parts.size(); ++k) parts[k].start = fit.starts[k];
    return fit;
}

Parameters regressed(const Track& track, const std::atomic<bool>& stop) {
    // a swing of little acceleration wants longer windows than its noise alone
    Regression regression;
    for (const double longer : {1.0, 1.5, 2.25}) {
        const auto other = regress(glimpses_of(track, stop, longer));
        if (longer == 1 ||
            (other.is_physical && (!regression.is_physical || other.unexplained < regression.unexplained)))
            regression = other;
    }
    if (!regression.is_physical)
        throw method_failed(
            "{}: no double pendulum moves like this: its equations leave {:.0f} % of the forces unexplained",
            track.pieces.front().name, 100 * regression.unexplained);
    auto p = regression.parameters;
    const double most_coupling = 0.95 * std::sqrt(p[index_of(inertia)]);
    p[index_of(coupling)] = std::min(p[index_of(coupling)], most_coupling);
    return p;
}

/// Fits parts, joined as far as one leads to the next.
std::pair<Fit, std::vector<Part>> fitted_in_parts(const Track& track, const std::vector<TrackSegment>& segments,
                                                  std::size_t most, const Parameters& guess, int jobs,
                                                  const std::atomic<bool>& stop) {
    auto parts = parts_of(track, segments, most);
    for (auto& part : parts) part.start = guessed_start(track, part.segment);
    Fit fit{};
    fit.parameters = guess;
    fit.rules.scale = {std::max(3 * track.noise[0], 1e-3), std::max(3 * track.noise[1], 1e-3)};
    fit.model.fitted = {inertia, coupling, gravity_1, gravity_2, offset_1, offset_2};
    fit = fitted(track, parts, std::move(fit), jobs, stop);
    parts = without_lost(track, fit, parts);
    fit.model.fitted = {inertia,   coupling,  gravity_1,   gravity_2,   viscous_1, viscous_2,
                        coulomb_1, coulomb_2, quadratic_1, quadratic_2, offset_1,  offset_2};
    for (auto joins = most; joins > 1; joins /= 2) {
        fit = fitted(track, parts, std::move(fit), jobs, stop);
        parts = joined(track, fit, without_lost(track, fit, parts));
    }
    fit = fitted(track, parts, std::move(fit), jobs, stop);
    return {std::move(fit), std::move(parts)};
}

}  // namespace

Beginning begin_fit(const Track& track, int jobs, const std::atomic<bool>& stop) {
    Beginning beginning{.division = divide(track), .fit = {}};
    const auto guess = regressed(track, stop);
    constexpr std::size_t quarters = 4, shortest = 16;
    const auto begun = [&] {
        for (auto most = quarters;; most *= 2) try {
                return fitted_in_parts(track, beginning.division.segments, most, guess, jobs, stop);
            } catch (const Error& error) {  // shorter ones may stay finite
                if (error.code() != ExitCode::method_failed || most == shortest) throw;
            }
    };
    auto [fit, parts] = begun();
    // units as they were, of the segments as they are
    auto& division = beginning.division;
    const bool by_piece = division.units.size() == track.pieces.size() && track.pieces.size() > 1;
    division.segments.clear();
    division.units.clear();
    fit.starts.clear();
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const bool is_new = k == 0 || (by_piece ? parts[k].segment.piece != parts[k - 1].segment.piece
                                                : parts[k].whole != parts[k - 1].whole);
        if (is_new) division.units.emplace_back();
        division.units.back().push_back(k);
        division.segments.push_back(parts[k].segment);
        fit.starts.push_back(parts[k].start);
    }
    beginning.fit = std::move(fit);
    return beginning;
}

}  // namespace doppel
