#pragma once

#include "film/layer.hpp"

#include <memory>

namespace doppel {

/// The cards before and after a film: words, and a still of the pendulums as they are.
class Cards {
public:
    /// `state` outlives the cards. Without a title or end card in the film there is no still.
    explicit Cards(const FilmState& state);

    /// The next snapshot, in order from sample 0, is that of the state.
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

}  // namespace doppel
