#pragma once

#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

/// A figure with an error, and what its message contains.
struct RefusedFigure {
    std::string text;
    std::vector<std::string> words;  // the first with the path before it
};

inline void PrintTo(const RefusedFigure& c, std::ostream* out) {
    *out << c.text;
}

/// For the tests of the reader and of the schema: "kind: text from line 3 on => place … words …", where "/" is a line
/// break in the text; some go on in the next line.
inline constexpr std::string_view refused_list = R"(
grid: [grid.x] / step = 0 => :4:1: [grid.x] step … must be > 0; it is 0
grid: [b] / links = 3 => :4:1: [b] links … must be that of the other side … they are 2 and 3
grid: [b] / label = "x" => :4:1: [b] has no "label"
grid: [grid.x] / step = -0.5 => :4:1: [grid.x] step … must be > 0; it is -0.5
grid: [grid.x] / from = 10 / to = 5 => :5:1: [grid.x] to … it is 5
grid: [grid.x] / to = 1e12 => :4:1: [grid.x] to … it is 1000000000000
grid: [grid.x] / key = "theta1" => :4:1: [grid.x] key … theta1_deg … it is "theta1"
grid: [grid.x] / frm = 1 => :4:1: [grid.x] has no "frm" … did you mean "from"?
grid: [grid.x] / from = "1" => :4:1: [grid.x] from … must be a number; it is a string ("1")
grid: [grid.x] / from = nan => :4:1: [grid.x] from … must be finite; it is nan
grid: [grid.x] / to = inf => :4:1: [grid.x] to … must be finite; it is inf
grid: [grid] / right = 1 => :4:1: [grid] right … must be a string
grid: [grid] / right = "exponent" / exponent_duration_s = -5 => :5:1: [grid] exponent_duration_s … must be > 0
grid: [system] / links = 1 / [grid.x] / key = "mass_ratio" => :6:1: [grid.x] key … 2 links
grid: [system] / lenght_m = 3 => :4:1: [system] has no "lenght_m" … did you mean "length_m"?
grid: [series] / quantity = "distance" => :3:2: a preset has no "series"
grid: [video] / fps = 60 => :3:2: a preset has no "video"
grid: sample_hz = 7 => :3:1: [scene] sample_hz … must divide the step rate
grid: [grid.x] / key = "mass_ratio" / from = 0 / to = 1 => :5:1: [grid.x] from … > 0
grid: [grid.x] / key = "length_ratio" / from = -1 / to = 1 => :5:1: [grid.x] from … > 0
grid: [grid.x] / to = 1 / step = 0.4 => : … [grid.x] … step
series: [[curve]] / column = "x" / [[curve]] / column = "x" => :6:1: [[curve]] 2 column … "x"
series: [[curve]] / column = "time_s" => :4:1: [[curve]] 1 column … "time_s"
grid: [[system.force]] / kind = "spring" / from = "bob1" / to = [1, 0] / [grid] / difference = 1
    / right = "exponent" => :9:1: [grid] right
section: [system] / angle_deg = [3, 3] => :4:1: [system] … angle_deg
grid: [chart] / size = [0, 3] => :4:1: [chart] size[0] … it is 0
grid: [chart] / scale = 9 => :4:1: [chart] scale … at most 8; it is 9
grid: [chart] / scale = 0 => :4:1: [chart] scale … must be > 0; it is 0
grid: [chart] / theme = "blue" => :4:1: [chart] theme … "dark", "light" or "high-contrast"; it is "blue"
grid: [chart] / fps = 3 => :4:1: [chart] has no "fps"
series: [series] / quantity = "dist" => :4:1: [series] quantity … "exponents" or "errors"
series: [[curve]] / label = "x" => :3:1: [[curve]] 1 column is missing
series: [[curve]] / column = "x" / colour = 3 => :5:1: [[curve]] 1 has no "colour"
series: [[curve]] / column = "x" / system.angle = [3, 3] => :5:8: … has no "angle"
series: [series] / check_tolerance = 1e-9 => :4:1: [series] check_tolerance … adaptive methods
series: [curve] / column = "x" => :3:2: curve … [[curve]]
grid: [chart] / scale = 0.001 => :4:1: [chart] scale … 16 to 16384 px a side; 0.001 times 1600×900 px
grid: [chart] / scale = 8 / size = [4000, 900] => :4:1: [chart] scale … is 32000×7200
grid: [grid.x] / from = 2e6 / to = 2e6 => :4:1: [grid.x] from … from -1000000 to 1000000 … theta1_deg
grid: [grid] / difference = -1e300 => :4:1: [grid] difference … from -1000000 to 1000000
series: [series] / quantity = "errors" / methods = ["rk4", "rk4"] => :5:1: [series] methods
    … must differ; rk4 is there twice
