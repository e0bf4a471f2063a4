#include "figure/stroboscope.hpp"

#include "scene/toml_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace doppel {
namespace {

/// The number of distinct rates: those more than 1e-4 rad/s from the next.
std::size_t distinct_rates(const TrialNumbers& motion) {
    constexpr double min_difference = 1e-4;
    std::vector<double> rates;
    for (std::size_t n = 1; n < motion.size(); n += 2)
        if (std::isfinite(motion[n])) rates.push_back(motion[n]);
    std::ranges::sort(rates);
    std::size_t count = rates.empty() ? 0 : 1;
    for (std::size_t i = 1; i < rates.size(); ++i) count += rates[i] - rates[i - 1] > min_difference;
    return count;
}

/// The drive frequency of a side, Hz; nothing without a drive, or with several frequencies.
std::optional<Rational> drive_of(const SideSpec& side) {
    std::vector<Quad> all;
    if (side.physical.pivot.amplitude_m != 0) all.push_back(side.physical.pivot.frequency_hz);
    for (const auto& torque : side.physical.torques) all.push_back(torque.frequency_hz);
    if (all.empty() || std::ranges::any_of(all, [&](const Quad& f) { return f != all[0]; })) return {};
    const auto frequency = parse_rational(text_of(all[0]));
    return frequency && frequency->numerator > 0 ? frequency : std::nullopt;
}

}  // namespace

void require_drive(const TomlReader& table, std::string_view key, const StroboscopeSpec& spec, const SideSpec& side) {
    if (static_cast<std::size_t>(spec.link) > side.links())
        throw table.error("link", "must be 1 to {}, the number of links; it is {}", side.links(), spec.link);
    if (!drive_of(side))
        throw table.error(
            key,
            "\"stroboscopic\" is of a pendulum that is driven, [system.pivot] or [[system.torque]], at one "
            "frequency of at most 18 digits");
}

TrialNumbers stroboscope(const Scene& scene, const StroboscopeSpec& spec, const std::atomic<bool>& stop) {
    auto motion_spec = scene.a.motion;
    motion_spec.sample_interval = *quotient({1, 1}, *drive_of(scene.preset.a));
    if (!scene.a.method.adaptive)  // steps that fit the drive period
        motion_spec.steps_per_sample =
            std::max(1L, std::lround(motion_spec.sample_interval.value() / scene.a.step.value()));
    TrialNumbers numbers;
    try {
        const auto motion = make_motion(motion_spec);
        for (int n = 0; n < spec.transient_periods; ++n) motion->advance(stop);
        for (int n = 0; n < spec.periods; ++n) {
            motion->advance(stop);
            const auto bob = motion->observe().bobs[static_cast<std::size_t>(spec.link - 1)];
            numbers.push_back(std::remainder(bob.theta, 2 * pi));
            numbers.push_back(bob.omega);
        }
    } catch (const Error& error) {
        if (error.code() != ExitCode::method_failed) throw;
    }
    numbers.resize(2 * static_cast<std::size_t>(spec.periods), NAN);
    return numbers;
}

Json period_findings(std::span<const TrialNumbers> motions) {
    constexpr std::size_t many = 17;
    std::array<double, many + 1> with{};  // numbers of motions with so many distinct rates
    for (const auto& motion : motions) with[std::min(distinct_rates(motion), many)] += 1;
    return {{"values_of_one_period", with[1]},
            {"values_of_two_periods", with[2]},
            {"values_of_four_periods", with[4]},
            {"values_of_more_than_16", with[many]}};
}

}  // namespace doppel
