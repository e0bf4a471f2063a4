#pragma once

#include "physics/pendulum.hpp"

#include <functional>
#include <memory>
#include <span>
#include <string>

namespace doppel {

/// A method of another library, set up on one problem; all its memory is there.
class ExternalSolver {
public:
    virtual ~ExternalSolver() = default;
    /// From the release to the end; may be called repeatedly. Throws Error (exit 3) where the method gives up.
    virtual void run() = 0;
    virtual std::span<const double> state() const = 0;  // at the end: θ1 … θN, ω1 … ωN
    virtual long evaluations() const = 0;               // of the right-hand side, in the last run
    virtual long steps() const = 0;                     // accepted, in the last run
};

/// A method of another library, to compare with. Doppel links none: a program that does passes them in.
struct ExternalMethod {
    std::string name;    // "GSL rk8pd"
    bool adaptive;       // its setting is a tolerance, not a step in s
    double least, most;  // of its settings
    std::function<std::unique_ptr<ExternalSolver>(const Pendulum<double>& chain, double seconds, double setting)> make;
};

}  // namespace doppel
