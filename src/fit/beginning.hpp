#pragma once

#include "fit/shooting.hpp"

namespace doppel {

/// Stretches of at most three seconds, less where there is little track, each with its unit. They are whole.
std::vector<Shot> divide(const Track& track);

/// Where to begin fitting: a model of rigid bodies with all friction that follows the track.
///
/// The equations of motion are regressed, which needs no start; then stretches of a quarter of the division's, or less
/// where the motion does not stay finite, are fitted, which follow the samples from almost any start. Those that do not are
/// halved; others are joined as far as one leads through the next. A stretch of motion so chaotic that an error of its start
/// would grow more than a hundredfold stays cut. Throws Error: exit 3 where no double pendulum moves so, 130.
Fit begin_fit(const FitJob& job);

}  // namespace doppel
