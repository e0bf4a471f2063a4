#pragma once

#include "film/layer.hpp"

#include <memory>
#include <string>
#include <vector>

namespace doppel {

/// Turns snapshots of a film into display lists, layer by layer. A list depends only on the scene, the earlier samples
/// and the snapshot. So any frame can be drawn alone, and is the same at any frame rate.
class Composer {
public:
    /// `bounds` as for make_layout(). The composer reads the scene as long as it lives.
    Composer(const Scene& scene, const MotionBounds& bounds);
    Composer(const Scene&& scene, const MotionBounds& bounds) = delete;
    Composer(const Composer&) = delete;
    Composer& operator=(const Composer&) = delete;

    /// The constant part: page, panels, axes and their labels. Without a colour of the page, a transparent film has
    /// none, others their own.
    DisplayList backdrop(std::optional<Color> page = {}) const;

    /// Adds the next snapshot in order: all samples from 0 on, and any times between them.
    void add(const Snapshot& snapshot);

    DisplayList frame() const;

    /// "there is no space for …": the texts of the last frame that are left out or cut. Empty if there are
    /// none, and for thumbnails (is_low()), which have few.
    std::string left_out() const;

    Color page_color() const { return state_.layout.style.theme.background; }

    /// A card over the whole picture, `opacity` 0…1: the pendulums between lines of text. They are left out if the film
    /// has no card.
    DisplayList title_card(double opacity) const;
    DisplayList end_card(double opacity) const;

private:
    DisplayList card(const std::vector<Label>& above, const std::vector<Label>& below, double opacity) const;
    std::string outcome() const;

    FilmState state_;
    std::vector<std::unique_ptr<Layer>> layers_;  // in order from back to front
    PendulumPanel still_panel_;
    std::unique_ptr<Layer> still_;  // draws the pendulums on cards
};

}  // namespace doppel
