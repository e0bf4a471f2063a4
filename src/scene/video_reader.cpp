#include "scene/video_reader.hpp"

#include "scene/style_reader.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

using namespace std::string_view_literals;

constexpr std::array encoder_presets{"ultrafast"sv, "superfast"sv, "veryfast"sv, "faster"sv,  "fast"sv,
                                     "medium"sv,    "slow"sv,      "slower"sv,   "veryslow"sv};
constexpr std::array webm_codecs{"vp9"sv, "av1"sv};
constexpr std::array pixel_formats{"yuv420p"sv, "yuv444p"sv, "yuv420p10"sv};
constexpr int smallest_picture = 64, largest_picture = 16384;  // px; more than any GL takes, which says so itself

bool is_encoded(const VideoSpec& video) {
    return video.format == "mp4" || video.format == "webm";
}

/// Sizes that the pixel format allows.
void check_size(const TomlReader& table, const VideoSpec& video) {
    if (!is_encoded(video) || video.pixel_format == "yuv444p") return;
    const auto even = [](int pixels) { return pixels + pixels % 2; };
    if (video.size.width % 2 != 0 || video.size.height % 2 != 0)
        throw table.fault("size", "must be even, as {} needs it in {}; it is [{}, {}]; [{}, {}] would do",
                          video.format == "mp4" ? "H.264" : "WebM", video.pixel_format, video.size.width,
                          video.size.height, even(video.size.width), even(video.size.height));
}

void read_format(TomlReader& table, VideoSpec& video) {
    table.read_choice("format", video.format, video_formats);
    const bool encoded = is_encoded(video);
    // true where the key counts; a format from the command line drops what the preset's file says for another
    const auto takes = [&](std::string_view key, bool serves, std::string_view what) {
        if (!table.has(key) || serves) return serves;
        if (table.from_command_line("format") && !table.from_command_line(key)) return false;
        throw table.fault(key, "is {}; the format is \"{}\"", what, video.format);
    };
    if (takes("codec", video.format == "webm", "a choice of webm"))
        table.read_choice("codec", video.codec, webm_codecs);
    constexpr std::string_view of_encoded = "of mp4 and webm";
    if (takes("pixel_format", encoded, of_encoded))
        table.read_choice("pixel_format", video.pixel_format, pixel_formats);
    table.read_truth("transparent", video.transparent);
    const bool has_alpha = video.format == "png" || video.format == "apng" ||
                           (video.format == "webm" && video.codec != "av1" && video.pixel_format == "yuv420p");
    if (video.transparent && !has_alpha)
        throw table.fault("transparent",
                          "takes a format with opacity: png, apng, or webm (VP9, yuv420p); the format is \"{}\"",
                          video.format);
    if (takes("preset", encoded, of_encoded)) table.read_choice("preset", video.preset, encoder_presets);
    if (takes("crf", encoded, of_encoded)) table.read_whole("crf", video.crf, 0, video.format == "webm" ? 63 : 51);
}

/// When what is shown, and what is kept besides.
void read_course(TomlReader& table, VideoSpec& video) {
    if (table.has("fps")) table.read_positive_ratio("fps", video.fps.emplace());
    table.read_positive_ratio("speed", video.speed);
    constexpr double longest = 3600;  // s
    const auto read_seconds = [&](std::string_view key, Rational& into) {
        table.read_ratio_from_zero(key, into);
        if (into.value() > longest)
            throw table.fault(key, "must be from 0 (none) to {}; it is {}", longest, into.value());
    };
    read_seconds("hold_start_s", video.hold_start_s);
    read_seconds("hold_end_s", video.hold_end_s);
    read_seconds("title_card_s", video.title_card_s);
    read_seconds("end_card_s", video.end_card_s);
    if (table.has("poster_s")) table.read_ratio_from_zero("poster_s", video.poster_s.emplace());
    if (table.has("contact_sheet")) {
        std::array<double, 2> sheet{};
        table.read_numbers("contact_sheet", sheet, "frames across and down");
        constexpr int most = 32;
        for (const double frames : sheet)
            if (frames != std::floor(frames) || frames < 1 || frames > most)
                throw table.fault("contact_sheet", "must be two whole numbers from 1 to {}; it is [{}, {}]", most,
                                  sheet[0], sheet[1]);
        video.contact_sheet = {static_cast<int>(sheet[0]), static_cast<int>(sheet[1])};
    }
}

