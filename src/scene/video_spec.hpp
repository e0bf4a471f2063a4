#pragma once

#include "image/color.hpp"
#include "image/picture.hpp"
#include "numeric/quad.hpp"
#include "numeric/rational.hpp"
#include "output/formats.hpp"
#include "plot/page.hpp"
#include "render/typeface.hpp"
#include "scene/field.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

struct Range {
    double low, high;
};

/// How the pendulums of a film are arranged: each side in a panel, with the other as a shadow; both in one panel; an
/// ensemble between the two; both beside a phase portrait; upright for a telephone; only side a.
enum class Arrangement { side_by_side, overlay, ensemble, phase, portrait, single };
template <>
inline constexpr auto names_of<Arrangement> = std::to_array<std::string_view>({"side-by-side", "overlay", "ensemble",
                                                                               "phase", "portrait", "single"});

/// The quantity of a strip over time. "energy" is the error of the energy; with friction or a drive it becomes
/// total_energy (make_scene()). "energies" are kinetic, potential and total energy.
enum class StripKind {
    distance,
    exponent,
    energy,
    rod_error,
    rod_force,
    energies_a,
    energies_b,
    angles,
    rates,
    total_energy
};
inline constexpr std::size_t strip_kinds = 10;
template <>
inline constexpr auto names_of<StripKind> = std::to_array<std::string_view>({"distance", "exponent", "energy",
                                                                             "rod-error", "rod-force", "energies-a",
                                                                             "energies-b", "angles", "rates",
                                                                             "total-energy"});
inline constexpr std::array<std::string_view, strip_kinds> range_keys{
    "distance_range",   "exponent_range",   "energy_range", "rod_error_range", "rod_force_range",
    "energies_a_range", "energies_b_range", "angles_range", "rates_range",     "total_energy_range"};
/// Whether its axis is logarithmic.
constexpr bool is_logarithmic(StripKind kind) {
    return kind == StripKind::distance || kind == StripKind::energy || kind == StripKind::rod_error;
}

/// The contents of a phase portrait: rate against angle as a path, or the points of a Poincaré section (θ1 passing the
/// downward vertical upwards).
enum class PhaseKind { rate, section };
template <>
inline constexpr auto names_of<PhaseKind> = std::to_array<std::string_view>({"rate", "section"});

template <>
inline constexpr auto names_of<FilmFormat> = format_names;
template <>
inline constexpr auto names_of<PictureFormat> = std::to_array<std::string_view>({"png", "pdf", "svg", "html"});
template <>
inline constexpr auto names_of<PixelFormat> = pixel_format_names;

/// A member of a group of similar keys.
template <class Group, class Value>
struct Member {
    std::string_view key;
    Value Group::*member;
    std::string_view help;
};

/// Widths of lines, px of a 1920×1080 picture. Finer lines lose their hue in 4:2:0 video.
struct Widths {
    double trail = 4.4, trace = 2.8;
    double grid = 1.4, mark = 1.6;  // lines of charts; current time, divergence, limits
    std::optional<double> rod,
        bob;  // width of a rod, radius of the heaviest bob; if not given, from the size of the panel
};
inline constexpr std::array<Member<Widths, double>, 4> width_names{{
    {"trail", &Widths::trail, "the path behind the last bob"},
    {"trace", &Widths::trace, "curves of strips"},
    {"grid", &Widths::grid, "lines of charts"},
    {"mark", &Widths::mark, "lines that mark now, the divergence and the predictability limit"},
}};

/// Text sizes, px per em in a 1920×1080 picture; still legible at a third of that size.
struct FontSizes {
    double title = 42, subtitle = 27, clock = 42, heading = 34, note = 27, strip = 27, axis = 27, card = 84;
};
inline constexpr std::array<Member<FontSizes, double>, 8> font_size_names{{
    {"title", &FontSizes::title, "the title"},
    {"subtitle", &FontSizes::subtitle, "the line below it"},
    {"clock", &FontSizes::clock, "the time"},
    {"heading", &FontSizes::heading, "headings of the sides"},
    {"note", &FontSizes::note, "the line below a heading"},
    {"strip", &FontSizes::strip, "titles and values of strips"},
    {"axis", &FontSizes::axis, "numbers of axes"},
    {"card", &FontSizes::card, "the title on a card"},
}};

/// The colours of a theme that a preset may change.
inline constexpr std::array<Member<Theme, Color>, 11> color_names{{
    {"background", &Theme::background, "behind everything"},
    {"panel", &Theme::panel, "behind the pendulums"},
    {"text", &Theme::text, "titles and headings"},
    {"quiet_text", &Theme::quiet_text, "notes and axes"},
    {"grid", &Theme::grid, "lines of charts"},
    {"frame", &Theme::frame, "borders of panels"},
    {"cursor", &Theme::cursor, "the line that marks now"},
    {"rod", &Theme::rod, "rods"},
    {"bob", &Theme::bob, "bobs"},
    {"pivot", &Theme::pivot, "pivots"},
    {"trace", &Theme::trace, "curves of both sides together"},
}};

