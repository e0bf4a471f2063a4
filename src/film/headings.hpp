#pragma once

#include "film/layout.hpp"
#include "film/rooms.hpp"
#include "scene/captions.hpp"

#include <array>

namespace doppel {

/// How a film's words put it: upright ones are for a telephone.
Wording wording_of(const Scene& scene);

/// Adds the title, the line below it, the speed, and the clock's place. Returns where they end, px from the top.
float place_header(Layout& layout, const Scene& scene);

/// Shares the room below the header out, and adds what sets the sides apart: above the panels in a line, in two where
/// it is long; in a corner of an upright film's panel where the circle leaves it free.
Rooms place_headings(Layout& layout, const Scene& scene, const Area& room, RoomNeeds needs);

}  // namespace doppel
