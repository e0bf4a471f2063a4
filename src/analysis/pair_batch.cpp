#include "analysis/pair_batch.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <optional>
#include <tuple>

namespace doppel {
namespace {

/// The pendulums of one side, or of both if they have the same equations, without duplicates.
struct SideBatch {
    const MotionSpec& side;
    std::vector<Pendulum<double>> members{};
    std::optional<Batch> batch{};
    std::vector<Bobs<double>> seen{};
    State<double, Eigen::Dynamic> state{};

    /// Adds the pendulum if it is new, and returns its number.
    std::size_t add(const Pendulum<double>& pendulum) {
        const auto known = std::find(members.begin(), members.end(), pendulum) - members.begin();
        if (known == static_cast<std::ptrdiff_t>(members.size())) members.push_back(pendulum);
        return static_cast<std::size_t>(known);
    }

    void read_bobs() {
        seen.resize(members.size());
        for (std::size_t i = 0; i < members.size(); ++i) {
            batch->read(i, state);
            if (side.model == Model::angles)
                place_angles(members[i], state, seen[i]);
            else
                place_particles(members[i].mass, state, seen[i]);
        }
    }
};

}  // namespace

void step_pairs(std::span<const PendulumPair> pairs, const PairBatchSpec& run, const PairObserver& watch,
                const std::atomic<bool>& stop) {
    const auto stepping = [](const MotionSpec& side) {
        return std::tie(side.model, side.method, side.steps_per_sample);
    };
    std::vector<SideBatch> batches;
    batches.push_back({run.a});
    if (stepping(run.b) != stepping(run.a)) batches.push_back({run.b});
    auto &batch_a = batches.front(), &batch_b = batches.back();
    std::vector<std::pair<std::size_t, std::size_t>> members;
    for (const auto& pair : pairs) members.emplace_back(batch_a.add(pair.a), batch_b.add(pair.b));
    for (auto& [side, pendulums, batch, seen, state] : batches)
        batch.emplace(pendulums, side.model, side.method,
                      side.sample_interval.value() / static_cast<double>(side.steps_per_sample));
    for (long n = 0; n <= run.samples; ++n) {
        throw_if_set(stop);
        for (auto& batch : batches) {
            if (n > 0) batch.batch->advance(batch.side.steps_per_sample);
            batch.read_bobs();
        }
        for (std::size_t i = 0; i < pairs.size(); ++i)
            watch(i, n, batch_a.seen[members[i].first], batch_b.seen[members[i].second]);
    }
}

}  // namespace doppel
