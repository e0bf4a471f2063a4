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

/// An axis from `low` to `high`.
struct Range {
    double low, high;
};

/// How the pendulums of a film are placed: each side in a panel, the other as a shadow; both in one panel; many between
/// the two, fanning out; both beside a panel of their phase space; for a telephone; side a alone.
enum class Arrangement { side_by_side, overlay, ensemble, phase, portrait, single };
template <>
inline constexpr auto names_of<Arrangement> = std::to_array<std::string_view>({"side-by-side", "overlay", "ensemble",
                                                                               "phase", "portrait", "single"});

/// What a strip below the pendulums shows over time.
/// "energy" is the error of the energy, or total_energy where friction or a drive changes it (make_scene()); "energies" are
/// kinetic, potential and total.
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
/// The keys of their axes.
inline constexpr std::array<std::string_view, strip_kinds> range_keys{
    "distance_range",   "exponent_range",   "energy_range", "rod_error_range", "rod_force_range",
    "energies_a_range", "energies_b_range", "angles_range", "rates_range",     "total_energy_range"};
/// Those whose axis goes by powers of ten.
constexpr bool is_logarithmic(StripKind kind) {
    return kind == StripKind::distance || kind == StripKind::energy || kind == StripKind::rod_error;
}

/// What a phase panel shows: rates over angles as a path, or the points of a Poincaré section (θ1 passing the downward
/// vertical upwards).
enum class PhaseKind { rate, section };
template <>
inline constexpr auto names_of<PhaseKind> = std::to_array<std::string_view>({"rate", "section"});

template <>
inline constexpr auto names_of<FilmFormat> = format_names;
template <>
inline constexpr auto names_of<PictureFormat> = std::to_array<std::string_view>({"png", "pdf", "svg"});
template <>
inline constexpr auto names_of<PixelFormat> = pixel_format_names;

/// A member of a group of keys that are alike.
template <class Group, class Value>
struct Member {
    std::string_view key;
    Value Group::*member;
    std::string_view help;
};

/// Widths of what is drawn, px of a 1920×1080 picture. Finer lines than these lose their hue in 4:2:0 video.
struct Widths {
    double trail = 4.4, trace = 2.8;
    double grid = 1.4, mark = 1.6;   // lines of charts; now, the divergence, limits
    std::optional<double> rod, bob;  // a rod's width, the radius of the heaviest bob; by the size of the panel
};
inline constexpr std::array<Member<Widths, double>, 4> width_names{{
    {"trail", &Widths::trail, "the path behind the last bob"},
    {"trace", &Widths::trace, "curves of strips"},
    {"grid", &Widths::grid, "lines of charts"},
    {"mark", &Widths::mark, "lines that mark now, the divergence and the predictability limit"},
}};

/// Sizes of words, px an em in a 1920×1080 picture: at a third of that size they can still be read.
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

/// What a film shows: words around its pendulums ("credit": Doppel's name on the end card), and parts of these ("circle":
/// what the outstretched chain reaches; "twin": the other side as a shadow). Trails and pivots are always shown.
inline constexpr auto shown_parts = std::to_array<std::string_view>(
    {"title", "subtitle", "clock", "labels", "credit", "rods", "bobs", "circle", "twin"});

/// The speeds that a film may change to.
inline constexpr auto changing_speeds = from_to(0.001, 1000);

/// Seconds of motion a second of film: one speed; or from each of some times on another, eased (scene/frame_times.hpp).
struct Speed {
    struct Change {
        Rational at_s, speed;
        friend bool operator==(const Change&, const Change&) = default;
    };
    Rational constant{1, 1};      // where there are no changes
    std::vector<Change> changes;  // from 0 s on

    bool changes_over_time() const { return !changes.empty(); }
    Rational slowest() const {
        const auto by_value = [](const Change& change) { return change.speed.value(); };
        return changes.empty() ? constant : std::ranges::min(changes, {}, by_value).speed;
    }
};

