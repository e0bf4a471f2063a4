#pragma once

#include "fit/result.hpp"
#include "output/csv.hpp"
#include "plot/plot.hpp"
#include "scene/resolved.hpp"

namespace doppel {

/// A preset that moves like the track's first piece: comments on the fit, then [scene], [system], and [b] with the same
/// pendulum released one standard error away. If presets do not support the chosen model, the best supported one is
/// used.
std::string fitted_preset(const FitResult& result, const std::string& name);

Json fit_json(const FitResult& result);

/// Writes the residuals. Columns: piece (from 0), time_s, both angles as interpreted, and measured − model of both,
/// rad; empty if an angle was left out.
void write_residuals(const FitResult& result, const std::filesystem::path& place);

/// A sentence about the residuals: white noise, or otherwise why not.
std::string residual_sentence(const FitResult& result);
/// A sentence about the prediction horizon, and what limits it.
std::string horizon_sentence(const FitResult& result);
/// "A/B = 1.7988 ± 0.0007", with as many digits as the error justifies.
std::string parameter_text(const Fit& fit, const Uncertainty& uncertainty, std::size_t parameter);

/// The page of a fit: a piece with the model, the residuals with a band of two rms, the hierarchy, and the errors of
/// predictions; below them, the parameters and results in sentences.
Figure fit_page(const FitResult& result, const std::string& name);

}  // namespace doppel
