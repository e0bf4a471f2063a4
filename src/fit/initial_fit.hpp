#pragma once

#include "fit/shooting.hpp"

namespace doppel {

/// Divides the track into whole stretches of at most three seconds, less for short tracks, and assigns units.
std::vector<Shot> divide(const Track& track);

/// The first fit of a track: a model of rigid bodies with all friction.
///
/// First, a regression of the equations of motion, which needs no start. Then parts of stretches are fitted: quarters,
/// or shorter ones where the motion does not stay finite. They follow the samples from almost any start. Parts that do
/// not are halved; others are joined as far as one leads through the next. A stretch so chaotic that an initial error
/// would grow more than a hundredfold remains divided. Throws Error: exit 3 if no double pendulum moves like the track,
/// 130.
Fit initial_fit(const FitJob& job);

}  // namespace doppel
