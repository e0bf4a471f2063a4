#include "cli/options.hpp"
#include "fit/start.hpp"
#include "scene/resolved.hpp"

#include <algorithm>
#include <array>
#include <numbers>

namespace doppel {
namespace {

/// How the other pendulum is integrated while its start is fitted: with the preset's method, or by Taylor series if the
/// preset requires an accuracy.
MotionSpec simulated_motion(SideSpec side, const Rational& sample_hz) {
    if (side.accuracy) {
        side.accuracy.reset();
        side.integrator = "taylor";
        side.tolerance = parse_quad("1e-9");
    }
    return make_side(side, sample_hz).motion;
}

std::string degrees_list(const std::array<double, 2>& radians) {
    constexpr double degree = std::numbers::pi / 180;
    return fmt::format("[{:.9g}, {:.9g}]", radians[0] / degree, radians[1] / degree);
}

std::string start_words(const FittedStart& start) {
    if (start.seconds == 0) return "starts as the first samples do";
    return fmt::format("start fitted to {:.2g} s, within {:.2g} mrad", start.seconds, 1000 * start.rms);
}

}  // namespace

std::vector<Override> beside_overrides(const PresetText& text, const std::vector<Override>& given,
                                       const std::string& track, const std::atomic<bool>& stop) {
    auto all = given;
    const auto is_given = [&](std::string_view key) {
        return std::any_of(given.begin(), given.end(), [&](const Override& one) { return one.key == key; });
    };
    const auto add = [&](const char* key, const std::string& value) {
        if (!is_given(key)) all.push_back({key, value, fmt::format("--beside {} ({})", track, key)});
    };
    add("a.track.file", toml_text(track));
    const auto preset = read_preset(text, all);
    const auto replay = replay_of(preset.a.track);
    if (preset.duration_s.value() > replay.length())
        add("scene.duration_s", toml_ratio(longest_duration(replay, preset.sample_hz)));
    if (is_given("b.angle_deg") || is_given("b.omega_deg_per_s")) return all;
    const auto start = fit_start(simulated_motion(preset.b, preset.sample_hz), replay, stop);
    add("a.track.offset_deg", degrees_list(start.offset));
    add("b.angle_deg", degrees_list(start.angle));
    add("b.omega_deg_per_s", degrees_list(start.rate));
    if (!preset.b.note) add("b.note", toml_text(start_words(start)));
    return all;
}

}  // namespace doppel
