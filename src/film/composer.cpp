#include "film/composer.hpp"

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
