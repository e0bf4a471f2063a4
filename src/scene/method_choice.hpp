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

/// The candidate methods for a motion whose side requires an accuracy; trial runs find the one with the least work.
std::span<const std::string_view> methods_for(const MotionSpec& motion);

/// Approximate CPU time of a run, in evaluations of the right-hand side of a mechanism with as many masses.
double work_of(const MotionSpec& motion, const Effort& effort, long samples);

/// The settings of a method as levels from 0, the loosest, to finer ones: tolerances of 1 or 3 times a power of ten, or
/// 1, 2, 3, 4, 6, 8, 12 … steps per sample.
struct StepLevels {
    std::string_view method;
    int start,
        finest;  // first level to try; finest level: the limit of the precision, or 64 times the steps of `start`

    /// `time_unit` = √(l/g) or similar, s. Throws Error (exit 2) if there would be too many steps.
    StepLevels(std::string_view method_name, const SideSpec& spec, const Rational& sample_hz, double time_unit);

    Side side(SideSpec spec, const Rational& sample_hz, int level) const;
};

/// Chooses method and step control for the sides that require an accuracy. Sides that only differ in the system get the
/// same choice. The reference trajectories and trial runs are computed once, for any number of choices.
class MethodChooser {
public:
    /// Throws Error: exit 2 if a system is invalid, exit 130 soon after `stop` is set.
    MethodChooser(const Preset& preset, const std::atomic<bool>& stop);

    /// The sides that require an accuracy, for `factor` times this accuracy. The method is the one with the least work,
    /// at the loosest setting whose error stays below 0.8 times the accuracy (rad) to the end. If no setting achieves
    /// this, it must hold nearly as long as with the finest setting. A finer accuracy never gets less work. Throws
    /// Error: exit 2 if the accuracy cannot even be kept for one swing, with the accuracy that can; exit 130.
    std::array<std::optional<Side>, 2> choose(double factor, const std::atomic<bool>& stop);

private:
    /// A side that requires an accuracy, or both sides if they are equal.
    struct SideRequirement {
        std::string names;  // "a", "b", "ab"
        SideSpec spec;
        double accuracy;     // rad
        long swing_samples;  // samples of one swing, or of the whole run
        std::shared_ptr<const ReferenceTrajectory> reference;
        std::map<std::pair<std::string_view, int>, ErrorHistory> tried;  // for each method and level
    };
    /// Sides with a common choice.
    struct Group {
        std::vector<SideRequirement> sides;
        std::vector<StepLevels> methods;
    };

    SideRequirement requirement(char name, const SideSpec& spec, std::vector<StepLevels>& methods,
                                const std::atomic<bool>& stop) const;
    const ErrorHistory& tried(SideRequirement& side, const StepLevels& method, int level,
                              const std::atomic<bool>& stop) const;
    double work(SideRequirement& side, const StepLevels& method, int level, const std::atomic<bool>& stop) const;
    Error out_of_reach(double accuracy, long horizon, SideRequirement& side, const std::vector<StepLevels>& methods,
                       const std::atomic<bool>& stop) const;

    Preset preset_;
    long samples_;
    std::vector<Group> groups_;
};

/// Instead of choosing for each pair of a sweep, integrates the sides that require an accuracy by one method, as
/// accurately as the precision allows. This takes less time than finding the setting for each pair. Throws Error: exit
/// 2 if the `first` pair of the sweep cannot keep its accuracy for one swing, exit 130 soon after `stop` is set.
void use_common_method(Preset& pair, const Preset& first, const std::atomic<bool>& stop);

}  // namespace doppel
