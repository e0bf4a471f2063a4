#pragma once

#include "figure/work_problem.hpp"

#include <cmath>

namespace doppel {

/// A method on a model, or one of another library.
struct Contender {
    Model model = Model::angles;
    std::string method;
    const Peer* peer = nullptr;

    std::string name() const { return peer ? "peer:" + peer->name : method; }
    bool adaptive() const;
    /// The method of the published study.
    bool is_study() const { return method == "euler" && model == Model::angles; }
    /// Whether it can compute the problem.
    bool serves(const WorkProblem& problem) const { return problem.plain || (model == Model::mechanism && !peer); }
};

inline constexpr double study_step = 1.0 / 30000;  // s

/// What one setting of a method came to; NaN where a number could not be had.
struct Rung {
    double setting;                     // step, s, or tolerance
    double error;                       // WorkProblem::error() at the end
    double energy_error, length_error;  // the worst on the way: relative; m
    double cpu_s;                       // of one run
    double evaluations, steps;

    /// Whether it has the study's step, as nearly as whole steps allow.
    bool is_study() const { return std::abs(setting / study_step - 1) < 1e-3; }
    static constexpr std::size_t numbers = 7;
};

/// What a ladder's trial is to do, and how far down.
struct LadderSpec {
    long most_evaluations;  // of a rung
    double least_error;     // where the next rungs have nothing to add
    bool timed = false;
    bool watched = true;  // energies and lengths, in a run of their own
};

/// A contender's settings from coarse to fine: steps by factors of √2, 1/30000 s among them, or tolerances by half
/// decades. The ladder ends where the errors are at the floor, fall below `least_error`, or another rung would take too
/// many evaluations; never because of the time. What the study did is always among it. A rung that breaks down has no
/// numbers. Throws Error (exit 130) soon after `stop` is set.
std::vector<Rung> climb(const WorkProblem& problem, const Truth& truth, const Contender& contender,
                        const LadderSpec& spec, const std::atomic<bool>& stop);

TrialNumbers flattened(const std::vector<Rung>& rungs);
std::vector<Rung> rungs_of(const TrialNumbers& numbers);
/// Whether they are those of one rung or more.
bool is_ladder(std::span<const double> numbers);

}  // namespace doppel
