#pragma once

#include <ostream>
#include <string>
#include <vector>

// Figures with errors and their messages, for the tests of the reader and of the schema.

namespace doppel {

struct RefusedFigure {
    std::string kind;   // of [scene]
    std::string text;   // from line 3 on
    std::string place;  // start of the message after the path
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
    RefusedFigure{"grid", "[series]\nquantity = \"distance\"", ":3:2: a preset has no \"series\"", {}},
    RefusedFigure{"grid", "[video]\nfps = 60", ":3:2: a preset has no \"video\"", {}},
    RefusedFigure{"grid", "sample_hz = 7", ":3:1: [scene] sample_hz", {"must divide the step rate"}}};

inline const std::vector<RefusedFigure> refused_figures_values{
    RefusedFigure{"grid", "[grid.x]\nkey = \"mass_ratio\"\nfrom = 0\nto = 1", ":5:1: [grid.x] from", {"> 0"}},
    RefusedFigure{"grid", "[grid.x]\nkey = \"length_ratio\"\nfrom = -1\nto = 1", ":5:1: [grid.x] from", {"> 0"}},
    RefusedFigure{"grid", "[grid.x]\nto = 1\nstep = 0.4", "", {"[grid.x]", "step"}},
    RefusedFigure{
        "series", "[[curve]]\ncolumn = \"x\"\n[[curve]]\ncolumn = \"x\"", ":6:1: [[curve]] 2 column", {"\"x\""}},
    RefusedFigure{"series", "[[curve]]\ncolumn = \"time_s\"", ":4:1: [[curve]] 1 column", {"\"time_s\""}},
    RefusedFigure{"grid",
                  "[[system.force]]\nkind = \"spring\"\nfrom = \"bob1\"\nto = [1, 0]\n[grid]\ndifference = 1\nright = "
                  "\"exponent\"",
                  ":9:1: [grid] right",
                  {}},
    RefusedFigure{"section", "[system]\nangle_deg = [3, 3]", ":4:1: [system]", {"angle_deg"}}};

inline const std::vector<RefusedFigure> refused_figures_chart{
    RefusedFigure{"grid", "[chart]\nsize = [0, 3]", ":4:1: [chart] size[0]", {"it is 0"}},
    RefusedFigure{"grid", "[chart]\nscale = 9", ":4:1: [chart] scale", {"at most 8; it is 9"}},
    RefusedFigure{"grid", "[chart]\nscale = 0", ":4:1: [chart] scale", {"must be > 0; it is 0"}},
    RefusedFigure{"grid",
                  "[chart]\ntheme = \"blue\"",
                  ":4:1: [chart] theme",
                  {"\"dark\", \"light\" or \"high-contrast\"; it is \"blue\""}},
    RefusedFigure{"grid", "[chart]\nfps = 3", ":4:1: [chart] has no \"fps\"", {}}};

inline const std::vector<RefusedFigure> refused_figures_series{
    RefusedFigure{
        "series", "[series]\nquantity = \"dist\"", ":4:1: [series] quantity", {"\"exponents\" or \"errors\""}},
    RefusedFigure{"series", "[[curve]]\nlabel = \"x\"", ":3:1: [[curve]] 1 column is missing", {}},
    RefusedFigure{"series", "[[curve]]\ncolumn = \"x\"\ncolour = 3", ":5:1: [[curve]] 1 has no \"colour\"", {}},
    RefusedFigure{"series", "[[curve]]\ncolumn = \"x\"\nsystem.angle = [3, 3]", ":5:8: ", {"has no \"angle\""}},
    RefusedFigure{"series", "[series]\ncheck_tolerance = 1e-9", ":4:1: [series] check_tolerance", {"adaptive methods"}},
    RefusedFigure{"series", "[curve]\ncolumn = \"x\"", ":3:2: curve", {"[[curve]]"}}};

inline const std::vector<RefusedFigure> refused_figures_others{
    RefusedFigure{
        "grid", "[chart]\nscale = 0.001", ":4:1: [chart] scale", {"16 to 16384 px a side; 0.001 times 1600×900 px"}},
    RefusedFigure{"grid", "[chart]\nscale = 8\nsize = [4000, 900]", ":4:1: [chart] scale", {"is 32000×7200"}},
    RefusedFigure{
        "grid", "[grid.x]\nfrom = 2e6\nto = 2e6", ":4:1: [grid.x] from", {"from -1000000 to 1000000", "theta1_deg"}},
    RefusedFigure{"grid", "[grid]\ndifference = -1e300", ":4:1: [grid] difference", {"from -1000000 to 1000000"}},
    RefusedFigure{"series",
                  "[series]\nquantity = \"errors\"\nmethods = [\"rk4\", \"rk4\"]",
                  ":5:1: [series] methods",
                  {"must differ; rk4 is there twice"}},
    RefusedFigure{"series",
                  "[series]\nquantity = \"errors\"\nprojected = [\"rk4\", \"rk4\"]",
                  ":5:1: [series] projected",
                  {"must differ"}},
    RefusedFigure{"work-precision",
                  "[work_precision]\nmethods = [\"rk4\", \"rk4\"]",
                  ":4:1: [work_precision] methods",
                  {"must differ"}},
    RefusedFigure{"series",
                  "[series]\nquantity = \"exponents\"\n[system]\nintegrator = \"rk4\"",
                  ":6:1: [system] has no \"integrator\"",
                  {}},
    RefusedFigure{"series",
                  "[series]\nquantity = \"exponents\"\n[system]\nmodel = \"angles\"",
                  ":6:1: [system] has no \"model\"",
                  {}},
    RefusedFigure{
        "series", "[series]\nquantity = \"exponents\"\n[system]\nlinks = 5", "", {"1 to 4 links; there are 5"}},
    RefusedFigure{"series", "[series]\nquantity = \"exponents\"\nsamples = 1", ":5:1: [series] samples", {"it is 1"}},
    RefusedFigure{
        "series", "[series]\nquantity = \"exponents\"\nduration_s = 0", ":5:1: [series] duration_s", {"must be > 0"}},
    RefusedFigure{
        "series", "duration_s = 3\n[series]\nquantity = \"exponents\"", ":3:1: [scene] has no \"duration_s\"", {}},
    RefusedFigure{"series", "[series]\nquantity = \"exponents\"\n[a]\nlinks = 2", ":5:2: a preset has no \"a\"", {}},
    RefusedFigure{"section", "[section]\nenergy_J = []", ":4:1: [section] energy_J", {"1 to 6 numbers"}},
    RefusedFigure{"section", "[section]\nenergy_J = [1, -1]", ":4:1: [section] energy_J[1]", {"must be > 0; it is -1"}},
    RefusedFigure{
        "section", "[section]\nenergy_J = [1, 2, 3, 4, 5, 6, 7]", ":4:1: [section] energy_J", {"1 to 6 numbers"}},
    RefusedFigure{"section", "[system]\nlinks = 3", "", {"two links; there are 3"}},
    RefusedFigure{"section", "[system]\nprecision = \"quad\"", ":4:1: [system] has no \"precision\"", {}},
    RefusedFigure{
        "grid", "[grid]\noverlay = \"energy-bound\"", ":4:1: [grid] overlay", {"two ideal links released at rest"}},
    RefusedFigure{"grid",
                  "[system]\nlinks = 1\nangle_deg = 170\njoint_viscous_N_m_s = 2\n[grid]\nquantity = \"deviation\"\n"
                  "overlay = \"mathieu\"\n[grid.x]\nkey = \"system.pivot.frequency_hz\"\nfrom = 1\npoints = 2\n"
                  "[grid.y]\nkey = \"system.pivot.amplitude_m\"\nfrom = 0\nto = 1\npoints = 2",
                  ":9:1: [grid] overlay",
                  {"one link without friction and torque"}},
    RefusedFigure{"grid", "[grid.x]\npoints = 1", ":4:1: [grid.x] points", {"from 2 to 1048576; it is 1"}},
    RefusedFigure{"grid", "[grid]\nflip_tolerance = 1e-9", ":4:1: [grid] flip_tolerance", {"is only for flip_time"}},
    RefusedFigure{"grid", "[grid.x]\nkey = \"system.mass_kg[3]\"", ":4:1: [grid.x] key", {"whose last element is [1]"}},
    RefusedFigure{"grid", "[grid.x]\nspacing = \"logarithmic\"", ":4:1: [grid.x] spacing", {"takes points"}},
    RefusedFigure{"grid",
                  "[grid.x]\nspacing = \"logarithmic\"\npoints = 9",
                  ": [grid.x] from",
                  {"must be > 0 for equal ratios; it is 0"}},
    RefusedFigure{"grid", "[grid.x]\npoints = 9\nstep = 1", ":5:1: [grid.x] step", {"points"}},
    RefusedFigure{"grid",
                  "[b]\ngravity_m_per_s2 = 9\n[grid.x]\nkey = \"system.gravity_m_per_s2\"",
                  ":6:1: [grid.x] key",
                  {"also in [b]"}},
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
    RefusedFigure{"grid",
                  "[grid.y]\nkey = \"theta2_deg\"\nvalues = [1, 2, 4, 9]",
                  ":5:1: [grid.y] values",
                  {"equal steps or by equal ratios"}},
    RefusedFigure{"grid",
                  "[grid]\nquantity = \"flip_time\"\nrange = [0, 3]\n[grid.y]\nkey = \"theta2_deg\"",
                  ":5:1: [grid] range",
                  {"logarithmic scale"}},
    RefusedFigure{"grid", "[grid]\ndifference = 0.01\nthreshold = 1", ":5:1: [grid] threshold", {"maps"}},
    RefusedFigure{"grid",
                  "[grid.color]\nkey = \"system\"\nvalues = [{ model = \"angles\" }]\nlabels = [\"one\", \"two\"]",
                  ":6:1: [grid.color] labels",
                  {"the 1 values; there are 2"}},
    RefusedFigure{"grid",
                  "[grid.color]\nkey = \"system\"\nvalues = [\"rk4\"]",
                  ":5:1: [grid.color] values",
                  {"tables of keys", "\"rk4\""}},
    RefusedFigure{"grid", "[grid]\nquantity = \"speed\"", ":4:1: [grid] quantity", {"divergence", "it is \"speed\""}},
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
    RefusedFigure{"series", "[series]\nquantity = \"distance\"", ":4:1: [series] quantity", {"let [b] differ"}},
    RefusedFigure{"grid",
                  "[grid]\nquantity = \"convergence\"\n[grid.x]\nkey = \"setting\"\nfrom = 0.01\nto = 0.1\npoints = 2",
                  ":4:1: [grid] quantity",
                  {"let [b] differ from [a]"}},
    RefusedFigure{"grid",
                  "[system]\nangle_deg = [0, 180]\n[b]\nangle_deg = [0, 0]\n[grid.x]\nkey = \"system.length_m\"\n"
                  "from = 1\nto = 2\npoints = 2",
                  ": [grid] quantity",
                  {"\"divergence\" needs motion", "all pairs rest in equilibrium"}},
    RefusedFigure{"grid",
                  "[system]\nangle_deg = [0, 0]\n[b]\ngravity_m_per_s2 = 9\n[grid]\nquantity = \"convergence\"\n"
                  "[grid.x]\nkey = \"setting\"\nfrom = 0.01\nto = 0.1\npoints = 2",
                  ":8:1: [grid] quantity",
                  {"\"convergence\" needs motion"}},
    RefusedFigure{"grid", "[grid]\nquantity = \"convergence\"", ":4:1: [grid] quantity", {"key = \"setting\""}},
    RefusedFigure{
        "grid", "[grid.x]\nkey = \"setting\"\nfrom = 1", ": [grid.x] points", {"must be the number of settings"}},
    RefusedFigure{"grid",
                  "[grid.x]\nkey = \"angle_deg[0]\"\nvalues = [30, 60, 30]",
                  ":5:1: [grid.x] values",
                  {"must differ; 30 is there twice"}},
    RefusedFigure{"grid",
                  "[grid.x]\nkey = \"setting\"\nfrom = 1\nto = 31\npoints = 2",
                  ":5:1: [grid.x] from",
                  {"leave 1 to 1", "30 s"}},
    RefusedFigure{
        "grid", "[grid.x]\ntolerance_to = 1", ":4:1: [grid.x] tolerance_to", {"is only for key = \"setting\""}},
    RefusedFigure{"grid", "[grid.panel]\nkey = \"setting\"\nfrom = 1\nto = 2\npoints = 2", "", {"for x"}},
    RefusedFigure{"grid", "[grid]\noverlay = \"linear-limit\"", ":4:1: [grid] overlay", {"map of stability"}},
    RefusedFigure{
        "grid",
        "[system]\nangle_deg = [0, 0]\n[grid]\nquantity = \"stability\"\n[grid.x]\nkey = \"setting\"\nfrom = 0.1\nto = "
        "1\npoints = 2",
        ":6:1: [grid] quantity",
        {"more energy than hanging"}},
    RefusedFigure{"sweep", "", ":2:1: [scene] kind", {"it is \"sweep\""}},
    RefusedFigure{"grid", "[grid.y]\nfrom = 1", ":4:1: [grid.y] from", {"has no key"}},
    RefusedFigure{"grid", "[grid.x]\nvalues = [1, 2]\nfrom = 1", ":5:1: [grid.x] from", {"give it, or values"}},
    RefusedFigure{"grid", "[grid.x]\nvalues = []", ":4:1: [grid.x] values", {"1 to 1000 values"}},
    RefusedFigure{"grid",
                  "[grid.x]\nkey = \"system.integrator\"\nvalues = [\"rk4\"]",
                  ":3:7: [grid] x",
                  {"is for panel or color"}},
    RefusedFigure{"grid",
                  "[grid.y]\nkey = \"theta2_deg\"\n[grid.color]\nkey = \"mass_ratio\"\nvalues = [1]",
                  ":5:7: [grid] color",
                  {"is only for curves"}},
    RefusedFigure{"grid",
                  "[grid]\nquantity = \"energy_error\"\n[grid.x]\nkey = \"system.mass_kg[1]\"\nfrom = 1\n"
                  "[grid.color]\nkey = \"links\"\nvalues = [2, 1]",
                  ":5:7: [grid] x",
                  {"beyond the array, whose last element is [0]"}},
    RefusedFigure{"grid",
                  "[b]\nangle_deg = [90.01, 90]\n[grid.x]\nkey = \"system.links\"\nfrom = 2\nto = 4\nstep = 1",
                  ":6:1: [grid.x] key",
                  {"needs links that are all equal; angle_deg has different numbers"}},
    RefusedFigure{"grid",
                  "[grid.x]\nkey = \"system.center_m[1]\"\nfrom = 0.5",
                  ":4:1: [grid.x] key",
                  {"needs center_m in the preset"}},
    RefusedFigure{"grid", "[grid]\nquantity = \"stroboscopic\"", ":4:1: [grid] quantity", {"that is driven"}},
    RefusedFigure{"grid",
                  "[grid]\nquantity = \"exponent\"\n[grid.x]\nfrom = 10\nto = 20\npoints = 2\n[grid.color]\nkey = "
                  "\"system.integrator\"\nvalues = [\"euler\", \"rk4\"]",
                  ":4:1: [grid] quantity",
                  {"is computed by a method of its own; an axis of methods changes nothing"}},
    RefusedFigure{"grid",
                  "[grid]\nquantity = \"exponent\"\n[grid.x]\nfrom = 10\nto = 20\npoints = 2\n[grid.color]\nkey = "
                  "\"system\"\nvalues = [{ accuracy = 1e-6 }, { accuracy = 1e-9 }]",
                  ":4:1: [grid] quantity",
                  {"is computed by a method of its own; an axis of methods changes nothing"}},
    RefusedFigure{"grid", "[grid]\nquantity = \"period\"", ":4:1: [grid] quantity", {"needs one link; there are 2"}},
    RefusedFigure{"fractal", "", ":2:1: [scene] kind", {"\"grid\"", "it is \"fractal\""}}};

}  // namespace doppel
