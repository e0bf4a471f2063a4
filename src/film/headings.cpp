#include "film/layout.hpp"
#include "plot/labels.hpp"
#include "render/typeface.hpp"
#include "scene/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace doppel {
namespace {

struct Heading {
    std::size_t panel, side;
    SideCaptions said;
    Align align = Align::left;
};

std::vector<Heading> headings_of(const Scene& scene) {
    const bool side_by_side = has_panel_for_each(scene.preset.video);
    const auto said = side_captions(scene, wording_of(scene));
    if (scene.is_single()) return {{0, 0, said[0]}};
    return {{0, 0, said[0]}, {side_by_side ? 1u : 0u, 1, said[1], side_by_side ? Align::left : Align::right}};
}

/// Text sizes at which the headings of all panels fit, px.
struct HeadingSizes {
    float heading, note, width;  // width: of all texts of a side
    bool two_lines = false;
};

constexpr float note_gap = 16;  // px of a 1920×1080 picture, between a heading and the note after it

HeadingSizes fitted(const std::vector<Heading>& headings, const Layout& layout, float width) {
    const auto& font = layout.style.font;
    float one = 1, heading = 1, note = 1;
    for (const auto& words : headings) {
        const float head = layout.style.type.width(words.said.heading, px(font.heading), Weight::bold),
                    tail = layout.style.type.width(words.said.note, px(font.note));
        const float gap = words.said.note.empty() ? 0 : note_gap * layout.text;
        one = std::min(one, width / std::max(head + gap + tail, 1.0f));
        heading = std::min(heading, width / std::max(head, 1.0f));
        note = std::min(note, width / std::max(tail, 1.0f));
    }
    constexpr float minimum = 0.85f;  // smallest scale before notes go on a line of their own
    const bool two = (one < minimum || one * px(font.note) < layout.min_text) &&
                     std::ranges::any_of(headings, [](const Heading& words) { return !words.said.note.empty(); });
    if (!two) return {one * px(font.heading), one * px(font.note), width};
    const float head = heading * px(font.heading);
    return {head, std::min(note * px(font.note), head), width, true};
}

void add_above(Layout& layout, const Heading& words, const HeadingSizes& sizes, const Area& panel) {
    const auto& theme = layout.style.theme;
    const float t = layout.text;
    const bool right = words.align == Align::right;
    const auto fitted_to = [&](const std::string& text, float size, Weight weight) {
        return fitted_text(layout, text, std::max(size, layout.min_text), weight, sizes.width);
    };
    const auto head = fitted_to(words.said.heading, sizes.heading, Weight::bold);
    const auto tail = fitted_to(words.said.note, sizes.note, Weight::regular);
    Point head_at{right ? panel.right : panel.left, panel.top - 12 * t}, tail_at = head_at;
    if (sizes.two_lines)
        head_at.y -= 1.25f * tail.size;
    else if (!right)
        tail_at.x = tail_at.x + layout.style.type.width(head.text, head.size, Weight::bold) + note_gap * t;
    else if (!tail.text.empty())
        head_at.x -= layout.style.type.width(tail.text, tail.size) + note_gap * t;
    const auto add = [&](const FittedText& fits, Point at, Color color, Weight weight) {
        if (!fits.text.empty()) layout.words.push_back(label(fits.text, at, fits.size, color, words.align, weight));
    };
    add(head, head_at, theme.sides[words.side], Weight::bold);
    add(tail, tail_at, theme.quiet_text, Weight::regular);
}

/// The size at which the text fits, but at least three quarters of `size` and legible, px.
float fitted_size(const Layout& layout, const std::string& text, float size, Weight weight, float width) {
    const float minimum = std::min(size, std::max(0.75f * size, layout.min_text));
    return std::max(minimum, layout.style.type.fitting_size(text, size, weight, width));
}

/// Of headings that would be cut to the same words, "…" and what differs.
void keep_difference(std::vector<Heading>& headings, const Layout& layout, float width) {
    auto &one = headings.front().said.heading, &other = headings.back().said.heading;
    const auto cut = [&](const std::string& text) {
        return fitted_text(layout, text, px(layout.style.font.heading), Weight::bold, width).text;
    };
    const auto same = static_cast<std::size_t>(std::ranges::mismatch(one, other).in1 - one.begin());
    const auto space = one.rfind(' ', same);
    if (one == other || space == std::string::npos || cut(one) != cut(other)) return;
    for (auto* text : {&one, &other}) text->replace(0, space, "…");
}

/// A colour bar for the members, between the captions of the first and the last one.
void add_color_bar(Layout& layout, const std::array<SideCaptions, 2>& said, const Area& panel) {
    const float t = layout.text, base = panel.top - 14 * t, gap = 14 * t;
    std::array<float, 2> width{};
    const float maximum = 0.36f * panel.width();
    float size = px(layout.style.font.note);
    for (std::size_t side = 0; side < 2; ++side) {
        const auto words = fitted_text(layout, said[side].heading, px(layout.style.font.note), Weight::bold, maximum);
        size = std::min(size, words.size);
        width[side] = layout.style.type.width(words.text, words.size, Weight::bold);
        layout.words.push_back(label(words.text, {side == 0 ? panel.left : panel.right, base}, words.size,
                                     layout.style.theme.text, side == 0 ? Align::left : Align::right, Weight::bold));
    }
    const float left = std::round(panel.left + width[0] + gap), right = std::round(panel.right - width[1] - gap);
    const float top = std::round(base - 0.6f * size), bottom = std::round(base);
    for (float x = left; x < right; ++x)  // columns overlap, so that no seam shows in PDF and SVG
        layout.words.push_back(Box{x, top, right, bottom, 0,
                                   member_color(layout.style.theme, double{x - left} / double{right - left - 1})});
}

/// The common part of the members' captions ("θ₁ ="), and what differs for each ("120.01°").
std::pair<std::string, std::vector<std::string>> legend_words(const Scene& scene) {
    const auto& members = scene.preset.video.members.releases;
    std::string before;
    std::vector<std::string> words(members.size());
    const auto add = [&](const Release::List& list, std::size_t j) {
        before += fmt::format("{}{}{}", before.empty() ? "" : ", ", list.symbol, subscript(j + 1));
        for (std::size_t k = 0; k < members.size(); ++k) {
            const auto& chain = *scene.members[k].chain;
            const auto number = list.symbol == "θ"   ? chain.angle[j] * 180 / pi_of<Quad>()
                                : list.symbol == "m" ? chain.mass[j]
                                                     : chain.length[j];
            words[k] +=
                fmt::format("{}{:.12g}{}", words[k].empty() ? "" : ", ", static_cast<double>(number), list.unit);
        }
    };
    for (const auto& list : Release::lists)
        for (std::size_t j = 0; j < scene.preset.a.links(); ++j)
            if (std::ranges::any_of(members, [&](const Release& member) {
                    const auto &one = member.*list.member, &first = members[0].*list.member;
                    return one.empty() != first.empty() || (!one.empty() && one[j] != first[j]);
                }))
                add(list, j);
    if (before.empty()) add(Release::lists[0], 0);
    return {before + " =", words};
}

/// The captions of listed members, each after a dot in its colour. They take as many lines as needed; the last baseline
/// is at `base` px. Returns the number of lines.
int add_legend(Layout& layout, const Scene& scene, float left, float width, float base) {
    const auto [before, words] = legend_words(scene);
    const auto& theme = layout.style.theme;
    const float size = 0.85f * px(layout.style.font.heading), line = 1.3f * size;
    constexpr float dot = 0.32f, after_dot = 0.85f, after_word = 0.8f;  // em
    const auto width_of = [&](const std::string& text) { return layout.style.type.width(text, size); };
    std::vector<Point> places;  // from the left end of the first line
    Point pen{width_of(before) + after_word * size, 0};
    for (const auto& word : words) {
        const float room = after_dot * size + width_of(word);
        if (pen.x + room > width && !places.empty() && pen.x > 0) pen = {0, pen.y + line};  // the first stays
        places.push_back(pen);
        pen.x += room + after_word * size;
    }
    const float first = base - pen.y;
    layout.words.push_back(label(before, {left, first}, size, theme.quiet_text));
    const auto members = shown_pendulums(scene, layout.style);
    for (std::size_t k = 0; k < words.size(); ++k) {
        const Point at{left + places[k].x + dot * size, first + places[k].y - 0.36f * size};
        layout.words.push_back(Capsule{at, at, dot * size, members[k].color});
        const float room = width - places[k].x - after_dot * size;
        const auto text = fitted_text(layout, words[k], size, Weight::regular, room);
        layout.words.push_back(
            label(text.text, {left + places[k].x + after_dot * size, first + places[k].y}, text.size, theme.text));
    }
    return 1 + static_cast<int>(std::lround(pen.y / line));
}

}  // namespace

