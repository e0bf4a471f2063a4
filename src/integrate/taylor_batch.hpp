#pragma once

#include "integrate/motion.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace doppel {

class TaylorLanes;

/// Many pendulums of two or three links in angles, by the Taylor method (integrate/taylor.hpp) in the registers of this
/// processor, each with masses, lengths, gravity, a release and steps of its own. Every one is the same to the bit at
/// every width and in any company; by the order of its sums a pendulum on its own rounds differently.
class TaylorBatch {
public:
    /// At sample 0 of those `interval` seconds apart. `width` as in Batch.
    /// Errors  Error (exit 2) where there is no pendulum, they differ in their links or have other than two or three, or
    ///         the tolerance is below `least_tolerance`.
    TaylorBatch(std::span<const Pendulum<double>> members, double tolerance, double interval, int width = 0);
    ~TaylorBatch();
    TaylorBatch(TaylorBatch&&) noexcept;

    static constexpr double least_tolerance = 1e-15;

    void advance();  // to the next sample

    /// (θ1 … θN, ω1 … ωN) of a member there, into `y`, which keeps its memory; NaN where the motion broke down.
    void read(std::size_t member, State<double, Eigen::Dynamic>& y) const;

    static bool serves(Model model, std::size_t links) { return model == Model::angles && (links == 2 || links == 3); }

private:
    static constexpr long window = 128;  // samples that are computed at once

    void compute();

    std::size_t members_, numbers_;  // numbers of a state
    long first_ = 0, sample_ = 0;    // of the window, and where this is
    std::vector<double> states_;     // of the window, sample by sample
    std::unique_ptr<TaylorLanes> lanes_;
};

}  // namespace doppel
