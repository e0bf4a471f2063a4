#pragma once

#include "scene/scene.hpp"

namespace doppel {

/// A side with its model chosen, the smallest that serves, and everything in exact numbers. Throws Error (exit 2) where
/// the system is faulty.
Side make_side(const SideSpec& spec, const Rational& sample_hz);

}  // namespace doppel
