#include "film/strips.hpp"

#include "film/recording.hpp"
#include "numeric/state.hpp"
#include "plot/labels.hpp"
#include "scene/captions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace doppel {
namespace {

constexpr std::array<const char*, strip_kinds> titles{"state-space distance",
                                                      "finite-time growth rate, 1/s",
                                                      "energy error, of the potential range",
                                                      "rod length error, m",
                                                      "rod tension, N",
                                                      "energy, J",
                                                      "energy, J",
                                                      "angles, °",
                                                      "angular rates, °/s",
                                                      "energy, J"};

/// Of an ensemble, the sides are its first and its last member.
std::string side_name(const Scene& scene, bool is_a) {
    return scene.members.empty() ? is_a ? "a" : "b" : is_a ? "first" : "last";
}

/// A part of a caption in one line; with `room` > 0 it has that width in px whatever its text.
struct Piece {
    std::string text;
    Color color;
    float room = 0;
};

/// With two digits always, so that its length changes little from frame to frame.
std::string distance_text(double value) {
    return value >= 0.1 && value < 9.95 ? fmt::format("{:#.2g}", value) : scientific(value);
}

/// What follows the caption's title.
std::vector<Piece> pieces_of(StripKind kind, const Scene& scene, const Layout& layout,
                             const std::vector<StripCurve>& curves, bool starts_equal) {
    const auto& theme = layout.style.theme;
    const auto width = [&](const char* text) { return layout.style.type.width(text, px(layout.style.font.strip)); };
    std::vector<Piece> pieces;
    if (kind == StripKind::distance)
        pieces.push_back({distance_text(*curves[0].value), curves[0].color, width("8.8 × 10⁻⁸⁸")});
    else if (kind == StripKind::exponent && starts_equal)
        pieces.push_back({"none, d₀ = 0", theme.quiet_text});
    else if (kind == StripKind::exponent)
        pieces.push_back(
            {curves[0].value ? fmt::format("{:.2f}", *curves[0].value) : "", curves[0].color, width("−8.88")});
    else if (kind == StripKind::energy &&
             std::ranges::none_of(curves, [](const auto& one) { return one.value.has_value(); }))
        pieces.push_back({"none: damping removes energy", theme.quiet_text});
    const auto is_by_angles = [&](char letter) {
        const auto& side = scene.side(letter);
        return side.replay || side.motion.model == Model::angles;
    };
    if (kind == StripKind::rod_error && std::ranges::all_of(scene.letters(), is_by_angles))
        pieces.push_back({"none: angles keep the lengths", theme.quiet_text});
    for (const auto& curve : curves)
        if (!curve.name.empty()) pieces.push_back({curve.name, curve.color, width(curve.name.c_str())});
    return pieces;
}

/// A caption of this size in lines no wider than `width`, px. The first line begins at (0, 0).
std::vector<Label> strip_caption(StripKind kind, const Scene& scene, const Layout& layout,
                                 const std::vector<StripCurve>& curves, bool starts_equal, float width, float size) {
    const auto& type = layout.style.type;
    std::vector<Label> labels;
    Point pen;
    const auto add = [&](const Piece& piece) {
        const float room = std::max(piece.room, type.width(piece.text, size));
        if (pen.x > 0) pen.x += 0.66f * size;
        if (pen.x > 0 && pen.x + room > width) pen = {0, pen.y + caption_line(layout)};
        labels.push_back(label(piece.text, pen, size, piece.color));
        pen.x += room;
    };
    for (auto& row : wrapped(title_of(kind, scene), size, Weight::regular, width, type))
        add({std::move(row), layout.style.theme.text});
    for (const auto& piece : pieces_of(kind, scene, layout, curves, starts_equal)) add(piece);
    return labels;
}

}  // namespace

std::string title_of(StripKind kind, const Scene& scene) {
    const auto &a = scene.preset.a, &b = scene.preset.b;
    std::string title = titles[static_cast<std::size_t>(kind)];
    const bool is_a = kind == StripKind::energies_a;
    if ((is_a || kind == StripKind::energies_b) && !scene.is_single())
        return fmt::format("energy of {}, J", (is_a ? a : b).label.value_or(side_name(scene, is_a)));
    const auto is_driven = [&](const SideSpec& side) {
        return drive_period(side, scene.preset.duration_s).has_value();
    };
    if (kind == StripKind::total_energy && (is_driven(a) || is_driven(b))) return title + ", mean over a drive period";
    if (kind != StripKind::distance) return title;
    if (wording_of(scene) == Wording::plain) title = "their distance";
    if (!scene.members.empty()) return title + ", first to last";
    return differ_in_kind(a, b) ? title + ", of the last masses" : title;
}

