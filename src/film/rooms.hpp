#pragma once

#include "render/display_list.hpp"
#include "scene/video_spec.hpp"

#include <cstddef>
#include <vector>

namespace doppel {

/// What decides how a picture is shared out; lengths in px.
struct RoomNeeds {
    std::size_t panels = 2;  // 0 = none
    bool tall = false;       // panels and strips one above the other
    float heading = 0;       // height of the words above each panel
    float gap = 0;           // between panels, and between them and a column of strips
    float text = 1;          // px of the words to those of a 1920×1080 picture
    float height = 0;        // of the whole picture
    std::vector<StripKind> strips;
};

/// A picture's room below the header, shared out.
struct Rooms {
    std::vector<Area> panels;  // without their headings
    Area strips;               // with captions and the labels of the time; empty where there are none
};

/// A panel's size to that of the circle in it: a bob at the circle's rim stays inside.
inline constexpr float around_circle = 1.08f;

/// px of a 1920×1080 picture: a line of a strip's caption, what is around its lines, the labels of the time below.
inline constexpr float caption_line = 27, caption_edge = 16, time_labels_height = 36;

/// The panels first. Two beside each other get circles of 55 to 60 % of the picture's height, with the strips below
/// or, where that leaves too little for these, in a column at the right. A panel alone is a square beside its strips.
Rooms shared_out(const Area& room, const RoomNeeds& needs);

/// How much of a height that strips share goes to one.
float share_of(StripKind kind);

}  // namespace doppel
