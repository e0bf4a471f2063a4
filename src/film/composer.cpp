#include "film/composer.hpp"

#include "base/embedded.hpp"
#include "film/headings.hpp"
#include "render/font.hpp"
#include "scene/captions.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace doppel {
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

/// The words that stay, and the time.
class WordsLayer final : public Layer {
public:
    using Layer::Layer;

    void backdrop(DisplayList& list) const override {
        list.insert(list.end(), layout_.words.begin(), layout_.words.end());
    }
    void frame(DisplayList& list) const override {
        auto clock = layout_.clock;
        clock.text = clock_text(state_.scene, state_.time());
        list.push_back(clock);
    }
};

/// A line of text on a card.
struct CardLine {
    std::string text;
    double size;  // px
    Weight weight = Weight::regular;
    Color color;
};

/// The lines in the middle of the picture, on the background, all as opaque as the card.
DisplayList card(const std::vector<CardLine>& lines, Size size, Color background, double opacity) {
    const auto alpha = static_cast<float>(opacity);
    constexpr double leading = 1.55;
    double tall = 0;
    for (const auto& line : lines) tall += leading * line.size;
    DisplayList list{filled(size, background.with_alpha(alpha))};
    const auto width = static_cast<float>(size.width), height = static_cast<float>(size.height);
    double y = (height - tall) / 2;
    for (const auto& line : lines) {
        y += leading * line.size;
        const float fits = fitting_size(line.text, px(line.size), line.weight, 0.88f * width);
        list.push_back(label(line.text, {width / 2, static_cast<float>(y - 0.35 * line.size)}, fits,
                             line.color.with_alpha(alpha), Align::center, line.weight));
    }
    return list;
}

}  // namespace

Composer::Composer(const Scene& scene, const std::atomic<bool>& stop) : state_{scene, make_layout(scene, stop)} {
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
    const auto& state = snapshot.pair;
    if (state.sample == 0) state_.start_distance = state.distance;
    state_.largest_distance = std::max(state_.largest_distance, state.distance);
    state_.parting.add(state_.time(), state.distance);
    for (const auto& layer : layers_) layer->add();
}

DisplayList Composer::frame() const {
    DisplayList list;
    for (const auto& layer : layers_) layer->frame(list);
    return list;
}

DisplayList Composer::title_card(double opacity) const {
    const auto& layout = state_.layout;
    const auto& font = layout.style.font;
    const auto& theme = layout.style.theme;
    const auto captions = side_captions(state_.scene, wording_of(state_.scene));
    return card({{layout.title, font.card, Weight::bold, theme.text},
                 {layout.subtitle, 1.5 * font.subtitle, Weight::regular, theme.quiet_text},
                 {"", font.subtitle, Weight::regular, theme.text},
                 {captions[0].heading, 1.3 * font.heading, Weight::bold, theme.sides[0]},
                 {captions[1].heading, 1.3 * font.heading, Weight::bold, theme.sides[1]}},
                state_.scene.preset.video.size, theme.background, opacity);
}

DisplayList Composer::end_card(double opacity) const {
    const auto& layout = state_.layout;
    const auto& font = layout.style.font;
    const auto& theme = layout.style.theme;
    const auto size = 1.3 * font.heading;
    const auto& parting = state_.parting;
    const auto outcome = !parting.start_as_one() ? "apart from the start"
                         : parting.since()       ? fmt::format("parted after {:.1f} s", *parting.since())
                         : state_.largest_distance >= Parting::apart_at
                             ? "apart for moments only"
                             : fmt::format("together to the end, {:g} s", state_.scene.time(state_.scene.samples));
    std::vector<CardLine> lines{{layout.title, 0.7 * font.card, Weight::bold, theme.text},
                                {"", font.subtitle, Weight::regular, theme.text},
                                {outcome, size, Weight::regular, theme.trace}};
    if (state_.start_distance > 0)
        lines.push_back({fmt::format("from a state-space distance of {} to {}", scientific(state_.start_distance),
                                     scientific(state_.largest_distance)),
                         size, Weight::regular, theme.text});
    lines.push_back({"", font.subtitle, Weight::regular, theme.text});
    lines.push_back({fmt::format("Doppel {} · {}", version(), state_.scene.preset.name), font.subtitle, Weight::regular,
                     theme.quiet_text});
    return card(lines, state_.scene.preset.video.size, theme.background, opacity);
}

}  // namespace doppel
