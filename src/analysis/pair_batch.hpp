#pragma once

#include "integrate/batch.hpp"

#include <atomic>
#include <functional>
#include <span>

namespace doppel {

/// Two pendulums to compare, with the same number of links.
struct PendulumPair {
    Pendulum<double> a, b;
};

/// How they are integrated and sampled.
struct PairBatchSpec {
    MotionSpec a, b;   // model, method, step size and sample interval of each side, the same for all pairs
    long samples = 0;  // without the one at time 0
};

/// A good number of pendulums to integrate at once: two of the widest registers. It is the same on all machines, so that
/// the trials of a figure are.
inline constexpr std::size_t pendulums_together = 16;

/// Integrates all pairs side by side; `watch` is called for every trial at every sample 0 … N, in the order of samples.
/// Each trial gives the same bits whatever it is integrated with, because each lane does what a single double would.
/// Pendulums that several pairs share are integrated once. Failed runs give NaN or infinity. Errors: those of Batch;
/// exit 130 soon after `stop` is set.
using PairObserver = std::function<void(std::size_t trial, long sample, const Bobs<double>& a, const Bobs<double>& b)>;
void step_pairs(std::span<const PendulumPair> pairs, const PairBatchSpec& run, const PairObserver& watch,
                const std::atomic<bool>& stop);

}  // namespace doppel
