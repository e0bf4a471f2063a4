#pragma once

#include "external_method.hpp"
#include "figure/preset.hpp"

#include <vector>

namespace doppel {

/// The figure of kind "work-precision" that the preset describes, of the methods of other libraries, beside the best of
/// Doppel's. It has the reference trials of the figure, then rounds of its step-size studies and theirs, so that other
/// load on the machine affects all equally. Errors: those of read_figure().
FigurePreset library_chart(const PresetText& source, const std::vector<Override>& overrides,
                           std::vector<ExternalMethod> methods);

}  // namespace doppel
