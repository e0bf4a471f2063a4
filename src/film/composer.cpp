#include "film/composer.hpp"

#include "base/embedded.hpp"
#include "film/layout.hpp"
#include "render/typeface.hpp"
#include "scene/captions.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

namespace doppel {
namespace {

constexpr float leading = 1.55f;  // times the text size

Label card_line(std::string text, double size, Weight weight, Color color) {
    return label(std::move(text), {}, px(size), color, Align::center, weight);
}

// px of a 1920×1080 picture: the height of all lines of a card, without its picture
constexpr float card_words = 400;

/// One of the film's panels, in the middle of the card; smaller if the lines need the space.
PendulumPanel still_panel(const Layout& layout) {
    auto panel = layout.panels.front();
    const auto& page = layout.page;
    const float room = page.height() - card_words * layout.text;
    const float scale = std::min(1.0f, std::max(room, 0.3f * page.height()) / panel.area.height());
    const float width = scale * panel.area.width(), height = scale * panel.area.height();
    panel.center = {(page.left + page.right) / 2, (page.top + page.bottom) / 2};
    panel.area = {panel.center.x - width / 2, panel.center.y - height / 2, panel.center.x + width / 2,
                  panel.center.y + height / 2};
    panel.px_per_m *= scale;
    if (layout.panels.size() > 1) panel.shown = {0, 1};
    return panel;
}

}  // namespace

Composer::Composer(const Scene& scene, const MotionBounds& bounds) : state_{scene, make_layout(scene, bounds)} {
    const auto& layout = state_.layout;
    layers_ = layers_of(state_);
    const auto& video = scene.preset.video;
    const bool has_cards = video.title_card_s.value() > 0 || video.end_card_s.value() > 0;
    if (!has_cards || layout.panels.empty()) return;
    still_panel_ = still_panel(layout);
    still_ = make_pendulum_layer(state_, still_panel_);
}

DisplayList Composer::backdrop(std::optional<Color> page) const {
    DisplayList list;
    const auto& video = state_.scene.preset.video;
    if (!video.transparent && !page) page = page_color();
    if (page) list.push_back(filled(video.size, *page));
    for (const auto& layer : layers_) {
        layer->marks(list);
        layer->backdrop(list);
    }
    list.insert(list.end(), state_.layout.words.begin(), state_.layout.words.end());
    return list;
}

void Composer::add(const Snapshot& snapshot) {
    state_.snapshot = snapshot;
    if (state_.is_between()) return;
    state_.outcome.add(state_.scene, snapshot.pair);
    for (const auto& layer : layers_) layer->add();
    if (still_) still_->add();
}

DisplayList Composer::frame() const {
    DisplayList list;
    for (const auto& layer : layers_) layer->frame(list);
    const auto& layout = state_.layout;
    for (auto [label, text_at] : {std::pair{layout.clock, &clock_text}, {layout.speed, &speed_text}}) {
        if (!label) continue;
        label->text = text_at(state_.scene, state_.time());
        list.push_back(*label);
    }
    return list;
}

std::string Composer::left_out() const {
    const auto& preset = state_.scene.preset;
    if (is_low(preset.video)) return {};                  // a thumbnail
    const auto is_given = [&](const std::string& text) {  // with its "…"
        return text == preset.title || text == preset.subtitle || text == preset.a.label || text == preset.a.note ||
               text == preset.b.label || text == preset.b.note;
    };
    std::vector<std::string> texts;
    for (const auto& layer : layers_) std::ranges::move(layer->left_out(), std::back_inserter(texts));
    for (const auto& list : {backdrop(), frame()})
        for (const auto& item : list)
            if (const auto* one = std::get_if<Label>(&item); one && one->text.ends_with("…") && !is_given(one->text))
                texts.push_back(fmt::format("the rest of \"{}\"", one->text));
    if (texts.empty()) return {};
    const auto& size = preset.video.size;
    return fmt::format("{} × {}: there is no space for {}", size.width, size.height, fmt::join(texts, ", "));
}

/// Lines above and below a picture of the pendulums; without it, all lines in the middle.
DisplayList Composer::card(const std::vector<Label>& above, const std::vector<Label>& below, double opacity) const {
    const auto& page = state_.layout.page;
    const float middle = (page.left + page.right) / 2;
    DisplayList list{filled(state_.scene.preset.video.size, page_color())};
    const auto height = [](const std::vector<Label>& lines) {
        float sum = 0;
        for (const auto& line : lines) sum += leading * line.size;
        return sum;
    };
    const auto write = [&](const std::vector<Label>& lines, float y) {
        for (auto line : lines) {
            y += leading * line.size;
            line.anchor = {middle, y - 0.35f * line.size};
            line.size = state_.layout.style.type.fitting_size(line.text, line.size, line.weight, 0.94f * page.width());
            list.emplace_back(std::move(line));
        }
    };
    const float gap = 12 * state_.layout.text;
    const float top = still_ ? still_panel_.area.top - gap - height(above)
                             : (page.top + page.bottom - height(above) - height(below)) / 2;
    write(above, top);
    if (still_) {
        still_->backdrop(list);
        still_->frame(list);
    }
    write(below, still_ ? still_panel_.area.bottom + gap : top + height(above));
    for (auto& item : list) std::visit([&](auto& shape) { shape.color.a *= static_cast<float>(opacity); }, item);
    return list;
}

DisplayList Composer::title_card(double opacity) const {
    const auto& layout = state_.layout;
    const auto& font = layout.style.font;
    const auto& theme = layout.style.theme;
    const auto captions = side_captions(state_.scene, wording_of(state_.scene));
    const auto side = [&](std::size_t k) {
        return card_line(captions[k].heading, 1.3 * font.heading, Weight::bold, theme.sides[k]);
    };
    return card({card_line(state_.scene.preset.title, font.card, Weight::bold, theme.text),
                 card_line(scene_caption(state_.scene, wording_of(state_.scene)), 1.3 * font.subtitle, Weight::regular,
                           theme.quiet_text)},
                state_.scene.is_single() ? std::vector{side(0)} : std::vector{side(0), side(1)}, opacity);
}

std::string Composer::outcome() const {
    if (state_.scene.is_single()) return fmt::format("after {:g} s", state_.scene.time(state_.scene.samples));
    const auto& divergence = state_.outcome.divergence;
    if (!divergence.starts_together()) return "apart from the start";
    if (divergence.since()) return fmt::format("diverged after {:.1f} s", *divergence.since());
    if (state_.outcome.largest_distance >= Divergence::diverged_distance) return "apart at times";
    return fmt::format("together to the end, {:g} s", state_.scene.time(state_.scene.samples));
}

DisplayList Composer::end_card(double opacity) const {
    const auto& layout = state_.layout;
    const auto& font = layout.style.font;
    const auto& theme = layout.style.theme;
    const bool exact = wording_of(state_.scene) == Wording::exact;
    std::vector<Label> below{card_line(outcome(), 1.3 * font.heading, Weight::bold, theme.trace)};
    if (exact && state_.outcome.start_distance > 0)
        below.push_back(card_line(
            fmt::format("state-space distance: {} at the start, at most {}", scientific(state_.outcome.start_distance),
                        scientific(state_.outcome.largest_distance)),
            font.heading, Weight::regular, theme.text));
    if (state_.scene.preset.video.shows("credit"))
        below.push_back(card_line(fmt::format("Doppel {} · {}", version(), state_.scene.preset.name), font.subtitle,
                                  Weight::regular, theme.quiet_text));
    return card({card_line(state_.scene.preset.title, 0.7 * font.card, Weight::bold, theme.text)}, below, opacity);
}

}  // namespace doppel