series: [series] / quantity = "errors" / projected = ["rk4", "rk4"] => :5:1: [series] projected … must differ
work-precision: [work_precision] / methods = ["rk4", "rk4"] => :4:1: [work_precision] methods … must differ
series: [series] / quantity = "exponents" / [system] / integrator = "rk4" => :6:1: [system] has no "integrator"
series: [series] / quantity = "exponents" / [system] / model = "angles" => :6:1: [system] has no "model"
series: [series] / quantity = "exponents" / [system] / links = 5 => : … 1 to 4 links; there are 5
series: [series] / quantity = "exponents" / samples = 1 => :5:1: [series] samples … it is 1
series: [series] / quantity = "exponents" / duration_s = 0 => :5:1: [series] duration_s … must be > 0
series: duration_s = 3 / [series] / quantity = "exponents" => :3:1: [scene] has no "duration_s"
series: [series] / quantity = "exponents" / [a] / links = 2 => :5:2: a preset has no "a"
section: [section] / energy_J = [] => :4:1: [section] energy_J … 1 to 6 numbers
section: [section] / energy_J = [1, -1] => :4:1: [section] energy_J[1] … must be > 0; it is -1
section: [section] / energy_J = [1, 2, 3, 4, 5, 6, 7] => :4:1: [section] energy_J … 1 to 6 numbers
section: [system] / links = 3 => : … two links; there are 3
section: [system] / precision = "quad" => :4:1: [system] has no "precision"
grid: [grid] / overlay = "energy-bound" => :4:1: [grid] overlay … two ideal links released at rest
grid: [system] / links = 1 / angle_deg = 170 / joint_viscous_N_m_s = 2 / [grid] / quantity = "deviation"
    / overlay = "mathieu" / [grid.x] / key = "system.pivot.frequency_hz" / from = 1 / points = 2 / [grid.y]
    / key = "system.pivot.amplitude_m" / from = 0 / to = 1 / points = 2 => :9:1: [grid] overlay
    … one link without friction and torque
grid: [grid.x] / points = 1 => :4:1: [grid.x] points … from 2 to 1048576; it is 1
grid: [grid] / flip_tolerance = 1e-9 => :4:1: [grid] flip_tolerance … is only for flip_time
grid: [grid] / quantity = "flip_time" / flip_tolerance = 2
    => :5:1: [grid] flip_tolerance … must be from 1e-15 to 1 rad/s; it is 2
grid: [grid.x] / key = "system.mass_kg[3]" => :4:1: [grid.x] key … whose last element is [1]
grid: [grid.x] / spacing = "logarithmic" => :4:1: [grid.x] spacing … takes points
grid: [grid.x] / spacing = "logarithmic" / points = 9 => : [grid.x] from … must be > 0 for equal ratios; it is 0
grid: [grid.x] / points = 9 / step = 1 => :5:1: [grid.x] step … points
grid: [b] / gravity_m_per_s2 = 9 / [grid.x] / key = "system.gravity_m_per_s2" => :6:1: [grid.x] key … also in [b]
grid: [grid] / difference = 1 / [grid.x] / key = "a.mass_kg[0]" / from = 1 => :4:1: [grid] difference … must be 0
grid: [grid.x] / key = "system.links" / from = 1 / to = 3 / step = 0.5 => :7:1: [grid.x] step … a whole number
grid: [[system.force]] / name = "双" / kind = "spring" / from = "bob1" / to = [1, 0] / [grid.x]
    / key = "system.force.双.stiffness_N_per_m" => :9:1: [grid.x] key … 双 … font