std::vector<StripCurve> strip_curves(StripKind kind, const Scene& scene, const PairState& state, double start_distance,
                                     const Style& style) {
    const auto& theme = style.theme;
    const double width = style.width.trace;  // of single curves
    // a second curve of the same side: on light only as pale as can be seen, because dark ones look black
    const auto paler = [&](Color color, Color other, float share) {
        return theme.is_dark() ? mixed(color, other, share) : mixed(color, theme.background, 0.27f);
    };
    if (kind == StripKind::distance) return {{state.distance, theme.trace, width}};
    if (kind == StripKind::exponent) return {{growth_rate(scene, state, start_distance), theme.trace, width}};
    std::vector<StripCurve> curves;
    constexpr double degree = pi / 180;
    for (const char letter : scene.letters()) {
        const bool is_a = letter == 'a';
        const auto& side = scene.side(letter);
        const auto& seen = is_a ? state.a : state.b;
        const auto color = theme.sides[is_a ? 0 : 1];
        // the first is drawn first and is wider, so that both are visible where they coincide
        const double of_side = (scene.is_single() ? 1 : is_a ? 1.5 : 0.6) * width;
        // a curve for each link or rod; for many, the first and the last one; the inner ones are paler
        const auto add_all = [&](std::size_t count, const auto& value) {
            constexpr std::size_t maximum = 3;
            for (std::size_t k = 0; k < count; ++k)
                if (const bool is_last = k + 1 == count; count <= maximum || k == 0 || is_last)
                    curves.push_back(
                        {value(k), is_last ? color : paler(color, theme.text, 0.6f), of_side,
                         fmt::format("{}{}{}", side_name(scene, is_a), scene.members.empty() ? "" : " ", k + 1)});
        };
        switch (kind) {
            case StripKind::rod_error:
                curves.push_back({seen.length_error, color, of_side});
                break;
            case StripKind::energy:  // damping reduces the energy, so its change is no error
                curves.push_back({std::abs(seen.energy_change) / scene.energy_range(), color, of_side});
                if (!side.has_energy_error) curves.back().value.reset();
                break;
            case StripKind::total_energy:
                curves.push_back({seen.mean_energy, color, of_side});
                if (auto& mean = curves.back().value) *mean -= side.lowest_potential;
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
                curves.push_back({seen.kinetic_energy, color, 0.8 * width, "kinetic"});
                curves.push_back({seen.energy - side.lowest_potential - seen.kinetic_energy,
                                  paler(color, theme.background, 0.35f), 0.8 * width, "potential"});
                curves.push_back({seen.energy - side.lowest_potential, theme.text, 0.6 * width, "total"});
        }
    }
    return curves;
}

std::optional<double> growth_rate(const Scene& scene, const PairState& state, double start_distance) {
    if (state.sample == 0 || 20 * state.sample < scene.samples) return std::nullopt;
    if (!(state.distance > 0 && start_distance > 0)) return std::nullopt;
    return std::log(state.distance / start_distance) / scene.time(state.moment());
}

float caption_line(const Layout& layout) {
    return 1.24f * px(layout.style.font.strip);
}

float above_curves(const Layout& layout) {
    return 0.9f * px(layout.style.font.strip);
}

std::vector<Label> placed_caption(const StripLayout& strip, const Scene& scene, const Layout& layout,
                                  const std::vector<StripCurve>& curves, bool starts_equal) {
    const float room = caption_line(layout) * (static_cast<float>(strip.lines) - 0.5f), width = strip.cell.width();
    const auto is_cut = [&](const Label& one) {
        return one.anchor.y > room || layout.style.type.width(one.text, one.size) > width + 1;
    };
    std::vector<Label> words;
    for (const float share : {1.0f, 0.85f, 0.75f}) {
        const float size = std::max(share * px(layout.style.font.strip), layout.min_text);
        words = strip_caption(strip.kind, scene, layout, curves, starts_equal, width, size);
        if (std::ranges::none_of(words, is_cut)) break;
    }
    const bool ends_early = is_cut(words.back());
    std::erase_if(words, is_cut);
    if (ends_early && !words.empty()) {
        auto& last = words.back();
        const auto longer = last.text + " …";
        if (last.anchor.x + layout.style.type.width(longer, last.size) <= width) last.text = longer;
    }
    for (auto& label : words) label.anchor = {strip.cell.left + label.anchor.x, strip.baseline + label.anchor.y};
    return words;
}

int caption_lines(StripKind kind, const Scene& scene, const Layout& layout, float width) {
    const auto curves = strip_curves(kind, scene, blank_snapshot(scene).pair, 0, layout.style);
    const auto labels = strip_caption(kind, scene, layout, curves, false, width, px(layout.style.font.strip));
    return 1 + static_cast<int>(std::lround(labels.back().anchor.y / caption_line(layout)));
}

}  // namespace doppel
