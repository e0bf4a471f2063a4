#pragma once

#include "analysis/work_precision.hpp"

#include <vector>

namespace doppel {

// One file each.
std::vector<ExternalMethod> odeint_peers();    // Boost.odeint
std::vector<ExternalMethod> gsl_peers();       // GNU Scientific Library, gsl_odeiv2
std::vector<ExternalMethod> sundials_peers();  // SUNDIALS: CVODE and ARKODE

/// The methods of other libraries that speed and accuracy are compared with, each set up as its documentation
/// recommends: one tolerance, absolute and relative alike, or one step.
inline std::vector<ExternalMethod> all_peers() {
    auto all = odeint_peers();
    for (const auto& more : {gsl_peers(), sundials_peers()}) all.insert(all.end(), more.begin(), more.end());
    return all;
}

}  // namespace doppel
