#pragma once

#include "film/run.hpp"
#include "fit/shooting.hpp"

namespace doppel {

/// Which bodies the links may be.
enum class Bodies { automatic, point, rigid };

/// A model and how it did.
struct FittedModel {
    std::string name;              // "rigid bodies, viscous and Coulomb friction"
    Fit fit;                       // to the whole track
    double left_out_rms = 0;       // rad, of pieces that the parameters were fitted without
    std::vector<double> left_out;  // mean squares, by unit, rad²
};

/// All models, from the smallest. `chosen` is the smallest that predicts pieces left out as well as the best does.
struct ModelHierarchy {
    std::vector<FittedModel> candidates;
    std::size_t chosen = 0, best = 0;
};

/// Fits nested models, each from the one before. Pieces are left out by one Gauss–Newton step from the fit of all (the
/// normal equations without theirs), then their own starts are fitted anew. Throws Error: exit 3 where no model
/// describes the track, 130.
///
/// Source  Hastie, Tibshirani & Friedman, The Elements of Statistical Learning, §7.10 (the rule of one standard error)
ModelHierarchy climb(const FitJob& job, Bodies bodies, const std::function<void(const Progress&)>& report);

}  // namespace doppel
