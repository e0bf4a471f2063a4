#include "scene/resolved.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

std::string hex(const Color& color) {
    const auto channel = [](float x) { return static_cast<int>(std::lround(x * 255)); };
    return fmt::format("\"#{:02x}{:02x}{:02x}\"", channel(color.r), channel(color.g), channel(color.b));
}

std::string quoted(std::string_view name) {
    return fmt::format("\"{}\"", name);
}

template <std::size_t N, class Choice>
std::string name_in(const std::array<std::string_view, N>& names, Choice choice) {
    return quoted(names[static_cast<std::size_t>(choice)]);
}

/// What only some layouts have.
std::string layout_toml(const VideoSpec& video) {
    auto text = fmt::format("layout = {}\n", name_in(arrangement_names, video.layout));
    if (video.layout == Arrangement::ensemble) text += fmt::format("members = {}\n", video.members);
    if (video.layout == Arrangement::phase)
        text += fmt::format("phase = {}\nphase_link = {}\n", name_in(phase_names, video.phase), video.phase_link);
    std::vector<std::string> panels;
    if (video.pendulums) panels.push_back(quoted("pendulums"));
    for (const auto strip : video.strips) panels.push_back(name_in(strip_names, strip));
    text += fmt::format("panels = [{}]\n", fmt::join(panels, ", "));
    for (std::size_t i = 0; i < strip_kinds; ++i) {
        if (!video.ranges[i]) continue;
        std::string key(strip_names[i]);
        std::replace(key.begin(), key.end(), '-', '_');
        text += fmt::format("{}_range = [{}, {}]\n", key, video.ranges[i]->low, video.ranges[i]->high);
    }
    return text;
}

std::string format_toml(const VideoSpec& video) {
    auto text = fmt::format("format = \"{}\"\n", video.format);
    if (!video.codec.empty()) text += fmt::format("codec = \"{}\"\n", video.codec);
    if (video.format == "mp4" || video.format == "webm")
        text += fmt::format("pixel_format = \"{}\"\npreset = \"{}\"\ncrf = {}\n", video.pixel_format, video.preset,
                            video.crf);
    if (video.transparent) text += "transparent = true\n";
    if (video.poster_s) text += fmt::format("poster_s = {}\n", toml_ratio(*video.poster_s));
    if (video.contact_sheet)
        text += fmt::format("contact_sheet = [{}, {}]\n", (*video.contact_sheet)[0], (*video.contact_sheet)[1]);
    return text;
}

template <class Group, std::size_t N>
std::string sizes_toml(const char* name, const Group& group,
                       const std::array<std::pair<std::string_view, double Group::*>, N>& names) {
    auto text = fmt::format("\n[video.{}]\n", name);
    for (const auto& [key, member] : names) text += fmt::format("{} = {}\n", key, group.*member);
    return text;
}

}  // namespace

std::string resolved_video(const VideoSpec& video) {
    auto text = fmt::format("\n[video]\nsize = [{}, {}]\n", video.size.width, video.size.height);
    if (video.fps) text += fmt::format("fps = {}\n", toml_ratio(*video.fps));
    text += fmt::format("speed = {}\nhold_start_s = {}\nhold_end_s = {}\ntitle_card_s = {}\nend_card_s = {}\n",
                        toml_ratio(video.speed), toml_ratio(video.hold_start_s), toml_ratio(video.hold_end_s),
                        toml_ratio(video.title_card_s), toml_ratio(video.end_card_s));
    text += format_toml(video) + layout_toml(video);
    text += fmt::format("theme = \"{}\"\ntrail_s = {}\n", video.theme, video.trail_s);
    if (video.glow_px) text += fmt::format("glow_px = {}\n", *video.glow_px);
    if (video.side_colors)
        text += fmt::format("side_colors = [{}, {}]\n", hex((*video.side_colors)[0]), hex((*video.side_colors)[1]));
    if (!video.colors.empty()) {
        text += "\n[video.colors]\n";
        for (const auto& [name, color] : video.colors) text += fmt::format("{} = {}\n", name, hex(color));
    }
    return text + sizes_toml("widths_px", video.widths, width_names) +
           sizes_toml("fonts_px", video.fonts, font_size_names);
}

}  // namespace doppel
