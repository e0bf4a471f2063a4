#pragma once

#include "external_method.hpp"

#include <vector>

namespace doppel {

// Each in its own file.
std::vector<ExternalMethod> odeint_peers();    // Boost.odeint
std::vector<ExternalMethod> gsl_peers();       // GNU Scientific Library, gsl_odeiv2
std::vector<ExternalMethod> sundials_peers();  // SUNDIALS: CVODE and ARKODE

/// The methods of other libraries in the comparison of speed and accuracy, each set up as its documentation
/// recommends: one tolerance, both absolute and relative, or one step.
inline std::vector<ExternalMethod> all_peers() {
    auto all = odeint_peers();
    for (const auto& more : {gsl_peers(), sundials_peers()}) all.insert(all.end(), more.begin(), more.end());
    return all;
}

}  // namespace doppel
