#include "fit/beginning.hpp"

#include "base/error.hpp"
#include "fit/flow.hpp"
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

double length_of(const Track& track, const TrackSegment& segment) {
    const auto& times = track.pieces[segment.piece].time_s;
    return times[segment.last - 1] - times[segment.first];
}

/// So many parts of a segment of even length; fewer where there are gaps.
std::vector<TrackSegment> cut(const Track& track, const TrackSegment& segment, long count) {
    constexpr std::size_t least_samples = 8;
    const auto& times = track.pieces[segment.piece].time_s;
    std::vector<TrackSegment> parts;
    auto first = segment.first;
    for (long part = 1; part <= count; ++part) {
        const double share = static_cast<double>(part) / static_cast<double>(count);
        const double end = times[segment.first] + length_of(track, segment) * share;
        const auto last =
            part == count ? segment.last
                          : static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), end) - times.begin());
        if (last < first + least_samples && part < count) continue;  // a gap
        parts.push_back({segment.piece, first, last});
        first = last;
    }
    return parts;
}

/// Each segment in `most` parts, or a half, a quarter … as many where these would be too short.
std::vector<Part> parts_of(const Track& track, const std::vector<TrackSegment>& segments, long most) {
    constexpr double least_samples = 8, least_s = 0.15;
    std::vector<Part> parts;
    for (std::size_t k = 0; k < segments.size(); ++k) {
        const double longest =
            std::min(length_of(track, segments[k]) / least_s, static_cast<double>(segments[k].size()) / least_samples);
        auto count = most;
        while (count > 1 && static_cast<double>(count) > longest) count /= 2;
        for (const auto& segment : cut(track, segments[k], count))
            parts.push_back({segment, k, guessed_start(track, segment)});
    }
    return parts;
}

