#pragma once

#include "film/layout.hpp"
#include "scene/resolved.hpp"
#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace doppel {

/// The page's data except its motion, for src/film/page/player.js.
Json page_json(const Scene& scene, const MotionBounds& bounds);

/// The numbers in double of a motion's ideal chain of one to three links. Includes its method and steps if
/// src/film/page/chain.js computes the motion bit for bit. null for any other motion.
Json chain_json(const MotionSpec& motion);

/// The motions in a film: those of its members, or of its sides.
std::vector<const MotionSpec*> shown_motions(const Scene& scene);

/// Whether the page computes all of these motions.
bool page_computes(const Scene& scene);
/// Whether the script computes the curves of a strip from the states of ideal chains.
bool page_computes(StripKind kind);

}  // namespace doppel
