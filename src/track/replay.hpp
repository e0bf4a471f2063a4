#pragma once

#include "integrate/motion.hpp"
#include "track/track.hpp"

#include <memory>
#include <vector>

namespace doppel {

/// A piece of a track that is shown as a motion.
struct Replay {
    std::shared_ptr<const Track> track;
    std::size_t piece = 0;
    double start_s = 0;              // on the file's clock: where the motion begins
    std::array<double, 2> offset{};  // rad, of the encoders: what they show at rest
    double length() const;           // s, from there to the last sample
    const TrackPiece& samples() const { return track->pieces[piece]; }
};

/// The piece that holds `start_s`, or from the beginning of the first. Throws Error (exit 2) where no piece does.
Replay replay_from(std::shared_ptr<const Track> track, std::optional<double> start_s, std::array<double, 2> offset);

/// The motion of a double pendulum as it was measured: angles and rates at any time are those of a polynomial through the
/// samples around it (regression.hpp); places, velocities and energy follow from spec.chain and spec.physical. Past its
/// end it throws Error (exit 3).
std::unique_ptr<Motion> make_replay(const MotionSpec& spec, const Replay& replay);

}  // namespace doppel
