#pragma once

#include "integrate/motion.hpp"
#include "track/track.hpp"

#include <memory>

namespace doppel {

/// The part of a track that is shown as a motion.
struct Replay {
    std::shared_ptr<const Track> track;
    std::size_t piece = 0;
    double start_s = 0;              // start of the motion, on the file's clock
    std::array<double, 2> offset{};  // rad, of the encoders: their reading at rest
    double length() const;           // s, from the start to the last sample
    const TrackPiece& samples() const { return track->pieces[piece]; }
};

/// The piece that contains `start_s`, or the first piece from its beginning. Throws Error (exit 2) if no piece does.
Replay replay_from(std::shared_ptr<const Track> track, std::optional<double> start_s, std::array<double, 2> offset);

/// The measured motion of a double pendulum. Angles and rates at any time come from a polynomial through the samples
/// around it (regression.hpp); positions, velocities and energy follow from spec.chain and spec.physical. Throws Error
/// (exit 3) after its end.
std::unique_ptr<Motion> make_replay(const MotionSpec& spec, const Replay& replay);

}  // namespace doppel
