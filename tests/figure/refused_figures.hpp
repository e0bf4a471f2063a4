#pragma once

#include <ostream>
#include <string>
#include <vector>

// Figures that are refused, and how: the reader's tests go through them, and those of the schema.

namespace doppel {

struct RefusedFigure {
    std::string kind;   // of [scene]
    std::string text;   // what follows, from line 3 on
    std::string place;  // what the message begins with after the path
    std::vector<std::string> words;
};

inline void PrintTo(const RefusedFigure& c, std::ostream* out) {
    *out << c.kind << ": " << c.text;
}

inline const std::vector<RefusedFigure> refused_figures_sweep{
    RefusedFigure{"grid", "[grid.x]\nstep = 0", ":4:1: [grid.x] step", {"must be > 0; it is 0"}},
    RefusedFigure{"grid", "[b]\nlinks = 3", ":4:1: [b] links", {"must be that of the other side", "they are 2 and 3"}},
    RefusedFigure{"grid", "[b]\nlabel = \"x\"", ":4:1: [b] has no \"label\"", {}},
    RefusedFigure{"grid", "[grid.x]\nstep = -0.5", ":4:1: [grid.x] step", {"must be > 0; it is -0.5"}},
    RefusedFigure{"grid", "[grid.x]\nfrom = 10\nto = 5", ":5:1: [grid.x] to", {"it is 5"}},
    RefusedFigure{"grid", "[grid.x]\nto = 1e12", ":4:1: [grid.x] to", {"it is 1000000000000"}},
    RefusedFigure{"grid", "[grid.x]\nkey = \"theta1\"", ":4:1: [grid.x] key", {"theta1_deg", "it is \"theta1\""}},
    RefusedFigure{"grid", "[grid.x]\nfrm = 1", ":4:1: [grid.x] has no \"frm\"", {"did you mean \"from\"?"}},
    RefusedFigure{
        "grid", "[grid.x]\nfrom = \"1\"", ":4:1: [grid.x] from", {"must be a number; it is a string (\"1\")"}},
    RefusedFigure{"grid", "[grid.x]\nfrom = nan", ":4:1: [grid.x] from", {"must be finite; it is nan"}},
    RefusedFigure{"grid", "[grid.x]\nto = inf", ":4:1: [grid.x] to", {"must be finite; it is inf"}},
    RefusedFigure{"grid", "[grid]\nright = 1", ":4:1: [grid] right", {"must be a string"}},
    RefusedFigure{"grid",
                  "[grid]\nright = \"exponent\"\nexponent_duration_s = -5",
                  ":5:1: [grid] exponent_duration_s",
                  {"must be > 0"}},
    RefusedFigure{"grid", "[system]\nlinks = 1\n[grid.x]\nkey = \"mass_ratio\"", ":6:1: [grid.x] key", {"2 links"}},
    RefusedFigure{
        "grid", "[system]\nlenght_m = 3", ":4:1: [system] has no \"lenght_m\"", {"did you mean \"length_m\"?"}},
    RefusedFigure{"grid", "[curves]\nquantity = \"distance\"", ":3:2: a preset has no \"curves\"", {}},
    RefusedFigure{"grid", "[video]\nfps = 60", ":3:2: a preset has no \"video\"", {}},
    RefusedFigure{"grid", "sample_hz = 7", ":3:1: [scene] sample_hz", {"must divide the step rate"}}};

inline const std::vector<RefusedFigure> refused_figures_values{
    RefusedFigure{"grid", "[grid.x]\nkey = \"mass_ratio\"\nfrom = 0\nto = 1", ":5:1: [grid.x] from", {"> 0"}},
    RefusedFigure{"grid", "[grid.x]\nkey = \"length_ratio\"\nfrom = -1\nto = 1", ":5:1: [grid.x] from", {"> 0"}},
    RefusedFigure{"grid", "[grid.x]\nto = 1\nstep = 0.4", "", {"[grid.x]", "step"}},
    RefusedFigure{"convergence", "[convergence]\nmethods = []", ":4:1: [convergence] methods", {}},
    RefusedFigure{
        "curves", "[[curve]]\ncolumn = \"x\"\n[[curve]]\ncolumn = \"x\"", ":6:1: [[curve]] 2 column", {"\"x\""}},
    RefusedFigure{"curves", "[[curve]]\ncolumn = \"time_s\"", ":4:1: [[curve]] 1 column", {"\"time_s\""}},
    RefusedFigure{"grid",
                  "[[system.force]]\nkind = \"spring\"\nfrom = \"bob1\"\nto = [1, 0]\n[grid]\ndifference = 1\nright = "
                  "\"exponent\"",
                  ":9:1: [grid] right",
                  {}},
    RefusedFigure{"section", "[system]\nangle_deg = [3, 3]", ":4:1: [system]", {"angle_deg"}}};

inline const std::vector<RefusedFigure> refused_figures_chart{
    RefusedFigure{"grid", "[chart]\nsize = [0, 3]", ":4:1: [chart] size", {"it is [0, 3]"}},
    RefusedFigure{"grid", "[chart]\nscale = 9", ":4:1: [chart] scale", {"at most 8; it is 9"}},
    RefusedFigure{"grid", "[chart]\nscale = 0", ":4:1: [chart] scale", {"must be > 0; it is 0"}},
    RefusedFigure{"grid",
                  "[chart]\ntheme = \"blue\"",
                  ":4:1: [chart] theme",
                  {"\"dark\", \"light\" or \"high-contrast\"; it is \"blue\""}},
    RefusedFigure{"grid", "[chart]\nfps = 3", ":4:1: [chart] has no \"fps\"", {}}};

inline const std::vector<RefusedFigure> refused_figures_curves{
    RefusedFigure{
        "curves", "[curves]\nquantity = \"dist\"", ":4:1: [curves] quantity", {"\"distance\" or \"log_ratio\""}},
    RefusedFigure{"curves", "[[curve]]\nlabel = \"x\"", "", {"[[curve]] 1 column is missing"}},
    RefusedFigure{"curves", "[[curve]]\ncolumn = \"x\"\ncolour = 3", ":5:1: [[curve]] 1 has no \"colour\"", {}},
    RefusedFigure{"curves", "[[curve]]\ncolumn = \"x\"\nsystem.angle = [3, 3]", ":5:8: ", {"has no \"angle\""}},
    RefusedFigure{"curves", "[curves]\ncheck_tolerance = 1e-9", ":4:1: [curves] check_tolerance", {"a tolerance"}},
    RefusedFigure{"curves", "[curve]\ncolumn = \"x\"", ":3:2: curve", {"[[curve]]"}}};

inline const std::vector<RefusedFigure> refused_figures_others{
    RefusedFigure{
        "grid", "[chart]\nscale = 0.001", ":4:1: [chart] scale", {"16 to 16384 px a side; 0.001 times 1600×900 px"}},
    RefusedFigure{"grid", "[chart]\nscale = 8\nsize = [4000, 900]", ":4:1: [chart] scale", {"is 32000×7200"}},
    RefusedFigure{
        "grid", "[grid.x]\nfrom = 2e6\nto = 2e6", ":4:1: [grid.x] from", {"from -1000000 to 1000000", "theta1_deg"}},
    RefusedFigure{"grid", "[grid]\ndifference = -1e300", ":4:1: [grid] difference", {"from -1000000 to 1000000"}},
    RefusedFigure{
        "convergence", "[convergence]\nmethods = [\"rk4\", \"rk4\"]", ":4:1: [convergence] methods", {"must differ"}},
    RefusedFigure{"drift", "[drift]\nmethods = [\"rk4\", \"rk4\"]", ":4:1: [drift] methods", {"must differ; \"rk4\""}},
    RefusedFigure{"drift", "[drift]\nprojected = [\"rk4\", \"rk4\"]", ":4:1: [drift] projected", {"must differ"}},
    RefusedFigure{"work-precision",
                  "[work_precision]\nmethods = [\"rk4\", \"rk4\"]",
                  ":4:1: [work_precision] methods",
                  {"must differ"}},
    RefusedFigure{"convergence", "[convergence]\nmethods = [\"magic\"]", ":4:1: [convergence] methods", {"\"magic\""}},
    RefusedFigure{"convergence",
                  "[convergence]\nmethods = [\"euler/dop853\"]",
                  ":4:1: [convergence] methods",
                  {"\"euler/dop853\""}},
    RefusedFigure{"convergence", "[convergence]\nhalvings = 0", ":4:1: [convergence] halvings", {"it is 0"}},
    RefusedFigure{"convergence", "[convergence]\nhalvings = 2.5", ":4:1: [convergence] halvings", {"a whole number"}},
    RefusedFigure{"spectrum", "[system]\nintegrator = \"rk4\"", ":4:1: [system] has no \"integrator\"", {}},
    RefusedFigure{"spectrum", "[system]\nmodel = \"angles\"", ":4:1: [system] has no \"model\"", {}},
    RefusedFigure{"spectrum", "[system]\nlinks = 5", "", {"1 to 4 links; there are 5"}},
    RefusedFigure{"spectrum", "[spectrum]\nsamples = 1", ":4:1: [spectrum] samples", {"it is 1"}},
    RefusedFigure{"spectrum", "[spectrum]\nduration_s = 0", ":4:1: [spectrum] duration_s", {"must be > 0"}},
    RefusedFigure{"spectrum", "duration_s = 3", ":3:1: [scene] has no \"duration_s\"", {}},
    RefusedFigure{"spectrum", "[a]\nlinks = 2", ":3:2: a preset has no \"a\"", {}},
    RefusedFigure{"section", "[section]\nenergy_J = []", ":4:1: [section] energy_J", {"1 to 6 numbers"}},
    RefusedFigure{"section", "[section]\nenergy_J = [1, -1]", ":4:1: [section] energy_J[1]", {"must be > 0; it is -1"}},
    RefusedFigure{
        "section", "[section]\nenergy_J = [1, 2, 3, 4, 5, 6, 7]", ":4:1: [section] energy_J", {"1 to 6 numbers"}},
    RefusedFigure{"section", "[system]\nlinks = 3", "", {"two links; there are 3"}},
    RefusedFigure{"section", "[system]\nprecision = \"quad\"", ":4:1: [system] has no \"precision\"", {}},
    RefusedFigure{
        "grid", "[grid]\nquantity = \"flip_time\"\nchecked = 9", ":5:1: [grid] checked", {"one map of flips"}},
    RefusedFigure{
        "grid", "[grid]\noverlay = \"energy-bound\"", ":4:1: [grid] overlay", {"two ideal links released at rest"}},
    RefusedFigure{"grid", "[grid.x]\npoints = 1", ":4:1: [grid.x] points", {"from 2 to 1048576; it is 1"}},
    RefusedFigure{"grid", "[grid]\nflip_tolerance = 1e-9", ":4:1: [grid] flip_tolerance", {"is of flip_time"}},
    RefusedFigure{"grid", "[grid.x]\nkey = \"system.mass_kg[3]\"", ":4:1: [grid.x] key", {"whose last is [1]"}},
    RefusedFigure{"grid", "[grid.x]\nspacing = \"logarithmic\"", ":4:1: [grid.x] spacing", {"takes points"}},
    RefusedFigure{"grid",
                  "[grid.x]\nspacing = \"logarithmic\"\npoints = 9",
                  ": [grid.x] from",
                  {"must be > 0 for equal ratios; it is 0"}},
    RefusedFigure{"grid", "[grid.x]\npoints = 9\nstep = 1", ":5:1: [grid.x] step", {"points"}},
    RefusedFigure{"grid",
                  "[b]\ngravity_m_per_s2 = 9\n[grid.x]\nkey = \"system.gravity_m_per_s2\"",
                  ":6:1: [grid.x] key",
                  {"in [b] as well"}},
    RefusedFigure{"grid",
                  "[grid]\ndifference = 1\n[grid.x]\nkey = \"a.mass_kg[0]\"\nfrom = 1",
                  ":4:1: [grid] difference",
                  {"must be 0"}},
    RefusedFigure{"grid",
                  "[grid.x]\nkey = \"system.links\"\nfrom = 1\nto = 3\nstep = 0.5",
                  ":7:1: [grid.x] step",
                  {"a whole number"}},
    RefusedFigure{"grid",
                  "[[system.force]]\nname = \"双\"\nkind = \"spring\"\nfrom = \"bob1\"\nto = [1, 0]\n[grid.x]\nkey = "
                  "\"system.force.双.stiffness_N_per_m\"",
                  ":9:1: [grid.x] key",
                  {"双", "font"}},
    RefusedFigure{"grid",
                  "[grid.x]\nfrom = 10\nto = 10\n[grid.y]\nkey = \"theta2_deg\"",
                  ":5:1: [grid.x] to",
                  {"must be above from (10); it is 10"}},
    RefusedFigure{"grid", "[grid.y]\nkey = \"theta1_deg\"", ": [grid] x", {"\"theta1_deg\" is there twice"}},
    RefusedFigure{
        "grid", "[grid.y]\nkey = \"system.links\"\nfrom = 1\nto = 4", ":4:1: [grid.y] key", {"whole numbers alone"}},
    RefusedFigure{"grid",
                  "[grid]\nquantity = \"flip_time\"\ncolor_range = [0, 3]\n[grid.y]\nkey = \"theta2_deg\"",
                  ":5:1: [grid] color_range",
                  {"logarithmic scale"}},
    RefusedFigure{"grid", "[grid]\nquantity = \"speed\"", ":4:1: [grid] quantity", {"divergence", "it is \"speed\""}},
    RefusedFigure{"grid", "[grid]\nquantity = \"flip_time\"\nchecked = -1", ":5:1: [grid] checked", {"it is -1"}},
    RefusedFigure{"grid", "[grid.x]\nto = 90", ": [grid] difference", {"\"divergence\"", "give grid.difference"}},
    RefusedFigure{"grid", "[grid]\nquantity = \"distance_at_end\"", ": [grid] difference", {"the same"}},
    RefusedFigure{"grid",
                  "[grid]\ndifference = 1e-300",
                  ":4:1: [grid] difference",
                  {"1e-300 is lost in rounding", "give a greater grid.difference"}},
    RefusedFigure{"grid",
                  "[grid]\ndifference = 0.01\n[grid.x]\nkey = \"system.gravity_m_per_s2\"\nfrom = 9\nto = 10",
                  ": [grid] quantity",
                  {"\"divergence\"", "released differently", "\"distance_at_end\""}},
    RefusedFigure{"grid",
                  "[grid]\nquantity = \"parting_time\"\n[grid.x]\nkey = \"system.step_s\"\nfrom = 0.001\n"
                  "to = 0.002\npoints = 2",
                  ":4:1: [grid] quantity",
                  {"\"parting_time\"", "let [b] differ from [a]"}},
    RefusedFigure{"grid", "[grid.y]\nkey = \"theta2_deg\"", ": [grid] difference", {"give grid.difference"}},
    RefusedFigure{"grid",
                  "[grid]\nquantity = \"parting_time\"\ndifference = -1e-300\n[grid.y]\nkey = \"theta2_deg\"",
                  ":5:1: [grid] difference",
                  {"-1e-300"}},
    RefusedFigure{"curves", "[curves]\nquantity = \"distance\"", ":4:1: [curves] quantity", {"let [b] differ"}},
    RefusedFigure{"convergence",
                  "[convergence]\nmethods = [\"rk4\"]",
                  ":4:1: [convergence] methods",
                  {"the same", "let [b] differ", "\"one/other\""}},
    RefusedFigure{"sweep", "", ":2:1: [scene] kind", {"it is \"sweep\""}},
    RefusedFigure{"grid", "[grid.y]\nfrom = 1", ":4:1: [grid.y] from", {"needs a key"}},
    RefusedFigure{"grid", "[grid.x]\nvalues = [1, 2]\nfrom = 1", ":5:1: [grid.x] from", {"give it, or values"}},
    RefusedFigure{"grid", "[grid.x]\nvalues = []", ":4:1: [grid.x] values", {"1 to 1000 values"}},
    RefusedFigure{"grid",
                  "[grid.x]\nkey = \"system.integrator\"\nvalues = [\"rk4\"]",
                  ":3:7: [grid] x",
                  {"is for panel or color"}},
    RefusedFigure{"grid",
                  "[grid.y]\nkey = \"theta2_deg\"\n[grid.color]\nkey = \"mass_ratio\"\nvalues = [1]",
                  ":5:7: [grid] color",
                  {"is of curves"}},
    RefusedFigure{"grid",
                  "[grid]\nquantity = \"energy_error\"\n[grid.x]\nkey = \"system.mass_kg[1]\"\nfrom = 1\n"
                  "[grid.color]\nkey = \"links\"\nvalues = [2, 1]",
                  ":5:7: [grid] x",
                  {"beyond the array, whose last is [0]"}},
    RefusedFigure{"grid", "[grid]\nquantity = \"stroboscopic\"", ":4:1: [grid] quantity", {"that is driven"}},
    RefusedFigure{"grid", "[grid]\nquantity = \"period\"", ":4:1: [grid] quantity", {"of one link; there are 2"}},
    RefusedFigure{"fractal", "", ":2:1: [scene] kind", {"\"grid\"", "it is \"fractal\""}}};

}  // namespace doppel
