#pragma once

#include "numeric/rational.hpp"
#include "physics/pendulum.hpp"
#include "picture/color.hpp"
#include "picture/picture.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

enum class ModelChoice { automatic, angles, constraints };

/// One side of the pair, as [system] with [a] or [b] on top describes it. Angles stay in degrees, as they were written.
struct SideSpec {
    std::array<double, link_count> mass_kg{1, 1};
    std::array<double, link_count> length_m{1, 1};
    std::array<double, link_count> angle_deg{90, 90};
    std::array<double, link_count> omega_deg_per_s{0, 0};
    double gravity_m_per_s2 = 9.8;
    ModelChoice model = ModelChoice::automatic;
    std::string integrator = "euler";
    Rational step_s{1, 30000};
};

/// An axis from `low` to `high`, both > 0.
struct Range {
    double low, high;
};

struct VideoSpec {
    Size size{1920, 1080};
    std::optional<Rational> fps;  // frames/s; sample_hz · speed where it is not given
    Rational speed{1, 1};         // seconds of motion shown a second
    std::string format = "mp4";   // or "png"
    std::string preset = "veryfast";
    int crf = 18;
    std::string theme = "dark";                             // or "light"
    std::optional<std::array<Color, 2>> side_colors;        // the theme's where not given
    double trail_s = 2.5;                                   // s; 0 = none
    bool pendulums = true, distance = true, energy = true;  // which panels
    std::optional<Range> distance_range, energy_range;      // fitted to the scene where not given
};

/// A scene as a preset file describes it: read, complete and checked, nothing computed yet.
struct Preset {
    std::string name;   // of the file, without folder and ending
    std::string title;  // the name where it is not given
    Rational duration_s{30, 1};
    Rational sample_hz{120, 1};
    SideSpec a, b;
    VideoSpec video;
};

/// A value from the command line that goes on top of a preset: "system.step_s" = "\"1/1000\"", given by `origin`.
struct Override {
    std::string key;     // table.key
    std::string value;   // TOML
    std::string origin;  // what errors name: "--set system.step_s"
};

/// Where a preset's text comes from and what it says.
struct PresetText {
    std::string name;  // "butterfly"
    std::string path;  // "presets/butterfly.toml": what errors name
    std::string text;
};

/// Finds a preset: a path (anything with a slash or ending in .toml), or a name in presets/ here or built into the
/// program. Throws Error (exit 2) that names the nearest preset, or says what is in place of the file.
PresetText find_preset(const std::string& name_or_path);

/// All presets that are built in, by name.
std::vector<PresetText> builtin_presets();

/// Reads and checks; unknown keys, wrong types and lengths, and values out of range are Errors (exit 2) with place,
/// value found and what would be right.
Preset read_preset(const PresetText& source, const std::vector<Override>& overrides = {});

/// The key=value of --set. Throws Error (exit 2) where it is not of that form.
Override parse_set(const std::string& argument);

}  // namespace doppel
