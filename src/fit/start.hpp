#pragma once

#include "integrate/motion.hpp"
#include "track/replay.hpp"

#include <array>
#include <atomic>

namespace doppel {

/// How a pendulum must start to swing as a track does.
struct FittedStart {
    std::array<double, 2> angle{}, rate{};  // rad, rad/s
    std::array<double, 2> offset{};         // rad, of the encoders: what they show at rest
    double seconds = 0;                     // of the track that it was fitted to; 0: only taken from the first samples
    double rms = 0;                         // rad, of what is left there
};

/// Fits start and offsets of a double pendulum to the first two seconds of a replay, or to as much of them as it can
/// follow within 0.1 rad: Gauss–Newton steps over a stretch that is doubled until it is as long. `motion` = how it is integrated;
/// its start does not matter. Throws Error (exit 130) soon after `stop` is set.
FittedStart fit_start(const MotionSpec& motion, const Replay& replay, const std::atomic<bool>& stop);

}  // namespace doppel