std::string clock_text(const Scene& scene, double time) {
    const double frame = 1 / (scene.fps.value() / scene.preset.video.speed.slowest().value());
    return fmt::format("{:.{}f} s", time, frame >= 1 ? 0 : frame >= 0.1 ? 1 : 2);
}

std::string speed_text(const Scene& scene, double time) {
    const auto speed = speed_at(scene.preset.video, time);
    if (speed == Rational{1, 1}) return "real time";
    return fmt::format("{} ×{:.3g}", speed.value() < 1 ? "slow motion" : "time lapse", speed.value());
}

Wording wording_of(const Scene& scene) {
    return scene.preset.video.layout == Arrangement::portrait ? Wording::plain : Wording::exact;
}

float place_header(Layout& layout, const Scene& scene) {
    const auto& video = scene.preset.video;
    const auto& theme = layout.style.theme;
    const auto& font = layout.style.font;
    const auto& page = layout.page;
    const float t = layout.text, gap = 30 * t;
    const bool tall = is_tall(video), changes = video.speed.changes_over_time(), has_clock = video.shows("clock");
    const auto title = video.shows("title") ? scene.preset.title : "";
    auto below = video.shows("subtitle") ? scene_caption(scene, tall ? Wording::plain : Wording::exact) : "";
    if (is_low(video)) below.clear();
    if (title.empty() && below.empty() && !has_clock) return page.top;
    const auto width_of = [&](const std::string& text, double size, Weight weight = Weight::regular) {
        return layout.style.type.width(text, px(size), weight);
    };
    // a small picture has a short subtitle: the system in readable text, without the integrator
    if (!below.empty() && !scene.preset.subtitle && 0.8f * width_of(below, font.subtitle) > 0.85f * page.width())
        below = scene_caption(scene, Wording::plain);
    const auto speed =
        has_clock && !is_low(video) ? changes ? std::string("slow motion ×0.25") : speed_text(scene, 0) : std::string();
    if (tall && has_clock && !changes && video.speed.constant != Rational{1, 1})
        below += (below.empty() ? "" : " · ") + speed;
    // long text is shrunk a little to fit beside the text at the right, then continues below; in a low picture it ends
    // the clock is beside the title, in tall pictures beside the subtitle
    const float clock_px = has_clock ? px(font.clock) : 0, below_px = std::max(px(font.subtitle), tall ? clock_px : 0);
    const float title_px = std::max(px(font.title), tall ? 0 : clock_px);
    const float first = page.top + std::max(36 * t, 0.857f * title_px);
    float base = first;
    const auto add = [&](const std::string& text, double size, Weight weight, Color color, float beside) {
        const float width = page.width() - (beside > 0 ? beside + gap : 0);
        const auto& type = layout.style.type;
        const float fits = fitted_size(layout, text, px(size), weight, width), line = 1.24f * fits;
        std::vector<std::string> lines{text};
        if (type.width(text, fits, weight) > width + 1) lines = wrapped(text, fits, weight, width, type);
        if (static_cast<float>(lines.size() - 1) * line > 0.16f * page.height())
            lines = {fitted_text(layout, text, fits, weight, width).text};
        for (std::size_t k = 0; k < lines.size(); ++k) {
            if (k > 0) base += line;
            layout.words.push_back(label(lines[k], {page.left, base}, fits, color, Align::left, weight));
        }
    };
    const float clock = has_clock ? width_of(clock_text(scene, scene.time(scene.samples)), font.clock) : 0;
    const float speed_width = width_of(speed, font.subtitle);
    const float line = std::max((tall ? 52 : 36) * t, 0.25f * title_px + 0.94f * below_px);
    add(title, font.title, Weight::bold, theme.text, !tall ? clock : changes ? speed_width : 0);
    if (!is_low(video) || tall) base += line;
    const float second = base;
    add(below, font.subtitle, Weight::regular, theme.quiet_text, tall ? clock : speed_width);
    if (has_clock) {
        const auto words =
            label(speed, {page.right, tall ? first : second}, px(font.subtitle), theme.quiet_text, Align::right);
        if (changes && !speed.empty())
            layout.speed = words;
        else if (!tall && !speed.empty())
            layout.words.push_back(words);
        layout.clock = label("", {page.right, tall ? second : first}, px(font.clock), theme.text, Align::right);
    }
    return base + std::max(18 * t, 0.42f * below_px);
}

