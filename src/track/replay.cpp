#include "track/replay.hpp"

#include "base/error.hpp"
#include "physics/physical_forces.hpp"
#include "track/regression.hpp"

#include <algorithm>
#include <utility>

namespace doppel {
namespace {

constexpr double whole_sample = 1e-9;  // s: tolerance for equal times

class ReplayedMotion final : public Motion {
public:
    ReplayedMotion(const MotionSpec& spec, const Replay& replay)
        : pendulum_((spec.physical ? *spec.physical : physical(*spec.chain)).cast<double>()),
          replay_(replay),
          interval_s_(spec.sample_interval.value()) {}

    void advance(const std::atomic<bool>&) override {
        ++count_;
        share_ = 0;
        if (time() > replay_.length() + whole_sample)
            throw method_failed("the track ends {:.6g} s after its start", replay_.length());
    }

    void advance_within(double share, const std::atomic<bool>&) override { share_ = share; }

    Observation observe() const override {
        const auto [one, two] = estimate_at(*replay_.track, replay_.samples(), replay_.start_s + time());
        State<double, Eigen::Dynamic> y(4);
        y << one.angle - replay_.offset[0], two.angle - replay_.offset[1], one.rate, two.rate;
        auto [bobs, pivot, energy, kinetic_energy] = configuration_of(pendulum_, y, time());
        Observation now;
        now.bobs = std::move(bobs);
        now.pivot = pivot;
        now.energy = energy;
        now.kinetic_energy = kinetic_energy;
        return now;
    }

    Effort effort() const override { return {}; }

private:
    double time() const { return (static_cast<double>(count_) + share_) * interval_s_; }

    PhysicalPendulum<double> pendulum_;
    Replay replay_;
    double interval_s_;
    long count_ = 0;    // samples
    double share_ = 0;  // fraction of the interval to the next one
};

}  // namespace

double Replay::length() const {
    return samples().time_s.back() - start_s;
}

Replay replay_from(std::shared_ptr<const Track> track, std::optional<double> start_s, std::array<double, 2> offset) {
    const auto& pieces = track->pieces;
    const double start = start_s.value_or(pieces.front().time_s.front());
    const auto contains = [&](const TrackPiece& piece) {
        return start >= piece.time_s.front() - whole_sample && start < piece.time_s.back();
    };
    const auto found = std::find_if(pieces.begin(), pieces.end(), contains);
    if (found == pieces.end())
        throw bad_input("is {} s, without a sample there: the track goes from {} to {} s{}", start,
                        pieces.front().time_s.front(), pieces.back().time_s.back(),
                        pieces.size() > 1 ? fmt::format(", in {} pieces", pieces.size()) : "");
    return {std::move(track), static_cast<std::size_t>(found - pieces.begin()), start, offset};
}

std::unique_ptr<Motion> make_replay(const MotionSpec& spec, const Replay& replay) {
    return std::make_unique<ReplayedMotion>(spec, replay);
}

}  // namespace doppel
