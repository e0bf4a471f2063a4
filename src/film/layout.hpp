#pragma once

#include "film/recording.hpp"
#include "image/color.hpp"
#include "plot/axis.hpp"
#include "render/display_list.hpp"
#include "render/typeface.hpp"
#include "scene/captions.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// A length, rounded to float as in pictures.
inline float px(double length) {
    return static_cast<float>(length);
}

/// The style of a film: the theme with the preset's changes, and sizes in px of this picture.
struct Style {
    Theme theme;
    Widths width;
    FontSizes font;
    float glow = 0;
    Typeface type;
};

/// `unit` = px of this picture per px of a 1920×1080 one; `text` = the same for text.
Style make_style(const VideoSpec& video, float unit, float text);

/// The size of one of many pendulums in a panel, relative to a single one; up to eight are as large as one.
float size_of_many(std::size_t pendulums);

/// The colour of an ensemble's member from the first (0) to the last (1), if they are not listed.
Color member_color(const Theme& theme, double share);

/// A pendulum of a film: that of a side, or an ensemble's member with the side that has the same lines.
struct ShownPendulum {
    const MotionSpec& motion;
    const Side& side;
    std::vector<double> mass;     // kg
    Color color;                  // of its last bob
    Color rod{}, bob{}, trail{};  // of its rods, its other bobs, and its trail
    Color ghost{};                // of all, where it is faint behind the other pendulum

    /// Radius of its lightest bobs, in units of the rods'.
    double least_bob() const;
};
/// From the first or front one on. `style` and whether those of two sides share a panel: for their colours.
std::vector<ShownPendulum> shown_pendulums(const Scene& scene, const Style& style = {}, bool share_panel = false);

/// The fixed ends of its rods and springs, m from its pivot.
std::vector<Place<double>> pivots_of(const Side& side);

/// A panel of pendulums and its map from metres to pixels.
struct PendulumPanel {
    Area area;
    std::vector<std::size_t> shown{};   // numbers of pendulums, the front one first
    Point center{};                     // the position of (center_x, center_y), px
    double center_x = 0, center_y = 0;  // m; the pivot of a chain
    float px_per_m = 1;
    Point at(double x_m, double y_m) const;  // clamped to a million px from the centre, for runs that diverge
};

/// A phase portrait: angle horizontally, rate vertically.
struct PhasePanel {
    Area panel, area;  // of the panel; of its axes
    Axis angle, rate;
};

/// A strip: the chart of a quantity over time, with its caption above.
struct StripLayout {
    StripKind kind;
    Area cell;                    // including captions and numbers
    Area area;                    // inside the axes
    Axis time, value;             // horizontal; vertical
    int lines = 1;                // of the caption; 0 = it is too low for texts
    float baseline = 0;           // of the caption's first line, px
    std::vector<Area> covered{};  // by the curve of the whole film, if it is the distance
};

/// Upright, for telephones.
inline bool is_tall(const VideoSpec& video) {
    return video.size.height > video.size.width;
}

/// Too low for more than one line above the panels, and one above each of them.
inline bool is_low(const VideoSpec& video) {
    return std::min(video.size.width, video.size.height) < 120;
}

inline bool has_panel_for_each(const VideoSpec& video) {
    return video.layout == Arrangement::side_by_side || video.layout == Arrangement::portrait;
}

/// The layout of a film's picture: a function of the scene and the bounds of its motion.
struct Layout {
    float unit = 1;      // px per px of a 1920×1080 picture
    float text = 1;      // the same for text, which stays legible in small pictures and on telephones
    float min_text = 9;  // smallest size of text, px per em
    Style style;
    Area page;                          // inside the margins
    DisplayList words;                  // constant texts: title, subtitle, headings of panels
    std::optional<Label> clock, speed;  // without their texts; the speed if it changes
    std::vector<PendulumPanel> panels;
    std::optional<PhasePanel> phase;
    std::vector<StripLayout> strips;  // from top to bottom
    float reach = 0;                  // radius of the circle that an outstretched chain reaches, px; 0 = none
    float bob_radius = 0;             // of the heaviest bob, px
    float last_bob_radius = 0;        // at least, for the bob that leaves the trail, in long chains, px
    float rod_radius = 0;             // half its width, px
};

/// Whether the picture requires the bounds of the whole motion.
bool depends_on_motion(const Scene& scene);

/// `bounds`: of the whole motion, if depends_on_motion().
Layout make_layout(const Scene& scene, const MotionBounds& bounds);

/// The quantities that decide how a picture is divided; lengths in px.
struct RegionNeeds {
    std::size_t panels = 2, strips = 0;  // numbers of them
    bool tall = false;                   // strips one below the other, below the panels
    float chart_heading = 0;             // if the second panel is a chart, which is wider, or lower with this heading
    float heading = 0;                   // height of the heading of each panel
    float gap = 0;                       // between panels, and between panels and strips
    float height = 0;                    // of the whole picture
    float numbers = 0;                   // height of the numbers on the time axis, below the lowest strip of a column
    std::function<float(float)> caption = {};  // height of the captions of strips of a given width
};

/// The areas of a picture below the header.
struct Regions {
    std::vector<Area> panels;  // without headings
    std::vector<Area> strips;  // with captions and numbers
};

/// Ratio of a panel's size to the circle in it, so that a bob at its rim stays inside.
inline constexpr float around_circle = 1.08f;

/// Divides the area. Curves of strips take a fifth to a third of the picture's height. Up to three strips stand in a
/// row below panels; more, or in small pictures, in a column at the right; in upright pictures, one below the other.
/// The panels get the largest possible circles.
Regions split(const Area& room, const RegionNeeds& needs);

/// Which wording of captions a film uses: upright ones have the shorter one, for telephones.
Wording wording_of(const Scene& scene);

/// The time on the clock, with enough decimals to distinguish frames.
std::string clock_text(const Scene& scene, double time);
/// The text for the speed: "real time", "slow motion ×0.25".
std::string speed_text(const Scene& scene, double time);

/// Adds title, subtitle and speed, and places the clock. Returns where they end, px from the top.
float place_header(Layout& layout, const Scene& scene);

/// Divides the area below the header, and adds the headings of the panels, which state how the sides differ.
Regions place_headings(Layout& layout, const Scene& scene, const Area& room, RegionNeeds needs);

/// A text for `width` px: shrunk to three quarters and the smallest legible size at least, then without its last words.
struct FittedText {
    std::string text;
    float size;
};
FittedText fitted_text(const Layout& layout, const std::string& text, float size, Weight weight, float width);

}  // namespace doppel
