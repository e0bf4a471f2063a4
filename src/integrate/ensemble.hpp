#pragma once

#include "integrate/ensemble_kernel.hpp"
#include "numeric/state.hpp"
#include "physics/pendulum.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace doppel {

/// Which equations the trials of an ensemble obey.
enum class EnsembleModel { angles, constraints };

/// Many pendulums of the same number of links, each with its own masses, lengths, gravity and release, stepped side by
/// side in the registers of this processor. Every trial ends, to the last bit, as it would alone and at every width.
///
/// Chains of up to 4 links are stepped in lanes, longer ones one by one. One thread steps one ensemble; several
/// ensembles may be stepped at once.
class Ensemble {
public:
    /// `width` doubles to a register: one of widths(), or 0 for the widest.
    /// Errors  Error (exit 2) where there is no trial, trials differ in their links, the method is none of the explicit
    ///         ones of fixed step, or this processor has no such width.
    Ensemble(std::span<const Pendulum<double>> trials, EnsembleModel model, std::string_view method, double step,
             int width = 0);

    void advance(long steps);  // without allocation

    std::size_t trials() const { return trials_; }
    int width() const { return width_; }  // 1 where the trials are stepped one by one

    /// The state of a trial as its model keeps it: (θ1 … θN, ω1 … ωN) or (x1, y1 … , vx1, vy1 …).
    State<double, Eigen::Dynamic> state(std::size_t trial) const;
    /// The same into `y`, which keeps its memory.
    void read(std::size_t trial, State<double, Eigen::Dynamic>& y) const;

    /// Whether a method steps ensembles: explicit, of fixed step.
    static bool serves(std::string_view method);

    /// The widths that this processor and this build have, narrowest first.
    static std::vector<int> widths();
    /// `asked`, or the widest where it is 0. Throws Error (exit 2) where it is none of widths().
    static int chosen_width(int asked);

private:
    std::size_t trials_, block_;  // trials, and how many to a block
    int width_;
    std::vector<std::unique_ptr<EnsembleBlock>> blocks_;
};

}  // namespace doppel
