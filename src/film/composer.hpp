#pragma once

#include "film/layer.hpp"

#include <memory>
#include <vector>

namespace doppel {

/// The cards before and after a film: words, and a still of the pendulums as they are.
class Cards {
public:
    /// `state` outlives the cards. Without a title or end card in the film there is no still.
    explicit Cards(const FilmState& state);

    /// The next sample, from 0 on, is that of the state.
    void add() {
        if (still_) still_->add();
    }

    /// Over the whole picture, `opacity` 0…1: what the film is about and how the two start; what came of it so far.
    DisplayList title(double opacity) const;
    DisplayList end(double opacity) const;

private:
    struct Line;
    DisplayList card(const std::vector<Line>& above, const std::vector<Line>& below, double opacity) const;
    std::string outcome() const;

    const FilmState& state_;
    PendulumPanel panel_;
    std::unique_ptr<Layer> still_;
};

/// Turns a film's snapshots into display lists, layer by layer. A list depends only on the scene, the samples so far and
/// the snapshot that it shows: any frame can be drawn alone, and is the same at any frames a second.
class Composer {
public:
    /// Throws as make_layout() does.
    explicit Composer(const Scene& scene, const std::atomic<bool>& stop = false, Dress dress = Dress::film);
    Composer(const Composer&) = delete;
    Composer& operator=(const Composer&) = delete;

    /// What never changes: the page, the panels, the axes and their labels.
    DisplayList backdrop() const;

    /// The next snapshot, in order: all samples from 0 on, and any moments between them.
    void add(const Snapshot& snapshot);

    /// The picture of the snapshot added last.
    DisplayList frame() const;

    Color page_color() const { return state_.layout.style.theme.background; }

    /// A card over the whole picture, `opacity` 0…1.
    DisplayList title_card(double opacity) const { return cards_.title(opacity); }
    DisplayList end_card(double opacity) const { return cards_.end(opacity); }

private:
    FilmState state_;
    std::vector<std::unique_ptr<Layer>> layers_;  // back to front
    Cards cards_;
};

}  // namespace doppel
