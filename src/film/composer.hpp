#pragma once

#include "film/layer.hpp"

#include <vector>

namespace doppel {

/// Turns a film's shots into display lists, layer by layer. The list of a shot depends on the scene and on the shots so
/// far, and on nothing else: any frame can be drawn alone.
class Composer {
public:
    /// Throws as make_layout() does.
    explicit Composer(const Scene& scene, const std::atomic<bool>& stop = false);
    Composer(const Composer&) = delete;
    Composer& operator=(const Composer&) = delete;

    /// What never changes: the page, the panels, the axes and their words.
    DisplayList backdrop() const;

    /// The next shot, in order from sample 0.
    void add(const Snapshot& snapshot);

    /// The picture of the shot added last.
    DisplayList frame() const;

    Color page_color() const { return state_.layout.style.theme.background; }

    /// A card over the whole picture, `opacity` 0…1: what the film is about, and what came of it so far.
    DisplayList title_card(double opacity) const;
    DisplayList end_card(double opacity) const;

private:
    FilmState state_;
    std::vector<std::unique_ptr<Layer>> layers_;  // back to front
};

}  // namespace doppel
