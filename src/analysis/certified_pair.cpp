#include "analysis/certified_pair.hpp"

#include "analysis/enclosure.hpp"
#include "base/threads.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>

namespace doppel {
namespace {

template <class Scalar>
using EnclosedMotion = std::vector<EnclosedState<Scalar>>;

/// m, x, y, vx, vy of both masses
template <class B>
std::array<B, 10> masses_of(const DecimalPendulum& p, const std::array<B, 4>& state) {
    std::array<B, 10> all;
    B x(0), y(0), vx(0), vy(0);
    for (std::size_t i = 0; i < 2; ++i) {
        const B length = ball_of_decimal<B>(p.length[i]);
        const SinCos<B> turn(state[i]);
        x += length * turn.sin;
        y -= length * turn.cos;
        vx += length * state[i + 2] * turn.cos;
        vy += length * state[i + 2] * turn.sin;
        std::copy_n(std::array{ball_of_decimal<B>(p.mass[i]), x, y, vx, vy}.begin(), 5, all.begin() + 5 * i);
    }
    return all;
}

template <class B>
Interval distance_of(const std::array<B, 10>& a, const std::array<B, 10>& b) {
    double low = 0, high = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const B difference = a[i] - b[i];
        const double least = std::max(0.0, difference.least()), most = difference.size();
        low += least * least;
        high = widened(high + most * most);
    }
    return {std::sqrt(low) * (1 - 0x1p-48), widened(std::sqrt(high))};
}

template <class Scalar>
CertifiedPair enclosed_pair(const CertifiedPairSpec& spec, double largest_radius, const CertifiedReport& report) {
    const bool are_same = spec.sides.size() == 2 && spec.sides[0] == spec.sides[1];
    const std::size_t count = are_same ? 1 : spec.sides.size();
    std::vector<EnclosedMotion<Scalar>> motions(count);
    std::vector<long> done(count);
    std::mutex reporting;
    parallel_for(count, spec.jobs, [&](std::size_t i) {
        const auto watch = [&](long samples) {
            const std::lock_guard lock(reporting);
            done[i] = samples;
            report(std::accumulate(done.begin(), done.end(), 0L), static_cast<long>(count) * (spec.samples + 1));
        };
        EnclosureSpec one;
        one.interval = spec.interval;
        one.samples = spec.samples;
        one.largest_radius = largest_radius;
        motions[i] = enclosures(spec.sides[i], enclosed_start<Scalar>(spec.sides[i]), one, watch);
    });
    std::size_t proved = motions.front().size();
    for (const auto& motion : motions) proved = std::min(proved, motion.size());
    CertifiedPair pair;
    for (const auto& motion : motions) {
        auto& bounds = pair.sides.emplace_back();
        auto& radius = pair.radius.emplace_back();
        for (std::size_t n = 0; n < proved; ++n) {
            auto& row = bounds.emplace_back();
            for (std::size_t i = 0; i < 4; ++i) row[i] = {motion[n][i].low(), motion[n][i].high()};
            radius.push_back(std::max(motion[n][0].radius, motion[n][1].radius));
        }
    }
    if (are_same) {
        pair.sides.push_back(pair.sides.front());
        pair.radius.push_back(pair.radius.front());
        pair.distance.resize(proved);
    } else if (count == 2) {
        for (std::size_t n = 0; n < proved; ++n)
            pair.distance.push_back(
                distance_of(masses_of(spec.sides[0], motions[0][n]), masses_of(spec.sides[1], motions[1][n])));
    }
    return pair;
}

/// Whether the distance is known to 1 % at all samples but the first, where it may be 0.
bool is_sharp(const std::vector<Interval>& distance) {
    return std::all_of(distance.begin() + (distance.empty() ? 0 : 1), distance.end(),
                       [](const Interval& d) { return d.high - d.low <= 0.01 * d.high; });
}

}  // namespace

CertifiedPair certified_pair(const CertifiedPairSpec& spec, const CertifiedReport& report) {
    constexpr double lost = 0.5;  // rad or rad/s
    using Enclose = CertifiedPair (*)(const CertifiedPairSpec&, double, const CertifiedReport&);
    constexpr std::array<Enclose, 3> with_bits{enclosed_pair<double>, enclosed_pair<Quad>, enclosed_pair<Wide>};
    for (std::size_t i = 0;; ++i) {
        if (spec.bits && certified_bits[i] != *spec.bits) continue;
        const bool is_last = spec.bits || i + 1 == certified_bits.size();
        auto pair = with_bits[i](spec, is_last ? lost : spec.sufficient_radius, report);
        pair.bits = certified_bits[i];
        const bool is_whole = static_cast<long>(pair.samples()) == spec.samples + 1;
        if (is_last || (is_whole && is_sharp(pair.distance))) return pair;
    }
}

}  // namespace doppel
