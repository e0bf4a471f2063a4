#pragma once

#include "scene/field.hpp"
#include "scene/preset.hpp"

namespace doppel {

// The keys that [a] and [b] of a film have besides those of [system], as in scene/preset_fields.hpp.

/// [a.track] and [b.track]
template <class Visit, class Spec>
void track_fields(Visit& visit, Spec& track) {
    visit(
        {.key = "file",
         .help = "CSV of a measured double pendulum, which the side shows instead of a simulation; beside the preset, "
                 "from here, or one that came with the program",
         .absent = "none"},
        track.file);
    const Only of_file{.holds = !track.is_none()};
    visit({"start_s", "the file's time at which the motion begins", "s", {}, "the first sample", of_file},
          track.start_s);
    visit({"offset_deg", "what the encoders show at rest, which is subtracted", "deg", angle_bounds, "", of_file,
           "one an arm"},
          track.offset_deg);
}

/// Of [a] and [b] of a film.
template <class Visit, class Side>
void side_text_fields(Visit& visit, Side&& side) {
    visit({.key = "label",
           .help = "what the side is called in the picture; \"\" = nothing",
           .absent = "what sets it apart",
           .is_drawn = true},
          side.label);
    visit({.key = "note", .help = "the line below the label; \"\" = none", .absent = "how it starts", .is_drawn = true},
          side.note);
    visit.table("track", [&](auto& table) { track_fields(table, side.track); });
}

}  // namespace doppel
