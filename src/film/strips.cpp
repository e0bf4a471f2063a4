#include "film/strips.hpp"

#include "film/layout.hpp"
#include "numeric/state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace doppel {
namespace {

/// How much of a height that strips share each kind gets, and its words.
struct StripRow {
    float share;
    const char *what, *how;
};
constexpr std::array<StripRow, strip_kinds> rows{{{0.24f, "state-space distance", ""},
                                                  {0.18f, "finite-time growth rate", "1/s"},
                                                  {0.15f, "energy error", "of the potential range"},
                                                  {0.15f, "maximum rod error, m", ""},
                                                  {0.18f, "rod tension, N", ""},
                                                  {0.18f, "energy of {}, J", ""},
                                                  {0.18f, "energy of {}, J", ""},
                                                  {0.18f, "angles, °", ""},
                                                  {0.18f, "angular rates, °/s", ""},
                                                  {0.18f, "energy, J", ""}}};

const StripRow& row_of(StripKind kind) {
    return rows[static_cast<std::size_t>(kind)];
}

/// A curve for each link or rod: of few, of many the first and the last; the inner ones paler.
template <class Value>
void add_links(std::vector<StripCurve>& curves, char side, std::size_t count, const Value& value, Color color,
               Color pale, double width) {
    constexpr std::size_t most = 3;
    const float paleness = count < 2 ? 0 : 0.6f;
    for (std::size_t k = 0; k < count; ++k)
        if (count <= most || k == 0 || k + 1 == count)
            curves.push_back(
                {value(k), mixed(color, pale, k + 1 == count ? 0 : paleness), width, fmt::format("{}{}", side, k + 1)});
}

/// The names of a strip's curves.
std::vector<std::string> curve_names(StripKind kind, const Scene& scene) {
    PairState any;
    for (const auto& [seen, side] : {std::pair{&any.a, &scene.a}, {&any.b, &scene.b}}) {
        seen->bobs.resize(side->mass.size());
        seen->tension.resize(side->mass.size());
    }
    std::vector<std::string> names;
    for (const auto& curve : strip_curves(kind, scene, any, 0, themes[0], 1))
        if (!curve.name.empty()) names.push_back(curve.name);
    return names;
}

/// How many lines the words above a strip take in a room that wide, and the width of all in one, px.
std::pair<int, float> caption_size(const Layout& layout, const Scene& scene, StripKind kind, bool is_first,
                                   float room) {
    const float t = layout.text, gap = 14 * t;
    const auto width = [&](const std::string& text) {
        return layout.style.type.width(text, px(layout.style.font.strip));
    };
    const auto words = strip_words(kind, scene);
    float value = 0;  // beside the name; below it
    const auto names = curve_names(kind, scene);
    for (const auto& name : names) value += width(name) + (&name == &names.back() ? 0 : gap);
    float second = value;
    if (kind == StripKind::distance) value = second = value_room * t;
    if (kind == StripKind::exponent) {
        const float none = width(alike_words);
        value = std::max(value_room * t, none);
        second = std::max(brief_value_room * t + width(words.how), none);
    }
    if (kind == StripKind::energy) {
        value = width(no_error_words(kind, scene));
        second = value > 0 ? value : width(words.how);
    }
    const float parted = is_first ? width("diverged at 00.0 s") : 0;
    float one_line = width(words.what) + (words.how.empty() ? 0 : width(", " + words.how));
    if (value > 0) one_line += 18 * t + value;
    if (is_first) one_line += gap + parted;
    return {one_line <= room ? 1 : !is_first || second + parted <= room ? 2 : 3, one_line};
}

}  // namespace

