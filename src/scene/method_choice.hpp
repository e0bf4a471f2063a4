#pragma once

#include "analysis/exponent.hpp"
#include "analysis/reference.hpp"
#include "scene/scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// A model and a method at a setting that gave an accuracy, and what that cost: read off the table that
/// `doppel figure speed-accuracy` measured (src/scene/costs.csv, made anew by tests/update-costs).
struct MeasuredMethod {
    Model model;
    std::string method;
    double setting;  // tolerance, or step in units of `time_unit`
    double cost;     // CPU s a `time_unit` of motion, on the machine of the table
};

inline constexpr double finest_in_table = 1e-11;  // rad, that is asked of the table

/// The models and methods that may step a side and reached `accuracy` (rad) on the released pendulums of the table most
/// like it, cheapest first; for accuracies finer than the table's, in the order of its finest.
std::vector<MeasuredMethod> measured_methods(const SideSpec& spec, double accuracy);

/// Step settings of a side that asks for an accuracy, by one model and method: tolerances 1 or 3 times a power of ten, or
/// 1, 2, 3, 4, 6, 8, 12 … steps to a sample. Each level is finer than the one before; 0 is the loosest.
class StepSettings {
public:
    /// `time_unit` = √(l/g) or the like, s, in which the table measures steps.
    StepSettings(const SideSpec& spec, const Rational& sample_hz, const MeasuredMethod& measured, double time_unit);

    int start() const { return start_; }    // what the table suggests
    int finest() const { return finest_; }  // that the precision allows; with steps, some sixty times the table's
    const MethodEntry& method() const { return method_; }

    Side side(int level) const;

private:
    SideSpec spec_;
    Rational sample_hz_;
    MethodEntry method_;
    int start_, finest_;
};

/// Chooses model, method and step control of one side for any number of accuracies: the reference that errors are
/// measured by is computed once.
class MethodChooser {
public:
    /// Errors  exit 2 where the system is faulty, exit 130 soon after `stop` is set.
    MethodChooser(const SideSpec& spec, const Rational& duration, const Rational& sample_hz,
                  const std::atomic<bool>& stop);

    /// The side by the model and method that take the least work, of those that the measured table has for this
    /// accuracy or a finer one, at the loosest setting whose error stays below eight tenths of `accuracy` (rad) to the
    /// end; or, where no setting's does, nearly as long as that of the finest. A finer accuracy never takes less work.
    /// Errors  exit 2 where the accuracy would not even hold for one swing, with what is within reach; exit 130.
    Side choose(double accuracy) const;

private:
    SideSpec spec_;
    Rational duration_, sample_hz_;
    const std::atomic<bool>& stop_;
    double time_unit_;  // s
    long samples_;
    ReferenceTrajectory reference_;
};

/// By the accuracy that the side itself asks for.
Side choose_side(const SideSpec& spec, const Rational& duration, const Rational& sample_hz,
                 const std::atomic<bool>& stop);

/// What can be known of a side's motion before it is run. Errors are those of angles, rad, the largest of all; of what
/// hangs in no chain, of places in units of its size.
struct Forecast {
    /// For how long runs of this precision can be right, within half a rad, s. About: no bound.
    struct Limit {
        double from, to;  // of several runs; or what the exponent, and how it varies, makes of their errors at the end
    };

    enum class Kind {
        regular,
        chaotic,
        unstable
    };  // unstable: released at an equilibrium that errors grow from; no chaos

    double error;                      // at `error_s`
    double error_s;                    // the end, or where the run is off by half a rad
    std::optional<Exponent> exponent;  // of a chain that is not too long
    Kind kind = Kind::regular;         // where there is an exponent
    std::optional<Limit> limit;        // may lie beyond the end
};

/// By the run beside the reference (analysis/reference_trajectory.hpp), and runs by Taylor series as fine as the precision
/// allows, each of which rounds in its own way.
/// Errors  exit 130 soon after `stop` is set; exit 3 where the method breaks down at once.
Forecast forecast_of(const Scene& scene, const Side& side, const std::atomic<bool>& stop);

}  // namespace doppel
