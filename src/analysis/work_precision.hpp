#pragma once

#include "analysis/reference.hpp"

#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

/// A motion to compute, and the scales of its errors.
struct WorkProblem {
    std::string name, title;  // "P1", "P1 · 90°/90°, 10 s"
    /// The system, with the model of its reference: angles or mechanism. One sample interval is the whole duration. The
    /// method does not matter. A chain of point masses also has `parts`, so that every model supports it.
    MotionSpec motion;
    bool conserves_energy = true;
    double natural_time = 1;  // s
    double energy_unit = 1;   // J
    double size = 1;          // m

    double duration() const { return motion.sample_interval.value(); }  // s
    bool has_angles() const { return motion.chain.has_value(); }
    /// Whether it consists of point masses on massless rods under gravity.
    bool is_plain_chain() const { return motion.model == Model::angles && !motion.physical; }
};

/// A method with a model.
struct Solver {
    Model model = Model::angles;
    std::string method;

    /// The method of the published study.
    bool is_kao_study() const { return method == "euler" && model == Model::angles; }
    /// Whether it can compute the problem.
    bool supports(const WorkProblem& problem) const {
        return problem.is_plain_chain() || model == problem.motion.model;
    }
};

inline constexpr double kao_step = 1.0 / 30000;  // s

enum class Cost { time, evaluations };

/// The result of one setting of a method; NaN for missing numbers. A run has failed if a step cannot be made, it is not
/// finite, or errors of energy or rods are far too large (analysis/watched_motion.hpp).
struct StepResult {
    double setting = NAN;  // step size, s, or tolerance
    double error = NAN;    // at the end: the largest of all angles, rad, or of all positions, relative to the size
    double energy_error = NAN, length_error = NAN;  // maximum during the run: relative; m
    double cpu_s = NAN;                             // of one run; the median of repeats
    double evaluations = NAN, steps = NAN;
    double spread = 0;  // of the CPU times of repeats: half the interquartile range, relative

    bool failed() const { return !std::isnan(setting) && !std::isfinite(error); }
    /// Whether its step size is that of Kao's study, as nearly as whole steps allow.
    bool is_kao_study() const { return std::abs(setting / kao_step - 1) < 1e-3; }
    double cost(Cost of) const { return of == Cost::time ? cpu_s : evaluations; }
};

struct StepStudySpec {
    long max_evaluations;  // for one setting
    double min_error;      // smaller errors end the study
    bool timed = false;
    bool watched = true;  // errors of energies and lengths are measured in a separate run
};

/// The motion of a problem at the settings of a solver, from coarse to fine: step sizes of 2^(k/2)/30000 s, from the
/// problem's natural time down to `max_steps` in the whole motion, or tolerances of 10^(−k/2) rounded to three digits,
/// from 0.1 to the limit of double, with 0 steps. `adaptive` = whether the setting is a tolerance.
std::vector<MotionSpec> settings_of(const WorkProblem& problem, const Solver& solver, bool adaptive, long max_steps);
/// The step size, s, or the tolerance.
double setting_of(const MotionSpec& motion);

/// Runs the settings until the errors reach the floor or fall below `min_error`, or the next setting would take too
/// many evaluations; the time taken never ends them. A failed setting has no numbers. CPU times are those of the thread
/// for the whole motion, without set-up, after a run that warms the caches; short runs are repeated. `make` returns the
/// motion of a setting; `spec.watched` needs Doppel's. Throws Error (exit 130) soon after `stop` is set.
std::vector<StepResult> run_settings(
    const WorkProblem& problem, const Reference& reference, std::span<const MotionSpec> settings,
    const StepStudySpec& spec, const std::atomic<bool>& stop,
    const std::function<std::unique_ptr<Motion>(const MotionSpec&)>& make = make_motion);
/// The same for all settings of a solver of Doppel, and Kao's step size.
std::vector<StepResult> run_step_study(const WorkProblem& problem, const Reference& reference, const Solver& solver,
                                       const StepStudySpec& spec, const std::atomic<bool>& stop);

/// The settings of a solver on a problem.
struct StepStudy {
    Solver solver;
    std::vector<StepResult> outcomes;
};

/// Merges the repeats of a step-size study; the first repeat has all results.
StepStudy merged(const Solver& solver, const std::vector<std::vector<StepResult>>& repeats);

/// The range of shown errors; errors below `minimum` are at the floor.
struct ErrorRange {
    double minimum, maximum;
};

/// The Pareto front of a problem's step-size studies: settings without a cheaper and more accurate one, cheapest first,
/// until one is at the floor. A setting is left out if the next finer one has more than twice its error: it was
/// accurate by coincidence.
std::vector<StepResult> pareto_front(std::span<const StepStudy> studies, Cost cost, const ErrorRange& range);

/// The step-size study with the least cost for an error of at most `error`. The next finer setting must reach it, too,
/// because a coarse one may be accurate by coincidence.
struct Cheapest {
    const StepStudy* study = nullptr;  // null if none reaches it; among equals the first
    double cost = std::numeric_limits<double>::infinity();
};
/// The cheapest of one problem's step-size studies, or of those by `method` if it is given.
Cheapest cheapest(std::span<const StepStudy> studies, Cost cost, double error, std::string_view method = {});

/// For each method on a problem, the model that is cheapest at most powers of ten of the error; among equals the first.
std::vector<const StepStudy*> best_models(std::span<const StepStudy> studies, Cost cost);

/// Names of the methods, the best first: by the sum of their ranks on all problems, at all `errors`. `problems` are
/// their step-size studies. A method that does not reach an error ranks last for it; among equals the first comes
/// first.
std::vector<std::string> ranked(std::span<const std::vector<StepStudy>> problems, Cost cost,
                                std::span<const double> errors);

/// Median and largest spread of the CPU times of all useful settings; NaN if there are none.
std::pair<double, double> time_spread(std::span<const std::vector<StepStudy>> problems);

}  // namespace doppel
