#pragma once

#include "fit/shooting.hpp"

namespace doppel {

/// The stretches of a track that are left out one by one, each by its segments' numbers: a piece, or a segment where there
/// are few pieces.
using Units = std::vector<std::vector<std::size_t>>;
struct Division {
    std::vector<TrackSegment> segments;
    Units units;
};

/// Segments of at most three seconds, less where there is little track.
Division divide(const Track& track);

/// Where to begin fitting: the units of a track, and a compound model with all friction that follows it.
///
/// The equations of motion are regressed, which needs no start; then stretches of a quarter of the division's, or less
/// where the motion does not stay finite, are fitted, which follow the samples from almost any start. Those that do not are
/// halved; others are joined as far as one leads through the next. A stretch of motion so chaotic that an error of its start
/// would grow more than a hundredfold stays cut. Units are those of the division. Throws Error: exit 3 where no double
/// pendulum moves so, 130.
std::pair<Units, Fit> begin_fit(const FitJob& job);

}  // namespace doppel
