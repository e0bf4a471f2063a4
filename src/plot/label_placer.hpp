#pragma once

#include "plot/style.hpp"

#include <cstdint>
#include <vector>

namespace doppel {

/// Where in a panel there is ink already: who drew in which small square, and where words stand.
class LabelPlacer {
public:
    explicit LabelPlacer(const Area& area);

    /// Marks the segment as drawn by number `who`.
    void add_line(Point from, Point to, std::size_t who);
    void add_words(const Area& box) { words_.push_back(box); }

    /// How many squares in `box` anyone but `except` has drawn in.
    int ink(const Area& box, std::size_t except = nobody) const;
    /// Within the panel, and no words there.
    bool is_free(const Area& box) const;

    const Area& area() const { return area_; }
    static constexpr std::size_t nobody = 63;

private:
    struct Squares {
        int left, top, right, bottom;
    };
    Squares squares(const Area& box) const;

    Area area_;
    int columns_, rows_;
    std::vector<std::uint64_t> drawn_;  // by square, a bit for each number
    std::vector<Area> words_;
};

}  // namespace doppel
