#include "scene/video_reader.hpp"

#include "picture/theme.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

using namespace std::string_view_literals;

constexpr std::array encoder_presets{"ultrafast"sv, "superfast"sv, "veryfast"sv, "faster"sv,  "fast"sv,
                                     "medium"sv,    "slow"sv,      "slower"sv,   "veryslow"sv};
constexpr std::array formats{"mp4"sv, "png"sv};
constexpr std::array panel_names{"pendulums"sv, "distance"sv, "energy"sv};
constexpr int smallest_picture = 64, largest_picture = 16384;  // px; more than any GL takes, which says so itself

}  // namespace

void read_picture_size(TomlReader& table, Size& into) {
    std::array<double, 2> size{double(into.width), double(into.height)};
    table.read_numbers("size", size, "width and height");
    for (const double pixels : size)
        if (pixels != std::floor(pixels) || pixels < smallest_picture || pixels > largest_picture)
            throw table.fault("size", "must be whole numbers from {} to {}; it is [{}, {}]", smallest_picture,
                              largest_picture, size[0], size[1]);
    into = {static_cast<int>(size[0]), static_cast<int>(size[1])};
}

void read_theme(TomlReader& table, std::string& into) {
    std::vector<std::string_view> names;
    for (const auto& theme : themes) names.push_back(theme.name);
    table.read_choice("theme", into, names);
}

void read_video(TomlReader& table, VideoSpec& video) {
    read_picture_size(table, video.size);
    for (const int pixels : {video.size.width, video.size.height})
        if (pixels % 2 != 0)
            throw table.fault("size", "must be even, as H.264 needs it; it is [{}, {}]; [{}, {}] would do",
                              video.size.width, video.size.height, video.size.width + video.size.width % 2,
                              video.size.height + video.size.height % 2);

    if (table.has("fps")) table.read_positive_ratio("fps", video.fps.emplace());
    table.read_positive_ratio("speed", video.speed);
    table.read_choice("format", video.format, formats);
    table.read_choice("preset", video.preset, encoder_presets);
    table.read_whole("crf", video.crf, 0, 51);

    read_theme(table, video.theme);
    if (const auto colors = table.read_texts("side_colors")) {
        if (colors->size() != 2)
            throw table.fault("side_colors", "must have 2 colours, a and b; it has {}", colors->size());
        auto& sides = video.side_colors.emplace();
        for (std::size_t i = 0; i < 2; ++i) {
            const auto color = parse_color((*colors)[i]);
            if (!color)
                throw table.fault("side_colors", "must be colours such as \"#ff9f40\"; [{}] is \"{}\"", i,
                                  (*colors)[i]);
            sides[i] = *color;
        }
    }
    if (table.has("trail_s")) {
        table.read_number("trail_s", video.trail_s);
        if (video.trail_s < 0 || video.trail_s > 3600)
            throw table.fault("trail_s", "must be from 0 (none) to 3600; it is {}", video.trail_s);
    }
    if (const auto panels = table.read_texts("panels")) {
        const auto shows = [&](std::string_view name) {
            return std::find(panels->begin(), panels->end(), name) != panels->end();
        };
        for (const auto& panel : *panels)
            if (std::find(panel_names.begin(), panel_names.end(), panel) == panel_names.end())
                throw table.fault("panels", "may hold \"{}\"; \"{}\" is none of them", fmt::join(panel_names, "\", \""),
                                  panel);
        if (panels->empty())
            throw table.fault("panels", "must hold at least one of \"{}\"", fmt::join(panel_names, "\", \""));
        video.pendulums = shows("pendulums");
        video.distance = shows("distance");
        video.energy = shows("energy");
    }
    const auto read_range = [&](std::string_view key, std::optional<Range>& into) {
        if (!table.has(key)) return;
        std::array<double, 2> ends{};
        table.read_positives(key, ends, "lowest and highest");
        if (!(ends[1] >= 10 * ends[0]) || ends[1] / ends[0] > 1e60)
            throw table.fault(key, "must rise by 1 to 60 powers of ten; it is [{}, {}]", ends[0], ends[1]);
        into = Range{ends[0], ends[1]};
    };
    read_range("distance_range", video.distance_range);
    read_range("energy_range", video.energy_range);
    table.finish();
}

}  // namespace doppel
