#pragma once

#include "fit/shooting.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// Which bodies the arms may be.
enum class Bodies { automatic, point, compound };

/// The model with friction: 0 none, 1 viscous, 2 and dry, 3 and drag; and with a reading: 0 offsets, 1 and a lag, 2 and
/// scales.
ModelSpec model_of(bool point, int friction, Drag drag = Drag::own, int reading = 0);

/// A model and how it did.
struct FittedModel {
    std::string name;  // "compound, viscous and dry friction"
    ModelSpec model;
    Fit fit;                          // to the whole track
    double left_out_rms = 0;          // rad, of pieces that the parameters were fitted without
    std::vector<double> left_out;     // mean squares, by unit, rad²
    std::size_t parameters = 0;       // fitted, without those at a bound
    std::vector<Parameters> without;  // fitted without unit k
};

/// The stretches of a track that are left out one by one, and what is fitted of each.
struct Division {
    std::vector<TrackSegment> segments;
    std::vector<std::vector<std::size_t>> units;  // segments of each; a piece, or a segment where there are few pieces
};

/// Segments of at most `segment_s`; none where it is 0 means as long as serves: three seconds, less where there is
/// little track.
Division divide(const Track& track, double segment_s = 0);

/// The fit of the whole track without some of its segments, to first order: one Gauss–Newton step with the normal
/// equations of the others. Starts move along.
Fit fit_without(const Fit& fit, const std::vector<std::size_t>& segments);

/// The fit, or that of the other law of dry friction where this leaves less: both have as many parameters.
Fit of_better_law(const Track& track, const std::vector<TrackSegment>& segments, Fit fit, const FitEffort& effort,
                  const std::atomic<bool>& stop);

/// All models, from the smallest. `chosen` is the smallest that predicts pieces left out as well as the best does.
struct ModelLadder {
    Division division;
    std::vector<FittedModel> rungs;
    std::size_t chosen = 0, best = 0;
};

/// Fits nested models, each from the one before. Pieces are left out by one Gauss–Newton step from the fit of all (the
/// normal equations without theirs), then their own starts are fitted anew. Throws Error: exit 3 where no model
/// describes the track, 130.
///
/// Source  Hastie, Tibshirani & Friedman, The Elements of Statistical Learning, §7.10 (the rule of one standard error)
ModelLadder climb(const Track& track, Bodies bodies, int jobs, const std::atomic<bool>& stop,
                  const std::function<void(std::size_t done, std::size_t of)>& report);

}  // namespace doppel
