#pragma once

#include "analysis/reference.hpp"
#include "scene/scene.hpp"

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace doppel {

/// The methods that may step a motion whose side requires an accuracy; of several, runs find the one that takes the least work.
std::span<const std::string_view> methods_for(const MotionSpec& motion);

/// About what a run of so many samples has taken of CPU time, in evaluations of the right-hand side of a mechanism of as
/// many masses.
double work_of(const MotionSpec& motion, const Effort& effort, long samples);

/// The settings of a method in levels, each finer than the one before, 0 the loosest: tolerances of 1 or 3 times a power of
/// ten, or 1, 2, 3, 4, 6, 8, 12 … steps a sample.
struct StepLevels {
    std::string_view method;
    int start, finest;  // where a search begins; what the precision allows, or of steps 64 times as many as at `start`

    /// `time_unit` = √(l/g) or the like, s. Throws Error (exit 2) where the steps would be too many to count.
    StepLevels(std::string_view method_name, const SideSpec& spec, const Rational& sample_hz, double time_unit);

    Side side(SideSpec spec, const Rational& sample_hz, int level) const;
};

/// Chooses method and step control of the sides that require an accuracy. Sides that differ in no more than what moves
/// have one choice. The references that errors are measured by, and the runs beside them, are computed once, for any
/// number of choices.
class MethodChooser {
public:
    /// Errors  exit 2 where a system is faulty, exit 130 soon after `stop` is set.
    MethodChooser(const Preset& preset, const std::atomic<bool>& stop);

    /// The sides that require an accuracy, for `factor` times theirs: by the method that takes the least work, at the loosest
    /// setting whose error stays below eight tenths of it (rad) to the end; or, where no setting's does, nearly as long as
    /// that of the finest. A finer accuracy never takes less work.
    /// Errors  exit 2 where the accuracy would not even hold for one swing, with what is within reach; exit 130.
    std::array<std::optional<Side>, 2> choose(double factor, const std::atomic<bool>& stop);

private:
    /// A side that requires an accuracy, or both that are the same.
    struct Asking {
        std::string names;  // "a", "b", "ab"
        SideSpec spec;
        double accuracy;     // rad
        long swing_samples;  // of one swing, or of the whole run
        std::shared_ptr<const ReferenceTrajectory> reference;
        std::map<std::pair<std::string_view, int>, ErrorHistory> tried;  // by method and level
    };
    /// Those that have one choice.
    struct Group {
        std::vector<Asking> sides;
        std::vector<StepLevels> methods;
    };

    Asking asking(char name, const SideSpec& spec, std::vector<StepLevels>& methods,
                  const std::atomic<bool>& stop) const;
    const ErrorHistory& tried(Asking& side, const StepLevels& method, int level, const std::atomic<bool>& stop) const;
    double work(Asking& side, const StepLevels& method, int level, const std::atomic<bool>& stop) const;
    Error out_of_reach(double accuracy, const ErrorHistory& history, long horizon, const Asking& side) const;

    Preset preset_;
    long samples_;
    std::vector<Group> groups_;
};

/// In place of a choice for each pair of a sweep: steps the sides that require an accuracy by one method as exactly as the
/// precision allows, which takes less time than to find out how exact a pair must be.
/// Errors  exit 2 where the `first` pair of the sweep cannot keep its accuracy for one swing, exit 130 soon after `stop` is set.
void step_all_alike(Preset& pair, const Preset& first, const std::atomic<bool>& stop);

}  // namespace doppel