std::vector<StripCurve> strip_curves(StripKind kind, const Scene& scene, const PairState& state, double start_distance,
                                     const Theme& theme, double width) {
    if (kind == StripKind::distance) return {{state.distance, theme.trace, width}};
    if (kind == StripKind::exponent) return {{exponent_so_far(scene, state, start_distance), theme.trace, width}};
    std::vector<StripCurve> curves;
    constexpr double degree = pi / 180;
    for (const char letter : {'a', 'b'}) {
        const bool is_a = letter == 'a';
        const auto& side = is_a ? scene.a : scene.b;
        const auto& seen = is_a ? state.a : state.b;
        const auto color = theme.sides[is_a ? 0 : 1];
        // of two lines the first is wider, so that it still shows where both run as one
        const double of_side = (is_a ? 1.5 : 0.64) * width;
        const double kinetic = seen.kinetic_energy;
        const auto add_all = [&](std::size_t count, const auto& value) {
            add_links(curves, letter, count, value, color, theme.text, 0.8 * width);
        };
        switch (kind) {
            case StripKind::rod_error:
                curves.push_back({seen.length_error, color, of_side});
                break;
            case StripKind::energy:  // where damping takes energy no change of it is an error
                curves.push_back({std::abs(seen.energy_change) / scene.energy_range(), color, of_side});
                if (!side.has_energy_error) curves.back().value.reset();
                break;
            case StripKind::total_energy:
                curves.push_back({seen.energy, color, of_side});
                break;
            case StripKind::rod_force:
                add_all(seen.tension.size(), [&](std::size_t k) { return seen.tension[k]; });
                break;
            case StripKind::angles:
                add_all(seen.bobs.size(), [&](std::size_t k) { return seen.bobs[k].theta / degree; });
                break;
            case StripKind::rates:
                add_all(seen.bobs.size(), [&](std::size_t k) { return seen.bobs[k].omega / degree; });
                break;
            default:
                if (is_a != (kind == StripKind::energies_a)) break;
                curves.push_back({kinetic, color, 0.8 * width, "kinetic"});
                curves.push_back(
                    {seen.energy - kinetic, mixed(color, theme.background, 0.45f), 0.8 * width, "potential"});
                curves.push_back({seen.energy, theme.text, 0.64 * width, "total"});
        }
    }
    return curves;
}

std::optional<double> exponent_so_far(const Scene& scene, const PairState& state, double start_distance) {
    if (state.sample == 0 || 20 * state.sample < scene.samples) return std::nullopt;
    if (!(state.distance > 0 && start_distance > 0)) return std::nullopt;
    return std::log(state.distance / start_distance) / scene.time(state.moment());
}

float share_of(StripKind kind) {
    return row_of(kind).share;
}

std::string no_error_words(StripKind kind, const Scene& scene) {
    const bool none = kind == StripKind::energy && !scene.a.has_energy_error && !scene.b.has_energy_error;
    return none ? "none: damping removes energy" : "";
}

StripWords strip_words(StripKind kind, const Scene& scene) {
    StripWords words{row_of(kind).what, row_of(kind).how};
    if (kind == StripKind::energies_a || kind == StripKind::energies_b) {
        const bool is_a = kind == StripKind::energies_a;
        words.what =
            fmt::format("energy of {}, J", (is_a ? scene.preset.a : scene.preset.b).label.value_or(is_a ? "a" : "b"));
    }
    if (kind != StripKind::distance) return words;
    if (wording_of(scene) == Wording::plain) words.what = "their distance";
    if (!scene.members.empty()) return {words.what, "first to last", "distance, first to last"};
    if (differ_in_kind(scene.preset.a, scene.preset.b))
        return {words.what, "of the last masses", "distance of last masses"};
    return words;
}

CaptionPlan plan_captions(const Layout& layout, const Scene& scene, const Area& room, float labels) {
    const auto& strips = scene.preset.video.strips;
    const float t = layout.text;
    CaptionPlan plan{.line = caption_line * t, .edge = 2 * t};
    plan.from_edge = room.width() < 0.3f * layout.page.width();
    for (const auto kind : strips) {
        const auto [lines, width] = caption_size(layout, scene, kind, plan.lines.empty(), room.width());
        plan.lines.push_back(lines);
        plan.from_edge |= lines > 1 || width > room.width() - labels;
    }
    plan.apart = (plan.from_edge ? 20 : 14) * t;
    // where many strips share a little room, curves come before words
    const float least = 26 * t * static_cast<float>(strips.size());
    const auto curves = [&] {
        float left = room.height() - time_labels_height * t;
        for (std::size_t i = 0; i < strips.size(); ++i) left -= plan.height(i);
        return left;
    };
    for (auto most = std::ranges::max_element(plan.lines); *most > 1 && curves() < least;
         most = std::ranges::max_element(plan.lines))
        --*most;
    return plan;
}

}  // namespace doppel
