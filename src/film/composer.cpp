#include "film/composer.hpp"

#include "base/embedded.hpp"
#include "film/layout.hpp"
#include "render/typeface.hpp"
#include "scene/captions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>

namespace doppel {

/// A line of text on a card.
struct Cards::Line {
    std::string text;
    double size;  // px
    Weight weight = Weight::regular;
    Color color;
};

namespace {

constexpr float leading = 1.55f;  // of a line's size

// px of a 1920×1080 picture: what all lines of a card but the still take
constexpr float card_words = 400;

/// All as opaque as the card.
DisplayList faded(DisplayList list, float alpha) {
    for (auto& item : list) std::visit([&](auto& shape) { shape.color.a *= alpha; }, item);
    return list;
}

/// A film's panel once more, in the middle of the card; smaller where the words need its room.
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
    panel.sides = {0, 1};
    return panel;
}

}  // namespace

Cards::Cards(const FilmState& state) : state_(state) {
    const auto& video = state.scene.preset.video;
    const bool wanted = video.title_card_s.value() > 0 || video.end_card_s.value() > 0;
    if (!wanted || state.layout.panels.empty()) return;
    panel_ = still_panel(state.layout);
    still_ = make_pendulum_layer(state, panel_);
}

/// Lines above the still, and below it; without one all in the middle.
DisplayList Cards::card(const std::vector<Line>& above, const std::vector<Line>& below, double opacity) const {
    const auto& page = state_.layout.page;
    const float middle = (page.left + page.right) / 2;
    DisplayList list{filled(state_.scene.preset.video.size, state_.layout.style.theme.background)};
    const auto height = [](const std::vector<Line>& lines) {
        float sum = 0;
        for (const auto& line : lines) sum += leading * px(line.size);
        return sum;
    };
    const auto write = [&](const std::vector<Line>& lines, float y) {
        for (const auto& line : lines) {
            y += leading * px(line.size);
            const float fits =
                state_.layout.style.type.fitting_size(line.text, px(line.size), line.weight, 0.94f * page.width());
            list.push_back(
                label(line.text, {middle, y - 0.35f * px(line.size)}, fits, line.color, Align::center, line.weight));
        }
    };
    const float gap = 12 * state_.layout.text;
    if (still_) {
        write(above, panel_.area.top - gap - height(above));
        still_->backdrop(list);
        still_->frame(list);
        write(below, panel_.area.bottom + gap);
    } else {
        const float top = (page.top + page.bottom - height(above) - height(below)) / 2;
        write(above, top);
        write(below, top + height(above));
    }
    return faded(std::move(list), static_cast<float>(opacity));
}

DisplayList Cards::title(double opacity) const {
    const auto& layout = state_.layout;
    const auto& font = layout.style.font;
    const auto& theme = layout.style.theme;
    const auto captions = side_captions(state_.scene, wording_of(state_.scene));
    return card({{state_.scene.preset.title, font.card, Weight::bold, theme.text},
                 {scene_caption(state_.scene, wording_of(state_.scene)), 1.3 * font.subtitle, Weight::regular,
                  theme.quiet_text}},
                {{captions[0].heading, 1.3 * font.heading, Weight::bold, theme.sides[0]},
                 {captions[1].heading, 1.3 * font.heading, Weight::bold, theme.sides[1]}},
                opacity);
}

std::string Cards::outcome() const {
    const auto& parting = state_.parting;
    if (!parting.start_as_one()) return "apart from the start";
    if (parting.since()) return fmt::format("parted after {:.1f} s", *parting.since());
    if (state_.largest_distance >= Parting::apart_at) return "apart for moments only";
    return fmt::format("together to the end, {:g} s", state_.scene.time(state_.scene.samples));
}

DisplayList Cards::end(double opacity) const {
    const auto& layout = state_.layout;
    const auto& font = layout.style.font;
    const auto& theme = layout.style.theme;
    const bool exact = wording_of(state_.scene) == Wording::exact;
    std::vector<Line> below{{outcome(), 1.3 * font.heading, Weight::bold, theme.trace}};
    if (exact && state_.start_distance > 0)
        below.push_back({fmt::format("from a state-space distance of {} to {}", scientific(state_.start_distance),
                                     scientific(state_.largest_distance)),
                         font.heading, Weight::regular, theme.text});
    if (state_.scene.preset.video.shows("credit"))
        below.push_back({fmt::format("Doppel {} · {}", version(), state_.scene.preset.name), font.subtitle,
                         Weight::regular, theme.quiet_text});
    return card({{state_.scene.preset.title, 0.7 * font.card, Weight::bold, theme.text}}, below, opacity);
}

namespace {

class PageLayer final : public Layer {
public:
    using Layer::Layer;

    void backdrop(DisplayList& list) const override {
        if (const auto& video = state_.scene.preset.video; !video.transparent)
            list.push_back(filled(video.size, theme_.background));
    }
    void frame(DisplayList&) const override {}
};

Label with_text(Label label, std::string text) {
    label.text = std::move(text);
    return label;
}

/// The words that stay, the time, and the speed where it changes.
class WordsLayer final : public Layer {
public:
    using Layer::Layer;

    void backdrop(DisplayList& list) const override {
        list.insert(list.end(), layout_.words.begin(), layout_.words.end());
    }
    void frame(DisplayList& list) const override {
        const double time = state_.time();
        if (layout_.clock) list.push_back(with_text(*layout_.clock, clock_text(state_.scene, time)));
        if (layout_.speed) list.push_back(with_text(*layout_.speed, speed_text(state_.scene, time)));
    }
};

}  // namespace

Composer::Composer(const Scene& scene, const std::atomic<bool>& stop, Dress dress)
    : state_{scene, make_layout(scene, stop, dress)}, cards_(state_) {
    const auto& layout = state_.layout;
    layers_.push_back(std::make_unique<PageLayer>(state_));
    for (const auto& panel : layout.panels) layers_.push_back(make_pendulum_layer(state_, panel));
    if (layout.phase) layers_.push_back(make_phase_layer(state_, *layout.phase));
    for (std::size_t i = 0; i < layout.strips.size(); ++i) layers_.push_back(make_strip_layer(state_, i));
    layers_.push_back(std::make_unique<WordsLayer>(state_));
}

DisplayList Composer::backdrop() const {
    DisplayList list;
    for (const auto& layer : layers_) layer->backdrop(list);
    return list;
}

void Composer::add(const Snapshot& snapshot) {
    state_.snapshot = snapshot;
    if (state_.is_between()) return;
    const auto& state = snapshot.pair;
    if (state.sample == 0) state_.start_distance = state.distance;
    state_.largest_distance = std::max(state_.largest_distance, state.distance);
    state_.parting.add(state_.time(), state.distance);
    for (const auto& layer : layers_) layer->add();
    cards_.add();
}

DisplayList Composer::frame() const {
    DisplayList list;
    for (const auto& layer : layers_) layer->frame(list);
    return list;
}

}  // namespace doppel
