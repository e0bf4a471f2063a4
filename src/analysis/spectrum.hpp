#pragma once

#include "physics/physical_pendulum.hpp"

#include <atomic>
#include <vector>

namespace doppel {

struct SpectrumSpec {
    double duration_s = 500;   // of the motion; > 0
    int samples = 500;         // at least one; equally spaced, the last at the end
    double tolerance = 1e-10;  // of dop853, for the state and its tangents
};

/// The estimates of the exponents at a time.
struct SpectrumSample {
    double time_s;
    std::vector<double> exponents;  // 1/s, 2N of them; for large times in descending order
};

/// Estimates of all 2N Lyapunov exponents of a chain of 1 to 4 links, in the canonical variables (θ, p). At any time
/// their sum is 0 without friction; with friction it is the mean rate of change of volume, for viscous friction
/// −tr(C M⁻¹).
/// Errors  exit 2 for more links or Coulomb friction, exit 3 if the method fails, exit 130 soon after `stop` is set.
std::vector<SpectrumSample> lyapunov_spectrum(const PhysicalPendulum<double>& p, const SpectrumSpec& spec,
                                              const std::atomic<bool>& stop);

/// The largest |λ_i + λ_{2N+1−i}|, 1/s. It is 0 for a Hamiltonian system (no friction) in the limit, not at finite
/// time.
double pair_mismatch(const SpectrumSample& sample);

}  // namespace doppel
