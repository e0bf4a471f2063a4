#include "film/simulation.hpp"

#include "base/clock.hpp"
#include "base/threads.hpp"

namespace doppel {
namespace {

/// Shots ahead: many of a pair, few of a crowd, whose shots are large.
std::size_t most_ahead(bool with_crowd) {
    return with_crowd ? 16 : 256;
}

}  // namespace

Simulation::Simulation(const Scene& scene, long last, bool with_crowd, const std::atomic<bool>& stop)
    : ahead_(most_ahead(with_crowd)),
      thread_(start_thread([this, &scene, last, with_crowd, &stop] { work(scene, last, with_crowd, stop); })) {}

Shot Simulation::next() {
    auto shot = ahead_.pop();
    if (!shot) std::rethrow_exception(fault_);
    return std::move(*shot);
}

std::pair<Effort, Effort> Simulation::efforts() {
    const std::lock_guard hold(mutex_);
    return efforts_;
}

void Simulation::work(const Scene& scene, long last, bool with_crowd, const std::atomic<bool>& stop) {
    try {
        PairRun pair(scene);
        std::optional<MotionBatch> crowd;
        if (with_crowd && !scene.crowd.empty()) crowd.emplace(scene.crowd, 1);
        for (long sample = 0; sample < last; ++sample) {
            Shot shot{pair.next(stop), {}};
            if (crowd) {
                if (sample > 0) crowd->advance(stop);
                for (std::size_t k = 0; k < crowd->size(); ++k) shot.crowd.push_back(crowd->bobs(k));
            }
            cpu_s_ = seconds_of(CLOCK_THREAD_CPUTIME_ID);
            {
                const std::lock_guard hold(mutex_);
                efforts_ = {pair.effort_a(), pair.effort_b()};
            }
            if (!ahead_.push(std::move(shot))) return;
        }
    } catch (...) {
        fault_ = std::current_exception();
        ahead_.close();
    }
}

}  // namespace doppel
