#pragma once

#include "picture/display_list.hpp"

#include <cstddef>

namespace doppel {

/// The farthest vertex, at most `reach` on, to which one straight segment from `first` passes all vertices between
/// within a hair (1/10 px of place and of either edge, 1/2 px of glow, 1/255 of opacity); widths and glow in px. Simulated paths have many more
/// vertices than bends.
std::size_t straight_until(const std::vector<Stroke::Vertex>& path, std::size_t first, std::size_t reach = 24);

/// Calls draw(from, to) for the straight pieces of the path; for a lone vertex draw(it, it).
template <class Draw>
void for_each_segment(const std::vector<Stroke::Vertex>& path, const Draw& draw) {
    if (path.size() == 1) draw(path[0], path[0]);
    for (std::size_t i = 0; i + 1 < path.size();) {
        const std::size_t next = straight_until(path, i);
        draw(path[i], path[next]);
        i = next;
    }
}

}  // namespace doppel
