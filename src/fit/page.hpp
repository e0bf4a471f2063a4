#pragma once

#include "fit/result.hpp"
#include "plot/plot.hpp"

namespace doppel {

/// The page of a fit: a piece and the model, the residuals with a band of two rms, the ladder, and the errors of
/// predictions; below them the parameters and what was found, in sentences.
Figure fit_page(const FitResult& result, const std::string& name);

}  // namespace doppel
