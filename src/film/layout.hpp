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
#include <functional>
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

/// A strip: a chart of a quantity over time, with words above it.
struct StripLayout {
    StripKind kind;
    Area cell;           // all of it
    Area area;           // within the axes
    Axis time, value;    // across, up
    int lines = 1;       // of its caption
    float baseline = 0;  // of the first, px
};

/// Upright: for a telephone.
inline bool is_tall(const VideoSpec& video) {
    return video.size.height > video.size.width;
}

/// Where everything of a film's picture goes: a function of the scene, and of how far its motion gets.
struct Layout {
    float unit = 1;        // 1 px of a 1920×1080 picture
    float text = 1;        // the same for text, which stays legible in small pictures and on telephones
    float least_text = 9;  // px an em, of any word
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
};

/// A film's picture, or a tile of a contact sheet: pendulums and time alone.
enum class PictureKind { film, tile };

/// `bounds`: of the whole motion, where the picture depends on it (depends_on_motion()). A tile has no strips.
Layout make_layout(const Scene& scene, const MotionBounds& bounds, PictureKind dress = PictureKind::film);

/// The size of a tile of that width, px.
Size tile_size(const Scene& scene, int width);

/// What decides how a picture is split; lengths in px.
struct RegionNeeds {
    std::size_t panels = 2, strips = 0;        // how many
    bool tall = false;                         // strips below one another, below the panels
    float heading = 0;                         // height of the words above each panel
    float gap = 0;                             // between panels, and between them and strips
    float height = 0;                          // of the whole picture
    float numbers = 0;                         // height of the numbers of the time, below the lowest strip of a column
    std::function<float(float)> caption = {};  // height of the words above strips that wide
};

/// A picture below the header, split.
struct Regions {
    std::vector<Area> panels;  // without their headings
    std::vector<Area> strips;  // with captions and numbers
};

/// A panel's size to that of the circle in it: a bob at the circle's rim stays inside.
inline constexpr float around_circle = 1.08f;

/// Strips get a fifth of the picture's height each, without their words, as far as there is room: up to three in a row
/// below panels beside each other, more, or in small pictures, in a column at the right; below one another in upright
/// pictures. Panels get the largest circles then.
Regions split(const Area& room, const RegionNeeds& needs);

/// How a film's words put it: upright ones are for a telephone.
Wording wording_of(const Scene& scene);

/// The time as the clock shows it, with as many decimals as tell one frame from the next.
std::string clock_text(const Scene& scene, double time);
/// What the film says of its speed: "slow motion ×0.25"; where it changes, "¼ speed".
std::string speed_text(const Scene& scene, double time);

/// Adds the title, the line below it, the speed, and the clock's place. Returns where they end, px from the top.
float place_header(Layout& layout, const Scene& scene);

/// Splits the room below the header, and adds what sets the sides apart: above the panels in a line, in two where it is
/// long.
Regions place_headings(Layout& layout, const Scene& scene, const Area& room, RegionNeeds needs);

/// Text in as much as `width` px: shrunk to no less than three quarters and to what can be read, then without its last
/// words.
struct FittedText {
    std::string text;
    float size;
};
FittedText fitted_text(const Layout& layout, const std::string& text, float size, Weight weight, float width);

}  // namespace doppel
