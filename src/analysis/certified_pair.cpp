#include "analysis/certified_pair.hpp"

#include "analysis/difference.hpp"
#include "analysis/enclosure.hpp"
#include "base/error.hpp"
#include "base/threads.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>

namespace doppel {
namespace {

template <class Scalar>
Certificate enclosed_pair(const std::vector<EnclosedSystem>& sides, const CertifiedPairSpec& spec,
                          double largest_radius, const std::atomic<bool>& stop) {
    const bool are_same = sides.size() == 2 && sides[0] == sides[1];
    std::vector<std::vector<EnclosedState<Scalar>>> motions(are_same ? 1 : sides.size());
    std::vector<long> done(motions.size());
    std::mutex reporting;
    parallel_for(motions.size(), spec.jobs, [&](std::size_t i) {
        const EnclosureSpec one{.interval = spec.interval, .samples = spec.samples, .largest_radius = largest_radius};
        motions[i] = enclosures<Scalar>(sides[i], one, [&](long samples) {
            const std::lock_guard lock(reporting);
            throw_if_set(stop);
            done[i] = samples;
            if (!spec.report) return;
            spec.report(std::accumulate(done.begin(), done.end(), 0L),
                        static_cast<long>(done.size()) * (spec.samples + 1));
        });
    });
    if (are_same) motions.push_back(motions[0]);
    std::vector<Pendulum<Ball<Scalar>>> chains;
    for (const auto& side : sides) chains.push_back(side.chain.cast<Ball<Scalar>>());
    Certificate pair;
    for (std::size_t n = 0; n < std::min(motions.front().size(), motions.back().size()); ++n) {
        auto& row = pair.rows.emplace_back();
        for (const auto& motion : motions) {
            auto& side = row.sides.emplace_back();
            for (int i = 0; i < 4; ++i) side[i] = {motion[n][i].low(), motion[n][i].high()};
            row.radius = std::max({row.radius, motion[n][0].radius, motion[n][1].radius});
        }
        if (sides.size() < 2 || are_same) continue;
        const auto distance =
            state_space_distance(bobs_of_angles(chains[0], motions[0][n]), bobs_of_angles(chains[1], motions[1][n]));
        row.distance = {std::max(0.0, distance.low()), distance.high()};
    }
    return pair;
}

/// Whether the distance is known to 1 % at all samples but the first, where it may be 0.
bool is_sharp(const Certificate& pair) {
    return std::all_of(pair.rows.begin() + 1, pair.rows.end(), [](const Certificate::Row& row) {
        return row.distance.high - row.distance.low <= 0.01 * row.distance.high;
    });
}

}  // namespace

Certificate certified_pair(const std::vector<EnclosedSystem>& sides, const CertifiedPairSpec& spec,
                           const std::atomic<bool>& stop) {
    constexpr double sufficient = 1e-6, lost = 0.5;  // rad or rad/s
    constexpr std::array with_bits{enclosed_pair<double>, enclosed_pair<Quad>, enclosed_pair<Wide>};
    for (std::size_t i = 0;; ++i) {
        if (spec.bits && certified_bits[i] != *spec.bits) continue;
        const bool is_last = spec.bits || i + 1 == certified_bits.size();
        auto pair = with_bits[i](sides, spec, is_last ? lost : sufficient, stop);
        pair.bits = certified_bits[i];
        const bool is_whole = static_cast<long>(pair.rows.size()) == spec.samples + 1;
        if (is_last || (is_whole && is_sharp(pair))) return pair;
    }
}

double Certificate::run_until_s() const {
    double least = INFINITY;
    for (const auto& run : runs) least = std::min(least, run.until_s.value_or(0));
    return least;
}

}  // namespace doppel
