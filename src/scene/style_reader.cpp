#include "scene/style_reader.hpp"

namespace doppel {
namespace {

/// The numbers of [video.NAME], each from `least` to `most`, into the members that `names` lists.
template <class Group, std::size_t N>
void read_sizes(TomlReader& video, const char* name, Group& into,
                const std::array<std::pair<std::string_view, double Group::*>, N>& names, double least, double most) {
    auto table = video.inner(video.read_table(name), fmt::format("[video.{}]", name));
    for (const auto& [key, member] : names) {
        table.read_number(key, into.*member);
        if (table.has(key) && !(into.*member >= least && into.*member <= most))
            throw table.fault(key, "must be from {} to {} px; it is {}", least, most, into.*member);
    }
    table.finish();
}

void read_colors(TomlReader& video, VideoSpec& into) {
    auto table = video.inner(video.read_table("colors"), "[video.colors]");
    for (const auto& [name, member] : color_names) {
        if (!table.has(name)) continue;
        into.colors.emplace_back(name, Color{});
        table.read_color(name, into.colors.back().second);
    }
    table.finish();
}

}  // namespace

void read_theme(TomlReader& table, std::string& into) {
    std::vector<std::string_view> names;
    for (const auto& theme : themes) names.push_back(theme.name);
    table.read_choice("theme", into, names);
}

void read_style(TomlReader& video, VideoSpec& into) {
    read_theme(video, into.theme);
    if (const auto colors = video.read_texts("side_colors")) {
        if (colors->size() != 2)
            throw video.fault("side_colors", "must have 2 colours, a and b; it has {}", colors->size());
        auto& sides = into.side_colors.emplace();
        for (std::size_t i = 0; i < 2; ++i) {
            const auto color = parse_color((*colors)[i]);
            if (!color)
                throw video.fault("side_colors", "must be colours such as \"#ff9f40\"; [{}] is \"{}\"", i,
                                  (*colors)[i]);
            sides[i] = *color;
        }
    }
    read_colors(video, into);
    read_sizes(video, "widths_px", into.widths, width_names, 0, 200);
    read_sizes(video, "fonts_px", into.fonts, font_size_names, 4, 400);
    if (video.has("glow_px")) {
        auto& glow = into.glow_px.emplace();
        video.read_number("glow_px", glow);
        if (!(glow >= 0 && glow <= 100)) throw video.fault("glow_px", "must be from 0 (none) to 100; it is {}", glow);
    }
    const bool is_ensemble = into.layout == Arrangement::ensemble;
    if (is_ensemble) into.trail_s = 0;
    video.read_number("trail_s", into.trail_s);
    if (!(into.trail_s >= 0 && into.trail_s <= 3600))
        throw video.fault("trail_s", "must be from 0 (none) to 3600; it is {}", into.trail_s);
    for (const auto& [key, value] : {std::pair{"trail_s", into.trail_s}, {"glow_px", into.glow_px.value_or(0)}})
        if (is_ensemble && value > 0)
            throw video.fault(key, "must be 0 for the layout \"ensemble\", whose members leave no trails; it is {}",
                              value);
}

}  // namespace doppel