FittedText fitted_text(const Layout& layout, const std::string& text, float size, Weight weight, float width) {
    const auto& type = layout.style.type;
    const float fits = fitted_size(layout, text, size, weight, width);
    constexpr float rounding = 0.01f;  // px
    if (type.width(text, fits, weight) <= width + rounding) return {text, fits};
    if (const auto equals = text.find(" = ");
        equals < text.size() && equals == text.find(' ') && equals == text.rfind(" = "))
        return fitted_text(layout, text.substr(equals + 3), size, weight, width);  // the number of a single symbol
    auto start = wrapped(text, fits, weight, width - type.width(" …", fits, weight), type).front();
    if (!text.starts_with(start + ' ')) return {"…", fits};  // its first word is too wide
    return {start.erase(start.find_last_not_of(" ,") + 1) + " …", fits};
}

Regions place_headings(Layout& layout, const Scene& scene, const Area& room, RegionNeeds needs) {
    if (needs.panels == 0 || !scene.preset.video.shows("labels")) return split(room, needs);
    const float t = layout.text;
    auto headings = headings_of(scene);
    for (auto& words : headings)
        if (is_low(scene.preset.video)) words.said.note.clear();
    needs.heading = std::max(46 * t, 12 * t + 0.99f * px(layout.style.font.heading));
    auto regions = split(room, needs);
    if (!scene.preset.video.members.releases.empty()) {
        const auto words = layout.words;
        const auto add = [&] {
            layout.words = words;
            const auto& panel = regions.panels[0];
            return add_legend(layout, scene, panel.left, panel.width(), panel.top - 14 * t);
        };
        // a higher legend makes the panel narrower, which may take more lines
        for (int lines = 1, wanted = add(); wanted > lines; wanted = add()) {
            needs.heading += static_cast<float>(wanted - lines) * 1.3f * 0.85f * px(layout.style.font.heading);
            regions = split(room, needs);
            lines = wanted;
        }
        return regions;
    }
    if (!scene.members.empty()) {
        add_color_bar(layout, {headings[0].said, headings[1].said}, regions.panels[0]);
        return regions;
    }
    const float share = headings.size() > 1 && headings[0].panel == headings[1].panel ? 0.48f : 1;
    const auto width = [&] { return share * regions.panels[0].width() - 14 * t; };  // separate from the text beside it
    keep_difference(headings, layout, width());
    auto sizes = fitted(headings, layout, width());
    if (sizes.two_lines) {
        needs.heading = std::max(81 * t, 12 * t + 1.25f * sizes.note + sizes.heading);
        regions = split(room, needs);
        sizes = fitted(headings, layout, width());
    }
    for (const auto& heading : headings) add_above(layout, heading, sizes, regions.panels[heading.panel]);
    return regions;
}

}  // namespace doppel
