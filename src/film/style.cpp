#include "film/style.hpp"

#include "image/colormap.hpp"

#include <algorithm>

namespace doppel {
namespace {

Theme themed(const VideoSpec& video) {
    auto theme = *std::find_if(themes.begin(), themes.end(), [&](const auto& t) { return t.name == video.theme; });
    for (std::size_t i = 0; i < color_names.size(); ++i)
        if (video.colors[i]) theme.*color_names[i].member = *video.colors[i];
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
    for (const auto& width : width_names) style.width.*width.member *= unit;
    for (const auto& size : font_size_names) style.font.*size.member *= text;
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