grid: [grid.x] / from = 10 / to = 10 / [grid.y] / key = "theta2_deg" => :5:1: [grid.x] to
    … must be above from (10); it is 10
grid: [grid.y] / key = "theta1_deg" => : [grid] x … "theta1_deg" is there twice
grid: [grid.y] / key = "theta2_deg" / values = [1, 2, 4, 9] => :5:1: [grid.y] values … equal steps or by equal ratios
grid: [grid] / quantity = "flip_time" / range = [0, 3] / [grid.y] / key = "theta2_deg" => :5:1: [grid] range
    … logarithmic scale
grid: [grid] / difference = 0.01 / threshold = 1 => :5:1: [grid] threshold … maps
grid: [grid.color] / key = "system" / values = [{ model = "angles" }] / labels = ["one", "two"]
    => :6:1: [grid.color] labels … the 1 values; there are 2
grid: [grid.color] / key = "system" / values = ["rk4"] => :5:1: [grid.color] values … tables of keys … "rk4"
grid: [grid] / quantity = "speed" => :4:1: [grid] quantity … divergence … it is "speed"
grid: [grid.x] / to = 90 => : [grid] difference … "divergence" … give grid.difference
grid: [grid] / quantity = "distance_at_end" => : [grid] difference … the same
grid: [grid] / difference = 1e-300 => :4:1: [grid] difference … 1e-300 is lost in rounding
    … give a greater grid.difference
grid: [grid] / difference = 0.01 / [grid.x] / key = "system.gravity_m_per_s2" / from = 9 / to = 10
    => : [grid] quantity … "divergence" … released differently … "distance_at_end"
grid: [grid] / quantity = "parting_time" / [grid.x] / key = "system.step_s" / from = 0.001 / to = 0.002
    / points = 2 => :4:1: [grid] quantity … "parting_time" … let [b] differ from [a]
grid: [grid.y] / key = "theta2_deg" => : [grid] difference … give grid.difference
grid: [grid] / quantity = "parting_time" / difference = -1e-300 / [grid.y] / key = "theta2_deg"
    => :5:1: [grid] difference … -1e-300
series: [series] / quantity = "distance" => :4:1: [series] quantity … let [b] differ
grid: [grid] / quantity = "convergence" / [grid.x] / key = "setting" / from = 0.01 / to = 0.1 / points = 2
    => :4:1: [grid] quantity … let [b] differ from [a]
grid: [system] / angle_deg = [0, 180] / [b] / angle_deg = [0, 0] / [grid.x] / key = "system.length_m" / from = 1
    / to = 2 / points = 2 => : [grid] quantity … "divergence" needs motion … all pairs rest in equilibrium
grid: [system] / angle_deg = [0, 0] / [b] / gravity_m_per_s2 = 9 / [grid] / quantity = "convergence" / [grid.x]
    / key = "setting" / from = 0.01 / to = 0.1 / points = 2 => :8:1: [grid] quantity … "convergence" needs motion
grid: [grid] / quantity = "convergence" => :4:1: [grid] quantity … key = "setting"
grid: [grid.x] / key = "setting" / from = 1 => : [grid.x] points … must be the number of settings
grid: [grid.x] / key = "angle_deg[0]" / values = [30, 60, 30] => :5:1: [grid.x] values
    … must differ; 30 is there twice
grid: [grid.x] / key = "setting" / from = 1 / to = 31 / points = 2 => :5:1: [grid.x] from … leave 1 to 1 … 30 s
grid: [grid.x] / tolerance_to = 1 => :4:1: [grid.x] tolerance_to … is only for key = "setting"
grid: [grid.panel] / key = "setting" / from = 1 / to = 2 / points = 2 => : … for x
grid: [grid] / overlay = "linear-limit" => :4:1: [grid] overlay … map of stability
grid: [system] / angle_deg = [0, 0] / [grid] / quantity = "stability" / [grid.x] / key = "setting" / from = 0.1
    / to = 1 / points = 2 => :6:1: [grid] quantity … more energy than hanging
