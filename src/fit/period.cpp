#include "base/error.hpp"
#include "fit/flow.hpp"
#include "fit/horizon.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace doppel {
namespace {

/// Distance of two states in units of angle: rates by the pendulums' own.
double square_distance(const ArmState<double>& a, const ArmState<double>& b, double rate) {
    double sum = 0;
    for (std::size_t q = 0; q < 2; ++q) sum += std::pow(a[q] - b[q], 2) + std::pow((a[q + 2] - b[q + 2]) / rate, 2);
    return sum;
}

}  // namespace

std::optional<Period> find_period(const Track& track, const Division& division, const Fit& fit,
                                  const std::atomic<bool>& stop) {
    const auto pieces = track.pieces.size();
    if (pieces < 3) return std::nullopt;
    double shortest = track.pieces[0].duration();
    for (const auto& piece : track.pieces) shortest = std::min(shortest, piece.duration());
    auto arms = arms_of(fit.model, fit.parameters);
    const double step = fit.rules.step_s, rate = std::sqrt(fit.parameters[index_of(FitParameter::gravity_2)]);
    // the state at the start of each piece, and the motion of each far beyond its end
    std::vector<ArmState<double>> starts(pieces);
    for (std::size_t k = division.segments.size(); k-- > 0;) starts[division.segments[k].piece] = fit.starts[k];
    constexpr double longest = 4;
    const auto looks = static_cast<std::size_t>(longest * shortest / step);
    std::vector<std::vector<ArmState<double>>> motions;
    for (std::size_t k = 0; k + 1 < pieces; ++k) {
        throw_if_set(stop);
        Flow<double> flow(arms, starts[k], step);
        auto& motion = motions.emplace_back();
        for (std::size_t i = 0; i < looks; ++i) {
            const double t = static_cast<double>(i) * step;
            flow.reach(t);
            motion.push_back(flow.values_at(t));
        }
    }
    // how far the ends are off, whole turns aside, for each interval
    const auto off = [&](std::size_t look) {
        double sum = 0;
        for (std::size_t k = 0; k + 1 < pieces; ++k)
            sum += std::min(square_distance(motions[k][look], starts[k + 1], rate), 1.0);
        return sum / static_cast<double>(pieces - 1);
    };
    const auto from = static_cast<std::size_t>(0.95 * shortest / step);
    std::size_t best = from;
    std::vector<double> all(looks, 1);
    for (std::size_t look = from; look < looks; ++look) {
        throw_if_set(stop);
        all[look] = off(look);
        if (all[look] < all[best]) best = look;
    }
    constexpr double apart_s = 0.15, close = 0.05, times = 3;
    double rival = 1;
    for (std::size_t look = from; look < looks; ++look)
        if (std::abs(static_cast<double>(look) - static_cast<double>(best)) * step > apart_s)
            rival = std::min(rival, all[look]);
    if (all[best] > close || rival < times * all[best]) return std::nullopt;
    // between the looks: the shift along each motion that brings the ends together, without those that have parted
    double along = 0, speed = 0, rest = 0, count = 0;
    for (std::size_t k = 0; k + 1 < pieces; ++k) {
        const auto& state = motions[k][best];
        if (square_distance(state, starts[k + 1], rate) > 0.25) continue;
        arms.take_modes(state[2], state[3]);
        const auto slope = arms.rate(state);
        for (std::size_t q = 0; q < 4; ++q) {
            const double unit = q < 2 ? 1 : rate, d = (starts[k + 1][q] - state[q]) / unit, v = slope[q] / unit;
            along += d * v, speed += v * v, rest += d * d, ++count;
        }
    }
    const double shift = along / speed;
    rest -= shift * along;
    return Period{static_cast<double>(best) * step + shift, std::sqrt(rest / std::max(count - 1, 1.0) / speed)};
}

}  // namespace doppel
