#pragma once

#include "figure/experiment.hpp"
#include "integrate/flips.hpp"
#include "scene/preset.hpp"

#include <span>
#include <string>
#include <vector>

namespace doppel {

/// How good the times to the first flip of double pendulums are: random releases, with the energy to flip, are compared
/// with a reference ten thousand times finer.
class FlipChecks {
public:
    /// `count` releases of `pendulum` at angles in these ranges, degrees.
    FlipChecks(int count, const Pendulum<double>& pendulum, const FlipSpec& spec, const Range& theta1,
               const Range& theta2)
        : count_(count), pendulum_(pendulum), spec_(spec), theta1_(theta1), theta2_(theta2) {}

    std::size_t trials() const { return static_cast<std::size_t>((count_ + a_trial - 1) / a_trial); }
    TrialNumbers compute(std::size_t trial, const std::atomic<bool>& stop) const;
    bool fits(std::size_t trial, std::span<const double> numbers) const;

    /// Of the numbers of all these trials; the words follow on the tolerance.
    std::string words(std::span<const TrialNumbers> numbers) const;
    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const;

private:
    static constexpr int a_trial = 10;  // releases
    std::size_t releases(std::size_t trial) const {
        return static_cast<std::size_t>(std::min(a_trial, count_ - static_cast<int>(trial) * a_trial));
    }
    struct Found {
        int flip = 0;         // in the map, by the reference, or both
        int agreeing = 0;     // of these: within 10 ms of the reference
        double median = NAN;  // s, of those that flip in both
    };
    static Found found(std::span<const TrialNumbers> numbers);

    int count_;
    Pendulum<double> pendulum_;
    FlipSpec spec_;
    Range theta1_, theta2_;
};

}  // namespace doppel