/// What a film shows: texts around its pendulums ("credit": Doppel's name on the end card), and parts of the panels
/// ("circle": the circle that the outstretched chain can reach; "twin": the other side as a shadow). Trails and pivots
/// are always shown.
inline constexpr auto shown_parts = std::to_array<std::string_view>(
    {"title", "subtitle", "clock", "labels", "credit", "rods", "bobs", "circle", "twin"});

/// The range of speeds if the speed changes.
inline constexpr auto changing_speeds = from_to(0.001, 1000);

/// Seconds of motion per second of film: constant, or changing at given times with easing (scene/frame_times.hpp).
struct Speed {
    struct Change {
        Rational at_s, speed;
        friend bool operator==(const Change&, const Change&) = default;
    };
    Rational constant{1, 1};      // if there are no changes
    std::vector<Change> changes;  // from 0 s on

    bool changes_over_time() const { return !changes.empty(); }
    Rational slowest() const {
        const auto by_value = [](const Change& change) { return change.speed.value(); };
        return changes.empty() ? constant : std::ranges::min(changes, {}, by_value).speed;
    }
};

struct SideSpec;

/// A member of an ensemble. Numbers that it does not give go from side a to side b in equal steps.
struct Release {
    std::vector<Quad> angle_deg, mass_kg, length_m;  // one per link; empty if not given
    std::optional<Color> color;

    /// Its lists with their keys, those of a side, and their symbols in pictures.
    struct List {
        std::string_view key;
        std::vector<Quad> Release::*member;
        std::vector<Quad> SideSpec::*of_side;
        std::string_view symbol, unit;
    };
    static const std::array<List, 3> lists;
};

/// The members of an ensemble: a number of them from side a to side b, or a list.
struct Members {
    static constexpr std::size_t max_releases = 8;
    int count = 100;                // including the pair
    std::vector<Release> releases;  // empty, or 2 to max_releases

    std::size_t size() const { return releases.empty() ? static_cast<std::size_t>(count) : releases.size(); }
};

/// The part of the plane shown in a panel, instead of an automatic one.
struct ViewSpec {
    std::optional<std::array<Quad, 2>> center_m;  // x and y
    std::optional<double> height_m;
    int follow = 0;  // number of the mass that stays in the centre, from 1; 0 = none
};

/// Whether a film shows the pendulums, and the strips below them.
struct Panels {
    bool pendulums = true;
    std::vector<StripKind> strips{StripKind::distance};
};

/// [video]: contents and output of a film. Sizes are for 1920×1080 and scale with the picture.
struct VideoSpec : Panels {
    Size size{1920, 1080};
    std::optional<Rational> fps;  // frames/s; if not given, sample_hz · speed, at most 30 for a gif
    Speed speed;
    double speed_ease_s = 0.5;                      // of motion, before each change
    Rational hold_start_s{0, 1}, hold_end_s{0, 1};  // hold times of the first and last frame
    Rational title_card_s{0, 1}, end_card_s{0, 1};  // 0 = none

    FilmFormat format = FilmFormat::mp4;
    std::string codec;  // for webm; empty: the default
    PixelFormat pixel_format = PixelFormat::yuv420;
    bool transparent = false;  // without page and panels
    int position_bits = 16;    // for html: bits of an embedded place or angle
    std::string preset = "doppel";
    int crf = 18;
    std::optional<Rational> poster_s;                 // save the frame nearest to this time as a picture
    std::optional<std::array<int, 2>> contact_sheet;  // columns and rows

    Arrangement layout = Arrangement::side_by_side;
    std::vector<std::string> show{shown_parts.begin(), shown_parts.end()};
    Members members;  // of an ensemble
    PhaseKind phase = PhaseKind::rate;
    int phase_link = 2;  // number of the link in the phase portrait
    ViewSpec view;
    std::optional<double> model_limit_s;                   // predictability limit of a fitted model, s
    std::array<std::optional<Range>, strip_kinds> ranges;  // of strips; automatic if not given

    std::string theme = "dark";
    std::array<std::optional<Color>, color_names.size()> colors;  // replace the theme's
    std::optional<std::array<Color, 2>> side_colors;
    Widths widths;
    FontSizes fonts;
    std::optional<std::string> text_font;               // path of the font file for all text
    Typeface typeface = Typeface::with_system_fonts();  // including that file
    std::optional<double> glow_px;                      // glow radius of trails and bobs; the theme's if not given
    double trail_s = 2.5;                               // s; 0 = none

    bool shows(std::string_view part) const { return std::find(show.begin(), show.end(), part) != show.end(); }
    const FormatRow& format_row() const { return doppel::format_row(format, codec); }
    /// The options of the video file at a frame rate, without metadata.
    VideoOptions options(const Rational& rate) const {
        return {.format = format,
                .codec = codec,
                .size = size,
                .fps_numerator = rate.numerator,
                .fps_denominator = rate.denominator,
                .pixel_format = pixel_format,
                .preset = preset,
                .crf = crf,
                .transparent = transparent};
    }
};

}  // namespace doppel