/// A member of an ensemble. What it does not give goes from side a to side b in equal steps.
struct Release {
    std::vector<Quad> angle_deg, mass_kg, length_m;  // one a link; none where not given
    std::optional<Color> color;

    /// Its lists with their keys, those of SideSpec, and how pictures write them.
    struct List {
        std::string_view key;
        std::vector<Quad> Release::*member;
        std::string_view symbol, unit;
    };
    static const std::array<List, 3> lists;
};
inline constexpr std::array<Release::List, 3> Release::lists{{{"angle_deg", &Release::angle_deg, "θ", "°"},
                                                              {"mass_kg", &Release::mass_kg, "m", " kg"},
                                                              {"length_m", &Release::length_m, "l", " m"}}};

/// The pendulums of an ensemble: so many from side a to side b, or each by itself.
struct Members {
    static constexpr std::size_t most_releases = 8;
    int count = 100;                // the pair included
    std::vector<Release> releases;  // none, or 2 to most_releases

    std::size_t size() const { return releases.empty() ? static_cast<std::size_t>(count) : releases.size(); }
};

/// The part of the plane that a panel of pendulums shows, in place of what fits the motion.
struct ViewSpec {
    std::optional<std::array<Quad, 2>> center_m;  // x and y
    std::optional<double> height_m;
    int follow = 0;  // the mass that stays in the middle, from 1; 0 = none
};

/// Whether a film shows the pendulums, and the strips below them.
struct Panels {
    bool pendulums = true;
    std::vector<StripKind> strips{StripKind::distance};
};

/// [video]: what a film shows and how it is written. Sizes are for 1920×1080 and grow and shrink with the picture.
struct VideoSpec : Panels {
    Size size{1920, 1080};
    std::optional<Rational> fps;  // frames/s; sample_hz · speed where it is not given, of a gif up to 30
    Speed speed;
    double speed_ease_s = 0.5;                      // of motion, before each change
    Rational hold_start_s{0, 1}, hold_end_s{0, 1};  // how long the first and the last frame stand
    Rational title_card_s{0, 1}, end_card_s{0, 1};  // 0 = none

    FilmFormat format = FilmFormat::mp4;
    std::string codec;  // of webm; the usual one where empty
    PixelFormat pixel_format = PixelFormat::yuv420;
    bool transparent = false;  // no page, no panels; what is drawn alone
    std::string preset = "doppel";
    int crf = 18;
    std::optional<Rational> poster_s;                 // the frame nearest to this time, as a picture of its own
    std::optional<std::array<int, 2>> contact_sheet;  // frames across and down

    Arrangement layout = Arrangement::side_by_side;
    std::vector<std::string> show{shown_parts.begin(), shown_parts.end()};
    Members members;  // of an ensemble
    PhaseKind phase = PhaseKind::rate;
    int phase_link = 2;  // whose angle and rate
    ViewSpec view;
    std::optional<double> model_limit_s;                   // how long a fitted model predicts what was measured
    std::array<std::optional<Range>, strip_kinds> ranges;  // of strips; fitted to the scene where not given

    std::string theme = "dark";
    std::array<std::optional<Color>, color_names.size()> colors;  // in place of the theme's
    std::optional<std::array<Color, 2>> side_colors;
    Widths widths;
    FontSizes fonts;
    std::optional<std::string> text_font;               // path of the font file for all words
    Typeface typeface = Typeface::with_system_fonts();  // with that file, read
    std::optional<double> glow_px;                      // glow radius of trails and bobs; the theme's where not given
    double trail_s = 2.5;                               // s; 0 = none

    bool shows(std::string_view part) const { return std::find(show.begin(), show.end(), part) != show.end(); }
    const FormatRow& format_row() const { return doppel::format_row(format, codec); }
    /// How the file of a film of so many frames/s is written, but for its metadata.
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
