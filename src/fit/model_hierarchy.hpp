#pragma once

#include "film/run.hpp"
#include "fit/shooting.hpp"

namespace doppel {

/// The allowed types of links.
enum class Bodies { automatic, point, rigid };

/// A model and the quality of its fit.
struct FittedModel {
    std::string name;              // "rigid bodies, viscous and Coulomb friction"
    Fit fit;                       // to the whole track
    double left_out_rms = 0;       // rad, on pieces left out of the fit
    std::vector<double> left_out;  // mean square for each unit, rad²
};

/// All models, the smallest first. `chosen` is the smallest that predicts left-out pieces as well as the best one.
struct ModelHierarchy {
    std::vector<FittedModel> candidates;
    std::size_t chosen = 0, best = 0;
};

/// Fits nested models, each starting from the previous one. To leave out a piece, one Gauss–Newton step is taken from
/// the fit of all pieces (with the normal equations without that piece); then the starts of the left-out piece are
/// fitted. Throws Error: exit 3 if no model describes the track, 130.
///
/// Source  Hastie, Tibshirani & Friedman, The Elements of Statistical Learning, §7.10 (the rule of one standard error)
ModelHierarchy fit_hierarchy(const FitJob& job, Bodies bodies, const std::function<void(const Progress&)>& report);

}  // namespace doppel
