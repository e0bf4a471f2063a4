#pragma once

#include "film/composer.hpp"
#include "render/renderer.hpp"

#include <atomic>
#include <optional>
#include <vector>

namespace doppel {

/// Many moments of a film in one picture: pendulums and time alone, in rows, and one title above.
class ContactSheet {
public:
    /// `ticks` in ascending order, one a tile. Throws as Composer and Renderer do.
    ContactSheet(const Scene& scene, std::vector<long> ticks, Gl gl, const std::atomic<bool>& stop);
    ContactSheet(const ContactSheet&) = delete;
    ContactSheet& operator=(const ContactSheet&) = delete;

    /// Every snapshot, in order from sample 0.
    void add(const Snapshot& snapshot);

    /// Of the tiles so far, one at least.
    Picture picture() const;

private:
    const Scene scene_;  // of a tile
    Composer composer_;
    Renderer renderer_;
    std::vector<long> ticks_;
    std::vector<Picture> tiles_;
    int columns_;
    Gl gl_;
    const std::atomic<bool>& stop_;
};

}  // namespace doppel
