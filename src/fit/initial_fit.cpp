#include "fit/initial_fit.hpp"

#include "base/error.hpp"
#include "fit/flow.hpp"
#include "track/regression.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

double length_of(const Track& track, const Shot& shot) {
    const auto& times = track.pieces[shot.piece].time_s;
    return times[shot.last - 1] - times[shot.first];
}

/// Adds `count` equal parts of a stretch, with estimated starts; fewer if there are gaps.
void add_parts(std::vector<Shot>& parts, const Track& track, const Shot& all, long count) {
    constexpr std::size_t min_samples = 8;
    const auto& times = track.pieces[all.piece].time_s;
    auto part = all;
    for (long number = 1; number <= count; ++number) {
        const double share = static_cast<double>(number) / static_cast<double>(count);
        const auto end = std::lower_bound(times.begin(), times.end(), times[all.first] + length_of(track, all) * share);
        part.last = number == count ? all.last : static_cast<std::size_t>(end - times.begin());
        if (part.last < part.first + min_samples && number < count) continue;  // a gap
        part.start = estimated_start(track, part.piece, part.first);
        parts.push_back(part);
        part.first = part.last;
    }
}

/// Each stretch in `maximum` parts, or a half, a quarter … of that number if the parts would be too short.
std::vector<Shot> parts_of(const Track& track, const std::vector<Shot>& wholes, long maximum) {
    constexpr double min_samples = 8, min_s = 0.15;
    std::vector<Shot> parts;
    for (const auto& whole : wholes) {
        const double longest =
            std::min(length_of(track, whole) / min_s, static_cast<double>(whole.size()) / min_samples);
        auto count = maximum;
        while (count > 1 && static_cast<double>(count) > longest) count /= 2;
        add_parts(parts, track, whole, count);
    }
    return parts;
}

/// Whether the motion of one shot follows the samples of the next one to its end. An initial error may grow at most a
/// hundredfold up to there. Beyond that the cost has many minima, and the normal equations lose their digits.
bool leads_to(const Track& track, const Fit& fit, const Shot& one, const Shot& next) {
    constexpr double near = 0.3, max_growth = 100;  // rad; growth of an angle, per angle or per rate in natural units
    const auto& piece = track.pieces[one.piece];
    Flow<> flow(fit.model, fit.parameters, one.start, fit.step_s);
    const double rate = std::sqrt(fit.parameters[gravity_2]);
    for (auto i = next.first; i < next.last; ++i) {
        const double t = piece.time_s[i] - piece.time_s[one.first];
        if (!flow.reach(t)) return false;
        for (std::size_t link = 0; link < 2; ++link) {
            const auto angle = flow.angle(link, t);
            if (!piece.is_outlier[link][i] && std::abs(angle[0] - piece.angle[link][i]) > near) return false;
            if (std::hypot(angle.segment<2>(1).norm(), rate * angle.segment<2>(3).norm()) > max_growth) return false;
        }
    }
    return true;
}

/// Joins each shot with the next one if it leads through that one.
void join(const Track& track, Fit& fit) {
    std::vector<Shot> joined;
    for (auto next = fit.shots.begin(); next != fit.shots.end();) {
        auto& one = joined.emplace_back(std::move(*next++));
        if (next != fit.shots.end() && next->whole == one.whole && leads_to(track, fit, one, *next))
            one.last = next++->last;
    }
    fit.shots = std::move(joined);
}

/// Halves the shots that do not follow their samples; new starts are estimated.
void halve_lost(const Track& track, Fit& fit) {
    constexpr double lost = 0.1;  // rad, rms
    constexpr std::size_t min_samples = 16;
    std::vector<Shot> halved;
    for (const auto& shot : fit.shots) {
        const bool is_lost = shot.sums.squares > lost * lost * static_cast<double>(shot.sums.count);
        if (is_lost && shot.size() >= min_samples)
            add_parts(halved, track, shot, 2);
        else
            halved.push_back(shot);
    }
    fit.shots = std::move(halved);
}

Parameters regressed(const Track& track, const std::atomic<bool>& stop) {
    // a slow swing requires longer windows than its noise alone
    Regression best;
    for (const double longer : {1.0, 1.5, 2.25}) {
        const auto other = regress(estimates_of(track, stop, longer));
        if (longer == 1 || (other.is_physical && (!best.is_physical || other.unexplained < best.unexplained)))
            best = other;
    }
    if (!best.is_physical)
        throw method_failed(
            "{}: this is not the motion of a double pendulum: its equations leave {:.0f} % of the forces unexplained",
            track.pieces.front().name, 100 * best.unexplained);
    Parameters p = Parameters::Zero();
    std::ranges::copy(best.ratios, p.begin());
    p[coupling] = std::min(p[coupling], 0.95 * std::sqrt(p[inertia]));
    p[scale_1] = p[scale_2] = 1;
    return p;
}

/// Fits stretches in parts, which are joined where one leads to the next.
std::optional<Fit> fitted_in_parts(const FitJob& job, const std::vector<Shot>& wholes, long maximum,
                                   const Parameters& guess) {
    const auto& track = job.track;
    std::optional<Fit> fit{
        {.model = model_of(false, 0), .parameters = guess, .shots = parts_of(track, wholes, maximum)}};
    fit->scale = {std::max(3 * track.noise[0], 1e-3), std::max(3 * track.noise[1], 1e-3)};
    for (auto parts = 2 * maximum; parts > 0; parts /= 2) {
        fit->is_evaluated = false;  // it is of other shots, or another model
        fit = fit_model(job, *std::move(fit), {.max_passes = 10, .step_share = 0, .relative = 1e-3});
        if (!fit || parts == 1) break;
        halve_lost(track, *fit);
        if (parts <= maximum) join(track, *fit);
        fit->model = model_of(false, 3);
    }
    return fit;
}

}  // namespace

std::vector<Shot> divide(const Track& track) {
    constexpr double longest = 3, shortest = 0.5, wanted = 8;
    constexpr std::size_t few_pieces = 4;
    const double length = std::clamp(track.duration() / wanted, shortest, longest);
    const bool by_piece = track.pieces.size() >= few_pieces;
    std::vector<Shot> wholes;
    for (std::size_t piece = 0; piece < track.pieces.size(); ++piece)
        add_parts(wholes, track, {.piece = piece, .last = track.pieces[piece].size()},
                  std::max(1L, std::lround(std::ceil(track.pieces[piece].duration() / length - 0.01))));
    for (std::size_t k = 0; k < wholes.size(); ++k) {
        wholes[k].whole = k;
        wholes[k].unit = by_piece ? wholes[k].piece : k;
    }
    return wholes;
}

Fit initial_fit(const FitJob& job) {
    const auto wholes = divide(job.track);
    const auto guess = regressed(job.track, job.stop);
    constexpr long quarters = 4, shortest = 16;
    for (auto maximum = quarters; maximum <= shortest; maximum *= 2)  // the motion may stay finite over shorter parts
        if (auto fit = fitted_in_parts(job, wholes, maximum, guess)) return *fit;
    throw no_motion(job.track);
}

}  // namespace doppel
