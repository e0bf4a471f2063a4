#pragma once

#include "image/theme.hpp"
#include "scene/video_spec.hpp"

namespace doppel {

/// How a film looks: the theme with what the preset changed, and sizes in px of the very picture.
struct Style {
    Theme theme;
    Widths width;
    FontSizes font;
    float glow = 0;
};

/// `unit` = px of the picture to one of 1920×1080; `text` = the same for words.
Style make_style(const VideoSpec& video, float unit, float text);

/// The colour of an ensemble's member: from the first, 0, to the last, 1.
Color member_color(const Style& style, double share);

}  // namespace doppel
