#include "film/style.hpp"

#include "image/color.hpp"

#include <algorithm>

namespace doppel {
namespace {

Theme themed(const VideoSpec& video) {
    auto theme = *std::find_if(themes.begin(), themes.end(), [&](const auto& t) { return t.name == video.theme; });
    for (const auto& [name, color] : video.colors)
        for (const auto& [known, member] : color_names)
            if (known == name) theme.*member = color;
    if (video.side_colors) theme.sides = *video.side_colors;
    return theme;
}

bool is_dark(const Theme& theme) {
    const auto& color = theme.background;
    return 0.2126f * color.r + 0.7152f * color.g + 0.0722f * color.b < 0.5f;
}

}  // namespace

Style make_style(const VideoSpec& video, float unit, float text) {
    Style style{themed(video), video.widths, video.fonts, 0};
    for (const auto& [name, member] : width_names) style.width.*member *= unit;
    for (const auto& [name, member] : font_size_names) style.font.*member *= text;
    // small pictures keep lines that can be seen
    style.width.trail = std::max(style.width.trail, video.widths.trail > 0 ? 1.2 : 0);
    style.width.trace = std::max(style.width.trace, video.widths.trace > 0 ? 1.2 : 0);
    style.width.grid = std::max(style.width.grid, video.widths.grid > 0 ? 1.0 : 0);
    style.width.mark = std::max(style.width.mark, video.widths.mark > 0 ? 1.0 : 0);
    style.glow = unit * static_cast<float>(video.glow_px.value_or(style.theme.glow));
    return style;
}

Color member_color(const Style& style, double share) {
    // the end of the scale that would drown in the background is left out
    return is_dark(style.theme) ? map_color(0.4 + 0.6 * share) : map_color(0.75 * share);
}

}  // namespace doppel
