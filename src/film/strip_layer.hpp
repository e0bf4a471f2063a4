#pragma once

#include "film/layer.hpp"

#include <memory>

namespace doppel {

/// A strip: axes, caption and curves, and on one of the strips the marks of the pair. `state` and `strip` must outlive
/// it.
std::unique_ptr<Layer> make_strip_layer(const FilmState& state, const StripLayout& strip);

}  // namespace doppel
