#pragma once

#include "analysis/reference.hpp"
#include "scene/scene.hpp"

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

}  // namespace doppel
