#pragma once

#include "scene/preset.hpp"

#include <vector>

namespace doppel {

/// Which moments of the motion the frames of a film show, as numbers of ticks from the start. At one speed a tick is a
/// sample; where the speed changes, samples are cut into ticks so fine that frames fall on them.
struct FrameTimes {
    long ticks_per_sample = 1;
    long stride = 1, last = 0;  // at one speed: ticks from frame to frame; the last one's
    std::vector<long> ticks;    // where the speed changes: each frame's

    long count() const { return ticks.empty() ? last / stride + 1 : static_cast<long>(ticks.size()); }
    long tick(long frame) const { return ticks.empty() ? frame * stride : ticks[static_cast<std::size_t>(frame)]; }
    /// The first frame at that tick or later; count() where there is none.
    long first_from(long tick) const;
    /// The next sample or frame, whichever is sooner.
    long next_moment(long tick) const;
};

/// The frames of a motion of `samples`. The steps of a sample can be divided by divisors of `common_steps` alone (0 = by
/// anything). Throws Error (exit 2) where steps are too coarse for a speed that changes.
FrameTimes frame_times(const Preset& preset, const Rational& fps, long samples, long common_steps);

/// How long the film takes to show the motion up to `time`, s, where the speed changes: between the end of one speed
/// and the next the film's seconds a second of motion go over by 3u² − 2u³.
double film_time(const VideoSpec& video, double time);

/// The speed that holds, or to which or from which it is nearer, at `time`, s.
Rational speed_at(const VideoSpec& video, double time);

}  // namespace doppel
