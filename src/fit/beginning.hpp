#pragma once

#include "fit/shooting.hpp"

namespace doppel {

/// The stretches of a track that are left out one by one, and what is fitted of each.
struct Division {
    std::vector<TrackSegment> segments;
    std::vector<std::vector<std::size_t>> units;  // segments of each; a piece, or a segment where there are few pieces
};

/// Segments of at most `segment_s`; none where it is 0 means as long as serves: three seconds, less where there is
/// little track.
Division divide(const Track& track, double segment_s = 0);

/// Where to begin fitting: the division of a track, and a compound model with all friction that follows it.
struct Beginning {
    Division division;
    Fit fit;
};

/// The equations of motion are regressed, which needs no start; then stretches of a quarter of the division's, or less
/// where the motion does not stay finite, are fitted, which follow the samples from almost any start. Those that do not are
/// halved; others are joined as far as one leads through the next. A stretch of motion so chaotic that an error of its start
/// would grow more than a hundredfold stays cut. Units are those of the division. Throws Error: exit 3 where no double
/// pendulum moves so, 130.
Beginning begin_fit(const Track& track, int jobs, const std::atomic<bool>& stop);

}  // namespace doppel
