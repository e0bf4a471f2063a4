#pragma once

#include "integrate/motion.hpp"
#include "track/replay.hpp"

#include <array>
#include <atomic>

namespace doppel {

/// The start of a pendulum that follows a track.
struct FittedStart {
    std::array<double, 2> angle{}, rate{};  // rad, rad/s
    std::array<double, 2> offset{};         // rad, of the encoders: their reading at rest
    double seconds = 0;  // length of the fitted part of the track; 0: only estimated from the first samples
    double rms = 0;      // rad, of the residuals
};

/// Fits start and offsets of a double pendulum to the first two seconds of a replay. If it cannot follow them within
/// 0.1 rad, a shorter part is fitted. Gauss–Newton steps are taken over a stretch that is doubled up to that length.
/// `motion` = how it is integrated; its start does not matter. Throws Error (exit 130) soon after `stop` is set.
FittedStart fit_start(const MotionSpec& motion, const Replay& replay, const std::atomic<bool>& stop);

}  // namespace doppel
