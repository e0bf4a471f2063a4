#pragma once

#include "integrate/motion_batch.hpp"
#include "output/workers.hpp"
#include "scene/scene.hpp"

#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace doppel {

/// The state at one sample: the pair, and the bobs of an ensemble's members.
struct Snapshot {
    PairState pair;
    std::vector<Bobs<double>> members;
};

/// Steps the pair, and an ensemble's members, in a thread of its own, a bounded number of snapshots ahead.
class Simulation {
public:
    /// Snapshots 0 … last − 1. The members of an ensemble are stepped where `with_members`. Throws Error (exit 4) where
    /// there is no thread to be had.
    Simulation(const Scene& scene, long last, bool with_members, const std::atomic<bool>& stop);
    ~Simulation() { ahead_.close(); }
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    /// The next snapshot; rethrows what stopped the simulation.
    Snapshot next();

    /// CPU time of the thread, s, and what the sides have cost; complete once the last snapshot was taken.
    double cpu_s() const { return cpu_s_; }
    std::pair<Effort, Effort> efforts();

private:
    void work(const Scene& scene, long last, bool with_members, const std::atomic<bool>& stop);

    Queue<Snapshot> ahead_;
    std::exception_ptr fault_;
    std::atomic<double> cpu_s_ = 0;
    std::mutex mutex_;
    std::pair<Effort, Effort> efforts_;
    std::jthread thread_;  // last: it uses all the rest
};

}  // namespace doppel
