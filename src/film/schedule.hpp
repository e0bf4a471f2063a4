#pragma once

#include "scene/scene.hpp"

namespace doppel {

/// How many frames a film has of each kind, in their order; those of the motion show samples 0, samples_per_frame …
struct Schedule {
    long title = 0, hold_start = 0, motion = 0, hold_end = 0, end = 0;

    long frames() const { return title + hold_start + motion + hold_end + end; }
};

Schedule schedule_of(const Scene& scene);

/// How opaque a card is on frame `k` of `count`: the last (or first, where it comes up) half second is a fade, but
/// never more than half of the card.
double card_opacity(long k, long count, double fps, bool comes_up);

}  // namespace doppel
