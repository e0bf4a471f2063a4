#pragma once

#include "image/color.hpp"
#include "image/picture.hpp"
#include "image/theme.hpp"
#include "numeric/rational.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace doppel {

/// An axis from `low` to `high`.
struct Range {
    double low, high;
};

/// How the pendulums of a film are placed: each side in a panel, the twin as a shadow; both in one panel; many between
/// the two, fanning out; both beside a panel of their phase space; panels one above the other.
enum class Arrangement { side_by_side, overlay, ensemble, phase, portrait };
inline constexpr std::array<std::string_view, 5> arrangement_names{"side-by-side", "overlay", "ensemble", "phase",
                                                                   "portrait"};

/// What a strip below the pendulums shows over time.
enum class StripKind { distance, exponent, energy, rod_error, rod_force };
inline constexpr std::size_t strip_kinds = 5;
inline constexpr std::array<std::string_view, strip_kinds> strip_names{"distance", "exponent", "energy", "rod-error",
                                                                       "rod-force"};
/// Those whose axis goes by powers of ten.
constexpr bool is_logarithmic(StripKind kind) {
    return kind != StripKind::exponent && kind != StripKind::rod_force;
}

/// What a phase panel shows: rates over angles as a path, or the points of a Poincaré section (θ1 passing the downward
/// vertical upwards).
enum class PhaseKind { rate, section };
inline constexpr std::array<std::string_view, 2> phase_names{"rate", "section"};

/// Widths of what is drawn, px of a 1920×1080 picture. Finer lines than these lose their hue in 4:2:0 video.
struct Widths {
    double trail = 3.4, trace = 2.8;
    double rod = 0, bob = 0;        // a rod's width, the radius of the heaviest bob; 0 = by the size of the panel
    double grid = 1.4, mark = 1.6;  // lines of charts; now, the parting, the horizon
};
inline constexpr std::array<std::pair<std::string_view, double Widths::*>, 6> width_names{{
    {"trail", &Widths::trail},
    {"trace", &Widths::trace},
    {"rod", &Widths::rod},
    {"bob", &Widths::bob},
    {"grid", &Widths::grid},
    {"mark", &Widths::mark},
}};

/// Sizes of words, px an em in a 1920×1080 picture.
struct FontSizes {
    double title = 40, subtitle = 22, clock = 40, heading = 31, note = 21, strip = 21, axis = 20, card = 84;
};
inline constexpr std::array<std::pair<std::string_view, double FontSizes::*>, 8> font_size_names{{
    {"title", &FontSizes::title},
    {"subtitle", &FontSizes::subtitle},
    {"clock", &FontSizes::clock},
    {"heading", &FontSizes::heading},
    {"note", &FontSizes::note},
    {"strip", &FontSizes::strip},
    {"axis", &FontSizes::axis},
    {"card", &FontSizes::card},
}};

/// The colours of a theme that a preset may change, by name.
inline constexpr std::array<std::pair<std::string_view, Color Theme::*>, 11> color_names{{
    {"background", &Theme::background},
    {"panel", &Theme::panel},
    {"text", &Theme::text},
    {"quiet_text", &Theme::quiet_text},
    {"grid", &Theme::grid},
    {"frame", &Theme::frame},
    {"cursor", &Theme::cursor},
    {"rod", &Theme::rod},
    {"bob", &Theme::bob},
    {"pivot", &Theme::pivot},
    {"trace", &Theme::trace},
}};

/// [video]: what a film shows and how it is written. Sizes are for 1920×1080 and grow and shrink with the picture.
struct VideoSpec {
    Size size{1920, 1080};
    std::optional<Rational> fps;  // frames/s; sample_hz · speed where it is not given, of a gif about 30
    Rational speed{1, 1};         // seconds of motion shown a second
    Rational hold_start_s{0, 1}, hold_end_s{0, 1};  // how long the first and the last frame stand
    Rational title_card_s{0, 1}, end_card_s{0, 1};  // 0 = none

    std::string format = "mp4";  // one of video_formats
    std::string codec;           // of webm; the usual one where empty
    std::string pixel_format = "yuv420p";
    bool transparent = false;  // no page, no panels; what is drawn alone
    std::string preset = "veryfast";
    int crf = 18;
    std::optional<Rational> poster_s;                 // the frame at this time as a picture of its own
    std::optional<std::array<int, 2>> contact_sheet;  // frames across and down

    Arrangement layout = Arrangement::side_by_side;
    int members = 100;  // of an ensemble, the pair included
    PhaseKind phase = PhaseKind::rate;
    int phase_link = 2;  // whose angle and rate
    bool pendulums = true;
    std::vector<StripKind> strips{StripKind::distance, StripKind::energy};
    std::array<std::optional<Range>, strip_kinds> ranges;  // of strips; fitted to the scene where not given

    std::string theme = "dark";
    std::vector<std::pair<std::string, Color>> colors;  // in place of the theme's, of color_names
    std::optional<std::array<Color, 2>> side_colors;
    Widths widths;
    FontSizes fonts;
    std::optional<double>
        glow_px;           // how far the light of trails and bobs reaches; 0 = none; the theme's where not given
    double trail_s = 2.5;  // s; 0 = none
};

inline constexpr std::array<std::string_view, 5> video_formats{"mp4", "webm", "gif", "apng", "png"};

}  // namespace doppel