sweep:  => :2:1: [scene] kind … it is "sweep"
grid: [grid.y] / from = 1 => :4:1: [grid.y] from … has no key
grid: [grid.x] / values = [1, 2] / from = 1 => :5:1: [grid.x] from … give it, or values
grid: [grid.x] / values = [] => :4:1: [grid.x] values … 1 to 1000 values
grid: [grid.x] / key = "system.integrator" / values = ["rk4"] => :3:7: [grid] x … is for panel or color
grid: [grid.y] / key = "theta2_deg" / [grid.color] / key = "mass_ratio" / values = [1] => :5:7: [grid] color
    … is only for curves
grid: [grid] / quantity = "energy_error" / [grid.x] / key = "system.mass_kg[1]" / from = 1 / [grid.color]
    / key = "links" / values = [2, 1] => :5:7: [grid] x … beyond the array, whose last element is [0]
grid: [b] / angle_deg = [90.01, 90] / [grid.x] / key = "system.links" / from = 2 / to = 4 / step = 1
    => :6:1: [grid.x] key … needs links that are all equal; angle_deg has different numbers
grid: [grid.x] / key = "system.center_m[1]" / from = 0.5 => :4:1: [grid.x] key … needs center_m in the preset
grid: [grid] / quantity = "energy_error" / range = 5
    => :5:1: [grid] range must be an array of 2 numbers, lowest and highest; it is a whole number (5)
grid: [grid] / quantity = "energy_error" / [grid.x] / key = "system.pivot.frequency_hz" / from = 1
    => :6:1: [grid.x] key "system.pivot.frequency_hz" has no effect without amplitude_m
grid: [system.pivot] / frequency_hz = 2 => :4:1: [system.pivot] frequency_hz has no effect without amplitude_m
grid: [b.pivot] / frequency_hz = 2 / [grid] / quantity = "distance_at_end" / [grid.x] / key = "a.pivot.amplitude_m"
    / to = 1 / points = 2 => :4:1: [b.pivot] frequency_hz has no effect without amplitude_m
grid: [grid] / quantity = "distance_at_end" / [a.pivot] / amplitude_m = 1 / [grid.color] / key = "b.pivot.phase_deg"
    / values = [1, 2] => :8:1: [grid.color] key "b.pivot.phase_deg" has no effect without amplitude_m
grid: [grid] / quantity = "energy_error" / [grid.x] / key = "b.mass_kg[1]" / from = 1
    => :6:1: [grid.x] key "b.mass_kg[1]" has no effect on "energy_error", which is of side a
grid: [grid] / quantity = "stroboscopic" => :4:1: [grid] quantity … that is driven
grid: [grid] / quantity = "exponent" / [grid.x] / from = 10 / to = 20 / points = 2 / [grid.color]
    / key = "system.integrator" / values = ["euler", "rk4"] => :4:1: [grid] quantity
    … is computed by a method of its own; an axis of methods changes nothing
grid: [grid] / quantity = "exponent" / [grid.x] / from = 10 / to = 20 / points = 2 / [grid.color] / key = "system"
    / values = [{ accuracy = 1e-6 }, { accuracy = 1e-9 }] => :4:1: [grid] quantity
    … is computed by a method of its own; an axis of methods changes nothing
grid: [grid] / quantity = "period" => :4:1: [grid] quantity … needs one link; there are 2
fractal:  => :2:1: [scene] kind … "grid" … it is "fractal"
series: [series] / quantity = "errors" / methods = [] => :5:1: [series] methods … must name at least one
series: [series] / quantity = "errors" / methods = ["rk5"] => :5:1: … it is "rk5"; did you mean "rk4"?
series: [series] / quantity = "errors" / projected = ["gauss4"] => :5:1: [series] projected … "gauss4" does not
series: [series] / quantity = "errors" / points_per_decade = 0 => :5:1: [series] points_per_decade
series: [series] / quantity = "errors" / duration_s = 5 => :5:1: [series] duration_s … must be from 10 to
series: [series] / quantity = "errors" / evaluations_per_s = 1 => :5:1: … must be from 10 to
series: [series] / quantity = "errors" / points = 3 => :5:1: … points_per_decade
series: [series] / quantity = "errors" / [system] / step_s = 0.1 => :6:1: … step_s
series: [series] / quantity = "exponents" / [system] / joint_coulomb_N_m = 0.1
    => :6:1: [system] joint_coulomb_N_m is not for Lyapunov exponents
