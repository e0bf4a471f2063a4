#include "film/bounds.hpp"
#include "film/layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace doppel {
namespace {

/// What a strip says besides its name, at most: which line is which.
std::vector<std::string> line_names(StripKind kind, const Scene& scene) {
    if (kind == StripKind::energies_a || kind == StripKind::energies_b) return {"kinetic", "potential", "total"};
    std::vector<std::string> names;
    if (kind != StripKind::rod_force && kind != StripKind::angles && kind != StripKind::rates) return names;
    const std::array<const Side*, 2> sides{&scene.a, &scene.b};
    for (std::size_t side = 0; side < sides.size(); ++side)
        for (const auto k : shown_links(sides[side]->mass.size()))
            names.push_back(fmt::format("{}{}", side == 0 ? "a" : "b", k + 1));
    return names;
}

/// What a strip's words take, px.
struct CaptionWidths {
    float one_line = 0;     // name and value, and when they parted
    float second_line = 0;  // the value and what the name leaves out
    float parted = 0;       // when they parted; of the first strip

    int lines(float room) const {
        if (one_line <= room) return 1;
        return parted == 0 || second_line + parted <= room ? 2 : 3;
    }
};

CaptionWidths caption_widths(const Layout& layout, const Scene& scene, StripKind kind, bool is_first) {
    const float t = layout.text, gap = 14 * t;
    const auto width = [&](const std::string& text) {
        return layout.style.type.width(text, px(layout.style.font.strip));
    };
    const auto words = strip_words(kind, scene);
    float value = 0, second = 0;  // beside the name, below it
    const auto names = line_names(kind, scene);
    for (const auto& name : names) value += width(name) + (&name == &names.back() ? 0 : gap);
    second = value;
    if (kind == StripKind::distance) value = second = value_room * t;
    if (kind == StripKind::exponent) {
        const float none = width("none: both start alike");
        value = std::max(value_room * t, none);
        second = std::max(brief_value_room * t + width(words.how), none);
    }
    if (kind == StripKind::energy) {
        const bool damped = !scene.a.has_energy_error && !scene.b.has_energy_error;
        value = damped ? width("none: damping takes energy") : 0;
        second = damped ? value : width(words.how);
    }
    CaptionWidths widths{width(words.what) + (words.how.empty() ? 0 : width(", " + words.how)), second};
    if (value > 0) widths.one_line += 18 * t + value;
    if (is_first) widths.parted = width("parted at 00.0 s");
    if (is_first) widths.one_line += gap + widths.parted;
    return widths;
}

}  // namespace

StripWords strip_words(StripKind kind, const Scene& scene) {
    const bool plain = wording_of(scene) == Wording::plain;
    switch (kind) {
        case StripKind::distance:
            if (!scene.members.empty())
                return {plain ? "how far apart they are" : "state-space distance", "first to last",
                        "distance, first to last"};
            if (differ_in_kind(scene.preset.a, scene.preset.b))
                return {plain ? "how far apart they are" : "state-space distance", "of the last masses",
                        "distance of last masses"};
            return {plain ? "how far apart they are" : "state-space distance", ""};
        case StripKind::exponent:
            return {"Lyapunov exponent", "so far, 1/s"};
        case StripKind::energy:
            return {"energy error", "of the potential range"};
        case StripKind::total_energy:
            return {"energy, J", ""};
        case StripKind::rod_error:
            return {"worst rod error, m", ""};
        case StripKind::energies_a:
            return {fmt::format("energy of {}, J", scene.preset.a.label.value_or("a")), ""};
        case StripKind::energies_b:
            return {fmt::format("energy of {}, J", scene.preset.b.label.value_or("b")), ""};
        case StripKind::angles:
            return {"angles, °", ""};
        case StripKind::rates:
            return {"angular rates, °/s", ""};
        case StripKind::rod_force:
            break;
    }
    return {"force in the rods, N", ""};
}

CaptionPlan plan_captions(const Layout& layout, const Scene& scene, const Area& room, float labels) {
    const auto& strips = scene.preset.video.strips;
    const float t = layout.text;
    CaptionPlan plan{.line = caption_line * t, .edge = 2 * t};
    plan.from_edge = room.width() < 0.3f * layout.page.width();
    for (const auto kind : strips) {
        const auto widths = caption_widths(layout, scene, kind, plan.lines.empty());
        plan.lines.push_back(widths.lines(room.width()));
        plan.from_edge |= plan.lines.back() > 1 || widths.one_line > room.width() - labels;
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