/// "pendulums" and the strips, in their order.
void read_panels(TomlReader& table, VideoSpec& video) {
    const auto panels = table.read_texts("panels");
    if (!panels) return;
    video.pendulums = false;
    video.strips.clear();
    for (const auto& panel : *panels) {
        const auto strip = std::find(strip_names.begin(), strip_names.end(), panel);
        if (panel == "pendulums") {
            video.pendulums = true;
        } else if (strip == strip_names.end()) {
            throw table.fault("panels", "may hold \"pendulums\", \"{}\"; \"{}\" is none of them",
                              fmt::join(strip_names, "\", \""), panel);
        } else if (const auto kind = static_cast<StripKind>(strip - strip_names.begin());
                   std::find(video.strips.begin(), video.strips.end(), kind) == video.strips.end()) {
            video.strips.push_back(kind);
        }
    }
    if (panels->empty())
        throw table.fault("panels", "must hold at least one of \"pendulums\", \"{}\"",
                          fmt::join(strip_names, "\", \""));
}

void read_ranges(TomlReader& table, VideoSpec& video) {
    for (std::size_t i = 0; i < strip_kinds; ++i) {
        std::string key(strip_names[i]);
        std::replace(key.begin(), key.end(), '-', '_');
        key += "_range";
        if (!table.has(key)) continue;
        std::array<double, 2> ends{};
        if (is_logarithmic(static_cast<StripKind>(i))) {
            table.read_positives(key, ends, "lowest and highest");
            if (!(ends[1] >= 10 * ends[0]) || ends[1] / ends[0] > 1e60)
                throw table.fault(key, "must rise by 1 to 60 powers of ten; it is [{}, {}]", ends[0], ends[1]);
        } else {
            table.read_numbers(key, ends, "lowest and highest");
            if (!(ends[1] > ends[0]) || !std::isfinite(ends[1] - ends[0]))
                throw table.fault(key, "must rise; it is [{}, {}]", ends[0], ends[1]);
        }
        video.ranges[i] = Range{ends[0], ends[1]};
    }
}

void read_layout(TomlReader& table, VideoSpec& video) {
    table.read_enumerated("layout", video.layout, arrangement_names);
    if (video.layout == Arrangement::portrait && !table.has("size")) video.size = {1080, 1920};
    if (video.layout == Arrangement::portrait && video.size.height < video.size.width)
        throw table.fault("size", "must be higher than wide for the layout \"portrait\"; it is [{}, {}]",
                          video.size.width, video.size.height);
    const auto read_of = [&](std::string_view key, Arrangement layout, auto&& read) {
        if (table.has(key) && video.layout != layout)
            throw table.fault(key, "is of the layout \"{}\"; it is \"{}\"",
                              arrangement_names[static_cast<std::size_t>(layout)],
                              arrangement_names[static_cast<std::size_t>(video.layout)]);
        read();
    };
    constexpr int fewest = 2, most = 1000;
    read_of("members", Arrangement::ensemble, [&] { table.read_whole("members", video.members, fewest, most); });
    read_of("phase", Arrangement::phase, [&] { table.read_enumerated("phase", video.phase, phase_names); });
    constexpr int most_links = 10'000;
    read_of("phase_link", Arrangement::phase, [&] { table.read_whole("phase_link", video.phase_link, 1, most_links); });
    read_panels(table, video);
    if (!video.pendulums && video.layout != Arrangement::side_by_side && video.layout != Arrangement::portrait)
        throw table.fault("panels", "must hold \"pendulums\" for the layout \"{}\"",
                          arrangement_names[static_cast<std::size_t>(video.layout)]);
    read_ranges(table, video);
}

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

void read_video(TomlReader& table, VideoSpec& video) {
    read_picture_size(table, video.size);
    read_format(table, video);
    read_course(table, video);
    read_layout(table, video);
    check_size(table, video);
    read_style(table, video);
    table.finish();
}

}  // namespace doppel
