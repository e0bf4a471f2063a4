#pragma once

#include "figure/work_ladder.hpp"

namespace doppel {

/// How finely a run goes.
struct Setting {
    double value;  // step, s, or tolerance
    long steps;    // of a fixed step; 0 for a tolerance
    Quad tolerance;
};

// One setting of a method, computed and, where asked for, timed: CPU time of the thread for the whole motion, without
// what it takes to set it up, after a run that warms what it needs. A run that is over at once is measured many times
// in a row.

/// Throws Error (exit 130) soon after `stop` is set.
Rung motion_rung(const WorkProblem& problem, const Truth& truth, const Contender& contender, const Setting& setting,
                 const LadderSpec& spec, const std::atomic<bool>& stop);

Rung peer_rung(const WorkProblem& problem, const Truth& truth, const Peer& peer, const Setting& setting,
               const LadderSpec& spec);

}  // namespace doppel
