#pragma once

#include "integrate/batch.hpp"

#include <atomic>
#include <functional>
#include <span>

namespace doppel {

/// Two pendulums to be compared, of as many links each.
struct PendulumPair {
    Pendulum<double> a, b;
};

/// How they are integrated and sampled.
struct PairBatchSpec {
    MotionSpec a, b;   // the model, method, steps and sample interval of one side of all pairs
    long samples = 0;  // without the one at the start
};

/// How many pendulums are best integrated at once.
std::size_t pendulums_per_block();

/// Steps all pairs side by side; `watch` sees every trial at every sample 0 … N, the samples in their order.
///
/// Every trial is the same to the bit in any company: each lane does what a lone double would.
/// Pendulums that several pairs share are integrated once. Numbers that failed are NaN or infinite.
///
/// Errors: those of Batch; exit 130 soon after `stop` is set.
using PairObserver = std::function<void(std::size_t trial, long sample, const Bobs<double>& a, const Bobs<double>& b)>;
void step_pairs(std::span<const PendulumPair> pairs, const PairBatchSpec& run, const PairObserver& watch,
                const std::atomic<bool>& stop);

}  // namespace doppel
