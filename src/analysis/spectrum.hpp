#pragma once

#include "physics/physical_pendulum.hpp"

#include <atomic>
#include <vector>

namespace doppel {

struct SpectrumSpec {
    double duration_s = 500;   // of the motion; > 0
    int samples = 500;         // at least one; equally spaced, the last at the end
    double tolerance = 1e-10;  // of dop853, for the state and its tangents alike
};

/// The exponents as estimated up to a time.
struct SpectrumSample {
    double time_s;
    std::vector<double> exponents;  // 1/s, 2N of them; the greatest first as time grows
};

/// Estimates of all 2N Lyapunov exponents of a chain of 1 to 4 links, in the canonical (θ, p). At any time their sum is
/// 0 without friction, and with it the mean of what that does to the volume: of viscous friction −tr(C M⁻¹).
/// Errors  exit 2 where there are more links or joints have Coulomb friction, exit 3 where the method fails, exit
///         130 soon after `stop` is set.
std::vector<SpectrumSample> lyapunov_spectrum(const PhysicalPendulum<double>& p, const SpectrumSpec& spec,
                                              const std::atomic<bool>& stop);

/// The greatest |λ_i + λ_{2N+1−i}|, 1/s: what the pairs of a Hamiltonian system, one without friction, lack at a finite
/// time.
double pair_mismatch(const SpectrumSample& sample);

}  // namespace doppel