series: [series] / quantity = "exponents" / [system] / mass_kg = 0 / rod_mass_kg = [1, 0]
    => : … mass_kg of link 2 and its rod_mass_kg are both 0
series: [series] / quantity = "log_ratio"
    => :4:1: [series] quantity "log_ratio" needs sides that are released differently
grid: [system] / links = 1 / joint_coulomb_N_m = 0.1 / integrator = "rk4" / [grid] / quantity = "exponent"
    => :8:1: … quantity needs a smooth motion
grid: [system] / links = 1 / joint_coulomb_N_m = 0.1 / integrator = "rk4" / [grid] / quantity = "exponent" / [grid.y]
    / key = "system.length_m" / from = 1 / to = 2 / points = 2 => :8:1: … quantity needs a smooth motion
grid: [system] / model = "angles" / [grid] / difference = 1 / [grid.panel] / key = "system.integrator"
    / values = ["euler", "rattle"] => : … "rattle"
work-precision: [chart] / cost = "money" => :4:1: [chart] cost
work-precision: [work_precision] / problems = ["P5"] => :4:1: … it is "P5"
work-precision: [work_precision] / problems = [] => :4:1: … at least one
work-precision: [work_precision] / problems = ["P1", "P1"] => :4:1: … must differ; P1 is there twice
work-precision: [work_precision] / scene = "butterfly" / problems = ["P1"] => :5:1: … combined with "scene"
work-precision: [work_precision] / scene = "fig7" => :4:1: … is a figure
work-precision: [work_precision] / duration_s = 3 => :4:1: [work_precision] duration_s
work-precision: [work_precision] / models = ["angels"] => :4:1: … it is "angels"
work-precision: [work_precision] / methods = ["magic"] => :4:1: … it is "magic"
work-precision: [work_precision] / methods = ["rattle"] / models = ["angles"] => :4:1: [work_precision] methods
    … must each run P1 with one of the models; "rattle" does not
work-precision: [work_precision] / methods = ["rattle", "rk4"] / models = ["angles"] => :4:1: [work_precision] methods
    … must each run P1 with one of the models; "rattle" does not
work-precision: [work_precision] / methods = ["gauss4"] / models = ["angles", "mechanism"] => :5:1:
    … must each run P1 with one of the methods; "mechanism" does not
work-precision: [work_precision] / scene = "springs" / models = ["angles"] => :5:1: … supports "mechanism"
work-precision: [work_precision] / scene = "rods" / models = ["mechanism"] => :5:1: … supports "angles"
work-precision: [work_precision] / repeats = 0 => :4:1: [work_precision] repeats
work-precision: [work_precision] / tolerance = 1 => :4:1: … tolerance
)";

inline std::vector<RefusedFigure> refused_figures() {
    const auto split = [](std::string text, std::string_view at) {
        std::vector<std::string> parts;
        for (std::size_t end; (end = text.find(at)) != std::string::npos; text.erase(0, end + at.size()))
            parts.push_back(text.substr(0, end));
        parts.push_back(text);
        return parts;
    };
    std::string joined(refused_list.substr(1, refused_list.size() - 2));
    for (std::size_t at; (at = joined.find("\n    ")) != std::string::npos;) joined.replace(at, 5, " ");
    std::vector<RefusedFigure> all;
    for (const auto& line : split(joined, "\n")) {
        const auto sides = split(line, " => ");
        const auto colon = sides[0].find(": ");
        RefusedFigure figure{"[scene]\nkind = \"" + sides[0].substr(0, colon) + "\"\n", split(sides.at(1), " … ")};
        for (const auto& part : split(sides[0].substr(colon + 2), " / ")) figure.text += part + "\n";
        figure.words.front().insert(0, "presets/x.toml");
        all.push_back(std::move(figure));
    }
    return all;
}

}  // namespace doppel
