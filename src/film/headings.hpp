#pragma once

#include "film/layout.hpp"
#include "film/rooms.hpp"
#include "scene/captions.hpp"

#include <string>

namespace doppel {

/// How a film's words put it: upright ones are for a telephone.
Wording wording_of(const Scene& scene);

/// What the words above a strip say: what it shows, and of what or how.
struct StripWords {
    std::string what, how;
};
StripWords strip_words(StripKind kind, const Scene& scene);

/// The time as the clock shows it, with as many decimals as tell one frame from the next.
std::string clock_text(const Scene& scene, double time);
/// What the film says of its speed: "slow motion ×0.25"; where it changes, "¼ speed".
std::string speed_text(const Scene& scene, double time);

/// Adds the title, the line below it, the speed, and the clock's place. Returns where they end, px from the top.
float place_header(Layout& layout, const Scene& scene);

/// Shares the room below the header out, and adds what sets the sides apart: above the panels in a line, in two where
/// it is long; in a corner of an upright film's panel where the circle leaves it free.
Rooms place_headings(Layout& layout, const Scene& scene, const Area& room, RoomNeeds needs);

}  // namespace doppel
