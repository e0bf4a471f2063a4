#pragma once

#include "physics/pendulum.hpp"

#include <functional>
#include <memory>
#include <span>
#include <string>

namespace doppel {

/// A method of another library, set up on one problem; all its memory is there.
class PeerSolver {
public:
    virtual ~PeerSolver() = default;
    /// From the release to the end; may be called again and again. Throws Error (exit 3) where the method gives up.
    virtual void run() = 0;
    virtual std::span<const double> state() const = 0;  // at the end: θ1 … θN, ω1 … ωN
    virtual long evaluations() const = 0;               // of the right-hand side, in the last run
    virtual long steps() const = 0;                     // accepted, in the last run
};

/// A method of another library, to compare with. Doppel itself has none: a program that links them hands them in.
struct Peer {
    std::string name;    // "GSL rk8pd"
    bool adaptive;       // its setting is a tolerance, not a step in s
    double least, most;  // of its settings, that make sense
    std::function<std::unique_ptr<PeerSolver>(const Pendulum<double>& chain, double seconds, double setting)> make;
};

}  // namespace doppel