/// Whether the motion of one part follows the samples of the next to its end, and an error of its start grows no more
/// than a hundredfold until then: beyond, the cost has many minima, and normal equations lose their digits.
bool leads(const Track& track, const Fit& fit, const Part& one, const Part& next) {
    constexpr double near = 0.3, most_growth = 100;  // rad; of an angle, per angle or per rate over the pendulum's own
    const auto& piece = track.pieces[one.segment.piece];
    auto flow = varied_flow<few_directions>(fit.model, fit.parameters, one.start, fit.rules.step_s);
    const double rate = std::sqrt(fit.of(gravity_2));
    for (auto i = next.segment.first; i < next.segment.last; ++i) {
        const double t = piece.time_s[i] - piece.time_s[one.segment.first];
        if (!flow.reach(t)) return false;
        for (std::size_t arm = 0; arm < 2; ++arm) {
            const auto angle = flow.angle(arm, t);
            if (!piece.is_outlier[arm][i] && std::abs(angle.value - piece.angle[arm][i]) > near) return false;
            const auto& by = angle.tangent;
            if (std::hypot(by.head<2>().norm(), rate * by.segment<2>(2).norm()) > most_growth) return false;
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
        const bool is_lost = fit.sums[k].squares > lost * lost * static_cast<double>(fit.sums[k].count);
        if (!is_lost || parts[k].segment.size() < least_samples)
            result.push_back(parts[k]);
        else
            for (const auto& half : cut(track, parts[k].segment, 2))
                result.push_back({half, parts[k].whole, guessed_start(track, half)});
    }
    return result;
}

/// Fits the parts; their starts move along.
Fit fitted(const FitJob& job, std::vector<Part>& parts, Fit fit) {
    fit.segments.clear();
    fit.starts.clear();
    fit.sums.clear();  // of another division, or another model
    for (const auto& part : parts) {
        fit.segments.push_back(part.segment);
        fit.starts.push_back(part.start);
    }
    fit = fit_model(job, std::move(fit), {.most_passes = 10, .step_share = 0, .relative = 1e-3});
    for (std::size_t k = 0; k < parts.size(); ++k) parts[k].start = fit.starts[k];
    return fit;
}

Parameters regressed(const Track& track, const std::atomic<bool>& stop) {
    // a swing of little acceleration wants longer windows than its noise alone
    Regression best;
    for (const double longer : {1.0, 1.5, 2.25}) {
        const auto other = regress(glimpses_of(track, stop, longer));
        if (longer == 1 || (other.is_physical && (!best.is_physical || other.unexplained < best.unexplained)))
            best = other;
    }
    if (!best.is_physical)
        throw method_failed(
            "{}: no double pendulum moves like this: its equations leave {:.0f} % of the forces unexplained",
            track.pieces.front().name, 100 * best.unexplained);
    Parameters p{best.inertia, std::min(best.coupling, 0.95 * std::sqrt(best.inertia)), best.gravity[0],
                 best.gravity[1]};
    p[index_of(scale_1)] = p[index_of(scale_2)] = 1;
    return p;
}

/// Fits parts, joined as far as one leads to the next.
std::pair<std::vector<Part>, Fit> fitted_in_parts(const FitJob& job, const std::vector<TrackSegment>& segments,
                                                  long most, const Parameters& guess) {
    const auto& track = job.track;
    auto parts = parts_of(track, segments, most);
    Fit fit{.model = {}, .rules = {}, .parameters = guess, .segments = {}, .starts = {}, .sums = {}};
    fit.rules.scale = {std::max(3 * track.noise[0], 1e-3), std::max(3 * track.noise[1], 1e-3)};
    fit.model.fitted = {inertia, coupling, gravity_1, gravity_2, offset_1, offset_2};
    fit = fitted(job, parts, std::move(fit));
    parts = without_lost(track, fit, parts);
    fit.model.fitted = {inertia,   coupling,  gravity_1,   gravity_2,   viscous_1, viscous_2,
                        coulomb_1, coulomb_2, quadratic_1, quadratic_2, offset_1,  offset_2};
    for (auto joins = most; joins > 1; joins /= 2) {
        fit = fitted(job, parts, std::move(fit));
        parts = joined(track, fit, without_lost(track, fit, parts));
    }
    fit = fitted(job, parts, std::move(fit));
    return {std::move(parts), std::move(fit)};
}

}  // namespace

Division divide(const Track& track) {
    constexpr double longest = 3, shortest = 0.5, wanted = 8;
    constexpr std::size_t few_pieces = 4;
    const double length = std::clamp(track.duration() / wanted, shortest, longest);
    const bool by_piece = track.pieces.size() >= few_pieces;
    Division division;
    for (std::size_t piece = 0; piece < track.pieces.size(); ++piece) {
        const auto parts = std::max(1L, std::lround(std::ceil(track.pieces[piece].duration() / length - 0.01)));
        if (by_piece) division.units.emplace_back();
        for (const auto& segment : cut(track, {piece, 0, track.pieces[piece].size()}, parts)) {
            if (!by_piece) division.units.emplace_back();
            division.units.back().push_back(division.segments.size());
            division.segments.push_back(segment);
        }
    }
    return division;
}

std::pair<Units, Fit> begin_fit(const FitJob& job) {
    auto division = divide(job.track);
    const auto guess = regressed(job.track, job.stop);
    constexpr long quarters = 4, shortest = 16;
    const auto begun = [&] {
        for (auto most = quarters;; most *= 2) try {
                return fitted_in_parts(job, division.segments, most, guess);
            } catch (const Error& error) {  // shorter ones may stay finite
                if (error.code() != ExitCode::method_failed || most == shortest) throw;
            }
    };
    const auto [parts, fit] = begun();
    // units as they were, of the segments as they are
    for (auto& unit : division.units) {
        const auto wholes = std::exchange(unit, {});
        for (std::size_t k = 0; k < parts.size(); ++k)
            if (std::count(wholes.begin(), wholes.end(), parts[k].whole) > 0) unit.push_back(k);
    }
    return {division.units, fit};
}

}  // namespace doppel
