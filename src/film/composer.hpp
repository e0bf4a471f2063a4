#pragma once

#include "film/layer.hpp"

#include <memory>
#include <vector>

namespace doppel {

/// Turns a film's snapshots into display lists, layer by layer. A list depends only on the scene, the samples so far and
/// the snapshot that it shows: any frame can be drawn alone, and is the same at any frames a second.
class Composer {
public:
    /// `bounds` as make_layout() takes them.
    Composer(const Scene& scene, const MotionBounds& bounds, PictureKind dress = PictureKind::film);
    Composer(const Composer&) = delete;
    Composer& operator=(const Composer&) = delete;

    /// What never changes: the page, the panels, the axes and their labels.
    DisplayList backdrop() const;

    /// The next snapshot, in order: all samples from 0 on, and any moments between them.
    void add(const Snapshot& snapshot);

    /// The picture of the snapshot added last.
    DisplayList frame() const;

    Color page_color() const { return state_.layout.style.theme.background; }

    /// A card over the whole picture, `opacity` 0…1: a still of the pendulums as they are between words: what the film is
    /// about and how the two start; what came of it so far. Without a title or end card in the film there is no still.
    DisplayList title_card(double opacity) const;
    DisplayList end_card(double opacity) const;

private:
    DisplayList card(const std::vector<Label>& above, const std::vector<Label>& below, double opacity) const;
    std::string outcome() const;

    FilmState state_;
    std::vector<std::unique_ptr<Layer>> layers_;  // back to front
    PendulumPanel still_panel_;
    std::unique_ptr<Layer> still_;  // of cards
};

}  // namespace doppel
