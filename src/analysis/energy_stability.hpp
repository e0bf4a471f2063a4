#pragma once

#include "integrate/motion.hpp"
#include "numeric/rational.hpp"

#include <atomic>
#include <span>
#include <string>
#include <vector>

namespace doppel {

/// Energy is compared with what a release has above hanging at rest. An error beyond so many times that is a blow-up.
inline constexpr double blow_up = 100;

/// How pendulums are stepped, and how often their energy is sampled.
struct StabilityRun {
    std::string method;
    Model model = Model::angles;
    Rational duration{10, 1};   // s
    long samples = 100;         // of the energy, evenly over the duration
    long steps_per_sample = 1;  // of methods with a fixed step
    Quad tolerance = 0;         // of adaptive ones
    int width = 0;              // doubles to a register (integrate/batch.hpp); changes no bit

    /// s
    double step() const { return duration.value() / static_cast<double>(samples * steps_per_sample); }
};

/// The energy of a release above hanging at rest, J.
double released_energy(const Pendulum<double>& release);

/// The greatest error of the energy within the run, of the energy released, for each release; not a number for a
/// blow-up, which ends its run: an error beyond `blow_up`, NaN, or a method that gives up.
/// The releases have the same number of links. Throws Error: exit 2 where the method does not serve the model, exit 130
/// soon after `stop` is set.
std::vector<double> greatest_energy_errors(const StabilityRun& run, std::span<const Pendulum<Quad>> releases,
                                           const std::atomic<bool>& stop);

}  // namespace doppel
