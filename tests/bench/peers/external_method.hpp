#pragma once

#include "integrate/motion.hpp"

#include <functional>
#include <memory>
#include <string>

namespace doppel {

/// A method of another library, for comparison. Doppel itself links none.
struct ExternalMethod {
    std::string name;         // "GSL rk8pd"
    bool adaptive;            // its setting is a tolerance instead of a step size in s
    double minimum, maximum;  // of its settings
    /// A motion from the release. Its first sample is the end after `seconds`.
    std::function<std::unique_ptr<Motion>(const Pendulum<double>& chain, double seconds, double setting)> make;
};

}  // namespace doppel
