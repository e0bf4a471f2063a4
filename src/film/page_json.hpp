#pragma once

#include "film/layout.hpp"
#include "scene/resolved.hpp"
#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace doppel {

/// What the page of a film draws besides its motion, for src/film/page/player.js.
Json page_json(const Scene& scene, const MotionBounds& bounds);

/// The ideal chain that a motion is of, where it has one to three links: its numbers in double, and where
/// src/film/page/chain.js computes it to the last bit, its method and steps. null for any other motion.
Json chain_json(const MotionSpec& motion);

/// The motions that a film shows: those of its members, or of its sides.
std::vector<const MotionSpec*> shown_motions(const Scene& scene);

/// Whether the page computes all of them.
bool page_computes(const Scene& scene);
/// Whether the script finds the curves of a strip from the states of ideal chains.
bool page_computes(StripKind kind);

}  // namespace doppel
