#pragma once

#include "scene/scene.hpp"

namespace doppel {

/// A side by the accuracy that it asks for: the cheapest model and method that reached it in the measured table
/// (scene/cost_table.hpp), at the loosest setting whose error, estimated by a finer run and by one from a start some
/// roundings away, is half of what is asked up to the end; or, where rounding forbids that, up to the horizon of the
/// side's precision. Tolerances are 1 or 3 times a power of ten.
/// Errors  exit 2 where the accuracy would not even hold for one swing, with what is within reach; exit 130 soon after
///         `stop` is set.
Side choose_side(const SideSpec& spec, const Rational& duration, const Rational& sample_hz,
                 const std::atomic<bool>& stop);

}  // namespace doppel
