#include "film/composer.hpp"

#include "film/headings.hpp"

#include <algorithm>
#include <string>
#include <utility>

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
    const auto& state = snapshot.pair;
    if (state.tick == 0) state_.start_distance = state.distance;
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
