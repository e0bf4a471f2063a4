#pragma once

#include "fit/result.hpp"
#include "output/csv.hpp"
#include "plot/plot.hpp"
#include "scene/resolved.hpp"

namespace doppel {

/// A preset that swings as the track's first piece does: comments on what was fitted, then [scene], [system] and [b],
/// the same pendulum released one standard error further. Where presets cannot state the chosen model, it is the best of
/// those that they can.
std::string fitted_preset(const FitResult& result, const std::string& name);

/// Everything found, for the manifest.
Json fit_json(const FitResult& result);

/// Columns and rows of the residuals: piece (from 0), time_s, both angles as they were taken, and measured − model of
/// both, rad; empty where an angle was left out.
void write_residuals(const FitResult& result, const std::filesystem::path& place);

/// One sentence on the residuals: like noise, or not and why.
std::string residual_sentence(const FitResult& result);
/// One on the horizon, and what limits it.
std::string horizon_sentence(const FitResult& result);
/// "A/B = 1.7988 ± 0.0007", with as many digits as the error bears.
std::string parameter_text(const Fit& fit, const Uncertainty& uncertainty, std::size_t parameter);

/// The page of a fit: a piece and the model, the residuals with a band of two rms, the hierarchy, and the errors of
/// predictions; below them the parameters and what was found, in sentences.
Figure fit_page(const FitResult& result, const std::string& name);

}  // namespace doppel
