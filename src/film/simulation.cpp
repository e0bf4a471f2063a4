#include "film/simulation.hpp"

#include "base/clock.hpp"
#include "base/threads.hpp"

namespace doppel {
namespace {

/// Snapshots ahead: many of a pair, few of an ensemble, whose snapshots are large.
std::size_t most_ahead(bool with_members) {
    return with_members ? 16 : 256;
}

}  // namespace

Simulation::Simulation(const Scene& scene, long last, bool with_members, const std::atomic<bool>& stop)
    : ahead_(most_ahead(with_members)),
      thread_(start_thread([this, &scene, last, with_members, &stop] { work(scene, last, with_members, stop); })) {}

Snapshot Simulation::next() {
    auto snapshot = ahead_.pop();
    if (!snapshot) std::rethrow_exception(fault_);
    return std::move(*snapshot);
}

std::pair<Effort, Effort> Simulation::efforts() {
    const std::lock_guard hold(mutex_);
    return efforts_;
}

void Simulation::work(const Scene& scene, long last, bool with_members, const std::atomic<bool>& stop) {
    try {
        PairRun pair(scene);
        std::optional<MotionBatch> members;
        if (with_members && !scene.members.empty()) members.emplace(scene.members, 1);
        for (long sample = 0; sample < last; ++sample) {
            Snapshot snapshot{pair.next(stop), {}};
            if (members) {
                if (sample > 0) members->advance(stop);
                for (std::size_t k = 0; k < members->size(); ++k) snapshot.members.push_back(members->bobs(k));
            }
            cpu_s_ = seconds_of(CLOCK_THREAD_CPUTIME_ID);
            {
                const std::lock_guard hold(mutex_);
                efforts_ = {pair.effort_a(), pair.effort_b()};
            }
            if (!ahead_.push(std::move(snapshot))) return;
        }
    } catch (...) {
        fault_ = std::current_exception();
        ahead_.close();
    }
}

}  // namespace doppel
