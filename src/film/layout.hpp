#pragma once

#include "film/bounds.hpp"
#include "image/color.hpp"
#include "plot/axis.hpp"
#include "render/display_list.hpp"
#include "render/typeface.hpp"
#include "scene/captions.hpp"
#include "scene/scene.hpp"
#include "scene/video_spec.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// A length as pictures take it.
inline float px(double length) {
    return static_cast<float>(length);
}

/// How a film looks: the theme with what the preset changed, and sizes in px of the very picture.
struct Style {
    Theme theme;
    Widths width;
    FontSizes font;
    float glow = 0;
    Typeface type;
};

/// `unit` = px of the picture to one of 1920×1080; `text` = the same for text.
Style make_style(const VideoSpec& video, float unit, float text);

/// Members of an ensemble that are drawn as large as a pair.
inline constexpr std::size_t most_full_members = 8;

/// The colour of an ensemble's member: from the first, 0, to the last, 1.
Color member_color(const Style& style, double share);
/// The colour of member `k` of a scene's: of a list a hue of its own, else by the scale.
Color member_color(const Style& style, const Scene& scene, std::size_t k);

/// A panel of pendulums and how metres become pixels in it.
struct PendulumPanel {
    Area area;
    std::vector<std::size_t> sides{};   // whose pendulum it shows, the front one first
    Point center{};                     // px, the area's, where (center_x, center_y) is
    double center_x = 0, center_y = 0;  // m: the pivot of a chain
    float px_per_m = 1;
    Point at(double x_m, double y_m) const;  // within a million px of the centre, wherever a diverging run puts a bob
};

/// A panel of phase space: angles across, rates up.
struct PhasePanel {
    Area panel, area;  // the panel; the axes in it
    Axis angle, rate;
};

/// A strip of the chart: time across, a quantity up.
struct StripLayout {
    StripKind kind;
    Area area;
    Axis time, value;
    Area caption;    // the words above it
    float base = 0;  // of their last line, px
    int lines = 1;   // of them
};

/// Upright: for a telephone.
inline bool is_tall(const VideoSpec& video) {
    return video.size.height > video.size.width;
}

/// "−1.5": with a true minus sign, and no more decimals than it has.
std::string axis_number(double value);

/// Ticks `spacing` px apart or more, labels of `size` px an em; whole numbers and the fewest decimals.
std::vector<Tick> axis_ticks(const Axis& axis, float size, float spacing, bool across);

/// Where everything of a film's picture goes: a function of the scene, and of how far its motion gets.
struct Layout {
    float unit = 1;  // 1 px of a 1920×1080 picture
    float text = 1;  // the same for text, which stays legible in small pictures and on telephones
    Style style;
    Area page;          // within the margins
    DisplayList words;  // that never change: the title, what is said beside it, the headings above panels
    std::optional<Label> clock, speed;  // without their texts; the speed where it changes
    std::vector<PendulumPanel> panels;
    std::optional<PhasePanel> phase;
    std::vector<StripLayout> strips;  // from the top down
    float reach = 0;                  // px, the radius of the circle that an outstretched chain reaches; 0 = none
    float bob_radius = 0;             // px, of the heaviest
    float last_bob_radius = 0;        // px, at least, of the one that leaves the trail; of long chains
    float rod_radius = 0;             // half its width, px
    float time_labels = 0;            // their baseline, px
};

/// A film's picture, or a tile of a contact sheet: pendulums and time alone.
enum class PictureKind { film, tile };

/// `bounds`: of the whole motion, where the picture depends on it (depends_on_motion()). A tile has no strips.
Layout make_layout(const Scene& scene, const MotionBounds& bounds, PictureKind dress = PictureKind::film);

/// The size of a tile of that width, px.
Size tile_size(const Scene& scene, int width);

/// What decides how a picture is shared out; lengths in px.
struct RegionNeeds {
    std::size_t panels = 2;  // 0 = none
    bool tall = false;       // panels and strips one above the other
    float heading = 0;       // height of the words above each panel
    float gap = 0;           // between panels, and between them and a column of strips
    float text = 1;          // px of the words to those of a 1920×1080 picture
    float height = 0;        // of the whole picture
    std::vector<StripKind> strips;
};

/// A picture's room below the header, shared out.
struct Regions {
    std::vector<Area> panels;  // without their headings
    Area strips;               // with captions and the labels of the time; empty where there are none
};

/// A panel's size to that of the circle in it: a bob at the circle's rim stays inside.
inline constexpr float around_circle = 1.08f;

/// px of a 1920×1080 picture: a line of a strip's caption, what is around its lines, the labels of the time below.
inline constexpr float caption_line = 27, caption_edge = 16, time_labels_height = 36;

/// The panels first. Two beside each other get circles of 55 to 60 % of the picture's height, with the strips below
/// or, where that leaves too little for these, in a column at the right. A panel alone is a square beside its strips.
Regions split_regions(const Area& room, const RegionNeeds& needs);

/// How a film's words put it: upright ones are for a telephone.
Wording wording_of(const Scene& scene);

/// The time as the clock shows it, with as many decimals as tell one frame from the next.
std::string clock_text(const Scene& scene, double time);
/// What the film says of its speed: "slow motion ×0.25"; where it changes, "¼ speed".
std::string speed_text(const Scene& scene, double time);

/// Adds the title, the line below it, the speed, and the clock's place. Returns where they end, px from the top.
float place_header(Layout& layout, const Scene& scene);

/// Shares the room below the header out, and adds what sets the sides apart: above the panels in a line, in two where
/// it is long; in a corner of an upright film's panel where the circle leaves it free.
Regions place_headings(Layout& layout, const Scene& scene, const Area& room, RegionNeeds needs);

}  // namespace doppel
