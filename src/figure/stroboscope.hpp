#pragma once

#include "figure/experiment.hpp"
#include "scene/scene.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace doppel {

/// Samples a driven pendulum at each drive period.
struct StroboscopeSpec {
    int link = 1;  // from 1
    int transient_periods = 200, periods = 100;
};

/// Throws Error (exit 2) at the table's `key` or `link` without exactly one drive frequency of at most 18 digits, or
/// such a link.
void require_drive(const TomlReader& table, std::string_view key, const StroboscopeSpec& spec, const SideSpec& side);

/// Angle, rad in −π…π, and rate, rad/s, of the link of side a at the end of each period except the transient ones. NaN
/// from the failure of the motion on. Throws Error (exit 130) soon after `stop` is set.
TrialNumbers stroboscope(const Scene& scene, const StroboscopeSpec& spec, const std::atomic<bool>& stop);

/// How many motions repeat after one, two or four periods, or have more than 16 distinct rates.
Json period_findings(std::span<const TrialNumbers> motions);

}  // namespace doppel
