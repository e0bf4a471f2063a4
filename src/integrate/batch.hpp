#pragma once

#include "integrate/motion.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace doppel {

class BatchBlock;

/// Many pendulums of the same number of links, each with its own masses, lengths, gravity and release, integrated side by
/// side in the registers of this processor. Every one ends, to the last bit, as it would alone and at every width.
///
/// One thread steps one batch; several batches may be integrated at once.
class Batch {
public:
    /// In angles or as particles on rods. `width` doubles to a register: one of register_widths(), or 0 for the widest.
    /// Errors  Error (exit 2) where there is no pendulum, they differ in their links, serves() says no, or this processor
    ///         has no such width.
    Batch(std::span<const Pendulum<double>> members, Model model, std::string_view method, double step, int width = 0);
    ~Batch();
    Batch(Batch&&) noexcept;

    void advance(long steps);  // without allocation

    int width() const { return width_; }

    /// The state of a member as its model keeps it: (θ1 … θN, ω1 … ωN) or (x1, y1 … , vx1, vy1 …).
    State<double, Eigen::Dynamic> state(std::size_t member) const {
        State<double, Eigen::Dynamic> y;
        read(member, y);
        return y;
    }
    /// The same into `y`, which keeps its memory.
    void read(std::size_t member, State<double, Eigen::Dynamic>& y) const;

    /// Whether chains of so many links are stepped side by side by that method: two or three by "euler" or "rk4".
    static bool serves(std::string_view method, std::size_t links);

private:
    int width_;
    std::size_t block_;  // members to a block
    std::vector<std::unique_ptr<BatchBlock>> blocks_;
};

}  // namespace doppel
