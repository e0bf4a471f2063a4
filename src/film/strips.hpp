#pragma once

#include "image/color.hpp"
#include "scene/scene.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// A curve of a strip at a moment; with a name where the strip has several.
struct StripCurve {
    std::optional<double> value;
    Color color;
    double width = 0;  // px
    std::string name{};
};

/// What goes up in a strip, where curves of one line are `width` px wide.
std::vector<StripCurve> strip_curves(StripKind kind, const Scene& scene, const PairState& state, double start_distance,
                                     const Theme& theme, double width);

/// ln(d/d0) / t, 1/s: nothing in the first twentieth of the scene, when it says nothing yet, or where a distance is 0.
std::optional<double> exponent_so_far(const Scene& scene, const PairState& state, double start_distance);

/// How much of a height that strips share goes to one.
float share_of(StripKind kind);

/// What the words above a strip say: what it shows, and of what or how; in one where there is little room.
struct StripWords {
    std::string what, how, brief{};

    std::string in_full() const { return what + (how.empty() ? "" : ", " + how); }
};
StripWords strip_words(StripKind kind, const Scene& scene);

/// In place of curves where friction or damping takes energy from both sides; empty where not.
std::string no_error_words(StripKind kind, const Scene& scene);
/// In place of an exponent.
inline constexpr const char* alike_words = "none: both start equal";

/// px of a 1920×1080 picture that a number above a strip has, so that what comes after it stays in place.
inline constexpr float value_room = 110, brief_value_room = 50;

/// The words above each strip.
struct CaptionPlan {
    std::vector<int> lines;               // the name; the value; when they parted
    bool from_edge = false;               // of the strips' room: over the labels of the axes, too
    float line = 0, apart = 0, edge = 0;  // px: from line to line, from the last to the curves, above the first

    float height(std::size_t strip) const { return edge + line * static_cast<float>(lines[strip]) + apart; }
};

struct Layout;
struct Area;
/// For strips in `room`, whose axes have labels that wide, px.
CaptionPlan plan_captions(const Layout& layout, const Scene& scene, const Area& room, float labels);

}  // namespace doppel
