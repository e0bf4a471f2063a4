#pragma once

#include "film/layout.hpp"
#include "scene/resolved.hpp"
#include "scene/scene.hpp"

#include <string>

namespace doppel {

/// The page's data except its motion of samples 0 … `samples`, for src/film/page/player.js.
Json page_json(const Scene& scene, const MotionBounds& bounds, long samples);

/// An axis for the scripts of pages: its label, the values `from` … `to`, and the pixels `start` … `end`.
Json axis_json(const Axis& axis, const std::string& label = "");

/// The numbers in double of a motion's ideal chain of one to three links. Includes its method and steps if
/// src/film/page/chain.js computes the motion bit for bit. null for any other motion.
Json chain_json(const MotionSpec& motion);

/// Whether the page computes all of these motions.
bool page_computes(const Scene& scene);
/// Whether the script computes the curves of a strip from the states of ideal chains.
bool page_computes(StripKind kind);

}  // namespace doppel
