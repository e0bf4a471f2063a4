#pragma once

#include "integrate/motion.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace doppel {

class BatchBlock;

/// Pendulums with the same number of links, each with its own masses, lengths, gravity and release, integrated side by
/// side in SIMD registers. Each result has the same bits as for the pendulum alone, at every width. A batch is used by
/// one thread; several batches may run at once.
class Batch {
public:
    /// With angles, or as particles on rods. `width` doubles per register: one of register_widths(), or 0 for the
    /// widest.
    /// Errors  exit 2 if there is no pendulum, numbers of links differ, supports() is false, or this processor lacks
    ///         the width.
    Batch(std::span<const Pendulum<double>> members, Model model, std::string_view method, double step, int width = 0);
    ~Batch();
    Batch(Batch&&) noexcept;

    void advance(long steps);  // without allocation

    int width() const { return width_; }

    /// The state of a member in its model's coordinates: (θ1 … θN, ω1 … ωN) or (x1, y1 … , vx1, vy1 …).
    State<double, Eigen::Dynamic> state(std::size_t member) const {
        State<double, Eigen::Dynamic> y;
        read(member, y);
        return y;
    }
    /// The same into `y`, whose memory is reused.
    void read(std::size_t member, State<double, Eigen::Dynamic>& y) const;

    /// Whether the method is available for chains with this number of links: two or three, by "euler" or "rk4".
    static bool supports(std::string_view method, std::size_t links);

private:
    int width_;
    std::size_t block_;  // members per block
    std::vector<std::unique_ptr<BatchBlock>> blocks_;
};

}  // namespace doppel
