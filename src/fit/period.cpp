#include "fit/period.hpp"

#include "base/error.hpp"
#include "fit/flow.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {

std::optional<Period> find_period(const FitJob& job, const Fit& fit) {
    constexpr double longest = 4, apart_s = 0.15, close = 0.05, times = 3, diverged = 0.25;
    const auto& track = job.track;
    const auto pieces = track.pieces.size();
    if (pieces < 3) return std::nullopt;
    double shortest = track.pieces[0].duration();
    for (const auto& piece : track.pieces) shortest = std::min(shortest, piece.duration());
    // the state at the start of each piece, and the motion of each far beyond its end: rates in units of the pendulums' own
    const double step = fit.rules.step_s, rate = std::sqrt(fit.of(FitParameter::gravity_2));
    const auto in_units = [&](const ArmState<double>& y) {
        return Eigen::Vector4d(y[0], y[1], y[2] / rate, y[3] / rate);
    };
    std::vector<ArmState<double>> starts(pieces);
    for (std::size_t k = fit.segments.size(); k-- > 0;) starts[fit.segments[k].piece] = fit.starts[k];
    const auto count = static_cast<std::size_t>(longest * shortest / step);
    const auto from = static_cast<std::size_t>(0.95 * shortest / step);
    std::vector<std::vector<Eigen::Vector4d>> motions(pieces - 1);
    std::vector<double> distance(count, 0);  // of the ends, mean square, for each interval
    for (std::size_t k = 0; k + 1 < pieces; ++k) {
        throw_if_set(job.stop);
        Flow<double> flow(arms_of(fit.model, fit.parameters), starts[k], step);
        const auto next = in_units(starts[k + 1]);
        for (std::size_t i = 0; i < count; ++i) {
            flow.reach(static_cast<double>(i) * step);
            motions[k].push_back(in_units(flow.values_at(static_cast<double>(i) * step)));
            distance[i] += std::min((motions[k][i] - next).squaredNorm(), 1.0) / static_cast<double>(pieces - 1);
        }
    }
    const auto best = static_cast<std::size_t>(
        std::min_element(distance.begin() + static_cast<std::ptrdiff_t>(from), distance.end() - 1) - distance.begin());
    double rival = 1;
    for (std::size_t i = from; i < count; ++i)
        if (std::abs(static_cast<double>(i) - static_cast<double>(best)) * step > apart_s)
            rival = std::min(rival, distance[i]);
    if (distance[best] > close || rival < times * distance[best]) return std::nullopt;
    // between the steps: the shift along each motion that brings the ends together, without those that have diverged
    double along = 0, speed = 0, rest = 0, used = 0;
    for (std::size_t k = 0; k + 1 < pieces; ++k) {
        const Eigen::Vector4d off = in_units(starts[k + 1]) - motions[k][best];
        if (off.squaredNorm() > diverged) continue;
        const Eigen::Vector4d slope = (motions[k][best + 1] - motions[k][best - 1]) / (2 * step);
        along += off.dot(slope), speed += slope.squaredNorm(), rest += off.squaredNorm(), used += 4;
    }
    const double shift = along / speed;
    rest -= shift * along;
    return Period{static_cast<double>(best) * step + shift, std::sqrt(rest / std::max(used - 1, 1.0) / speed)};
}

}  // namespace doppel
