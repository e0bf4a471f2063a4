#include "analysis/twins.hpp"

#include "base/error.hpp"
#include "integrate/widths.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace doppel {
namespace {

/// The pendulums of one side, or of both where they obey the same equations, each of them once.
class SideBatch {
public:
    explicit SideBatch(TwinSide side) : side_(std::move(side)) {}

    /// The number of this pendulum, which is new or was there.
    std::size_t add(const Pendulum<double>& pendulum) {
        const auto known = std::find(members_.begin(), members_.end(), pendulum);
        if (known != members_.end()) return static_cast<std::size_t>(known - members_.begin());
        members_.push_back(pendulum);
        return members_.size() - 1;
    }

    void start(const TwinRun& run, int width) {
        batch_.emplace(members_, side_.model, side_.method,
                       run.sample_interval / static_cast<double>(side_.steps_per_sample), width);
        seen_.resize(members_.size());
        update();
    }

    void advance() {
        batch_->advance(side_.steps_per_sample);
        update();
    }

    const Bobs<double>& seen(std::size_t member) const { return seen_[member]; }

private:
    void update() {
        for (std::size_t i = 0; i < members_.size(); ++i) {
            batch_->read(i, state_);
            if (side_.model == Model::angles)
                place_angles(members_[i], state_, seen_[i]);
            else
                place_particles(members_[i], state_, seen_[i]);
        }
    }

    TwinSide side_;
    std::vector<Pendulum<double>> members_;
    std::optional<Batch> batch_;
    State<double, Eigen::Dynamic> state_;
    std::vector<Bobs<double>> seen_;
};

}  // namespace

std::size_t twins_block() {
    return 2 * static_cast<std::size_t>(register_widths().back());
}

void step_twins(std::span<const Twins> twins, const TwinRun& run, const TwinWatch& watch, const std::atomic<bool>& stop,
                int width) {
    std::vector<SideBatch> batches;
    batches.emplace_back(run.a);
    if (run.b != run.a) batches.emplace_back(run.b);
    auto &batch_a = batches.front(), &batch_b = batches.back();
    std::vector<std::pair<std::size_t, std::size_t>> members;
    for (const auto& pair : twins) members.emplace_back(batch_a.add(pair.a), batch_b.add(pair.b));
    for (auto& batch : batches) batch.start(run, width);
    for (long n = 0; n <= run.samples; ++n) {
        throw_if_set(stop);
        if (n > 0)
            for (auto& batch : batches) batch.advance();
        for (std::size_t i = 0; i < twins.size(); ++i)
            watch(i, n, batch_a.seen(members[i].first), batch_b.seen(members[i].second));
    }
}

void average_log_ratios(std::span<const Twins> twins, const TwinRun& run, std::span<double> averages,
                        const std::atomic<bool>& stop, int width) {
    std::vector<AverageLogRatio> means(twins.size());
    const auto watch = [&](std::size_t trial, long, const Bobs<double>& a, const Bobs<double>& b) {
        means[trial].add(state_space_distance(a, b));
    };
    step_twins(twins, run, watch, stop, width);
    std::transform(means.begin(), means.end(), averages.begin(), [](const auto& mean) { return mean.value(); });
}

}  // namespace doppel
