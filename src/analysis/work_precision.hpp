#pragma once

#include "analysis/reference.hpp"

#include <functional>
#include <limits>

namespace doppel {

/// A method of another library, to compare with. Doppel links none: a program that does passes them in.
struct ExternalMethod {
    std::string name;    // "GSL rk8pd"
    bool adaptive;       // its setting is a tolerance, not a step in s
    double least, most;  // of its settings
    /// A motion from the release, whose first sample is the end after `seconds`.
    std::function<std::unique_ptr<Motion>(const Pendulum<double>& chain, double seconds, double setting)> make;
};

/// A motion to compute, and what its errors are measured by.
struct WorkProblem {
    std::string name, title;  // "P1", "P1 · 90°/90°, 10 s"
    /// What moves, by the model of its reference: angles or mechanism; one sample interval is the whole duration. The
    /// method does not matter. A chain of point masses has `parts` as well: every model serves it.
    MotionSpec motion;
    bool conserves_energy = true;
    double natural_time = 1;  // s
    double energy_unit = 1;   // J
    double size = 1;          // m

    double duration() const { return motion.sample_interval.value(); }  // s
    bool has_angles() const { return motion.chain.has_value(); }
    /// Whether it is of point masses on massless rods under gravity.
    bool is_plain_chain() const { return motion.model == Model::angles && !motion.physical; }
};

/// A method on a model, or one of another library, which outlives this.
struct Solver {
    Model model = Model::angles;
    std::string method;
    const ExternalMethod* external = nullptr;

    std::string name() const { return external ? "peer:" + external->name : method; }
    /// The method of the published study.
    bool is_study() const { return method == "euler" && model == Model::angles; }
    /// Whether it can compute the problem.
    bool serves(const WorkProblem& problem) const {
        return problem.is_plain_chain() || (!external && model == problem.motion.model);
    }
};

inline constexpr double study_step = 1.0 / 30000;  // s

/// What a run costs.
enum class Cost { time, evaluations };

/// What one setting of a method came to; NaN where a number could not be had. A run has failed that gives up, is no
/// longer finite, or whose energy or rods are out of all proportion (analysis/watched_motion.hpp).
struct StepResult {
    double setting = NAN;  // step, s, or tolerance
    double error = NAN;    // at the end: of the worst angle, rad, or the worst place, of the size
    double energy_error = NAN, length_error = NAN;  // the worst on the way: relative; m
    double cpu_s = NAN;                             // of one run; of repeats the median
    double evaluations = NAN, steps = NAN;
    double spread = 0;  // of the CPU times of repeats: half the range of their middle half, relative

    bool failed() const { return !std::isnan(setting) && !std::isfinite(error); }
    /// Whether it has the study's step, as nearly as whole steps allow.
    bool is_study() const { return std::abs(setting / study_step - 1) < 1e-3; }
    double cost(Cost of) const { return of == Cost::time ? cpu_s : evaluations; }
};

struct StepStudySpec {
    long most_evaluations;  // of a setting
    double least_error;     // at which the study ends
    bool timed = false;
    bool watched = true;  // energies and lengths, in a run of their own; not of external methods
};

/// A solver's settings from coarse to fine: steps by factors of √2, 1/30000 s among them, or tolerances by half
/// decades. The study ends where the errors are at the floor, fall below `least_error`, or another setting would take too
/// many evaluations; never because of the time. The study's step is always among it. A setting that fails has no
/// numbers. CPU times are those of the thread for the whole motion, without setting it up, after a run that warms the
/// caches; short runs are repeated. Throws Error (exit 130) soon after `stop` is set.
std::vector<StepResult> run_step_study(const WorkProblem& problem, const Reference& reference, const Solver& solver,
                                       const StepStudySpec& spec, const std::atomic<bool>& stop);

/// A solver's settings on a problem.
struct StepStudy {
    Solver solver;
    std::vector<StepResult> outcomes;
};

/// The step-size study of several repeats, the first of which has everything.
StepStudy merged(const Solver& solver, const std::vector<std::vector<StepResult>>& repeats);

/// The range of errors shown; what is below `least` is at the floor.
struct ErrorRange {
    double least, most;
};

/// Of step-size studies of one problem the settings that no cheaper one beats, cheapest first, until one is at the
/// floor. A setting whose next finer one errs more than twice as much was lucky and does not count.
std::vector<StepResult> front_of(std::span<const StepStudy> studies, Cost cost, const ErrorRange& range);

/// The step-size study that takes the least for an error of at most `error`: by the cheapest setting that does so, and
/// whose next finer one does, too, for now and then a coarse one is lucky.
struct Cheapest {
    const StepStudy* study = nullptr;  // none does; of equals the first
    double cost = std::numeric_limits<double>::infinity();
};
/// Of step-size studies of one problem, by the solvers that count.
Cheapest cheapest(std::span<const StepStudy> studies, Cost cost, double error,
                  const std::function<bool(const Solver&)>& counts);

/// Of each method on a problem the model that is the cheapest at most powers of ten of the error; of equals the first.
std::vector<const StepStudy*> best_models(std::span<const StepStudy> studies, Cost cost);

/// Names of Doppel's methods, or of the external ones, the best first: by the sum of their ranks on all problems, whose
/// step-size studies these are, at all `errors`. One that does not come so far ranks behind all that do; of equals the
/// first.
std::vector<std::string> ranked(std::span<const std::vector<StepStudy>> problems, Cost cost,
                                std::span<const double> errors, bool external);

/// Median and greatest spread of the CPU times of all useful settings; NaN where there are none.
std::pair<double, double> time_spread(std::span<const std::vector<StepStudy>> problems);

}  // namespace doppel
