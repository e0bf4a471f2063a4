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
    RefusedFigure{"sweep", "[sweep]\nstep = 0", ":4:1: [sweep] step", {"must be > 0; it is 0"}},
    RefusedFigure{"sweep", "[b]\nlinks = 3", ":4:1: [b] links", {"must be that of the other side", "they are 2 and 3"}},
    RefusedFigure{"sweep", "[b]\nlabel = \"x\"", ":4:1: [b] has no \"label\"", {}},
    RefusedFigure{"sweep", "[sweep]\nstep = -0.5", ":4:1: [sweep] step", {"must be > 0; it is -0.5"}},
    RefusedFigure{"sweep", "[sweep]\nfrom = 10\nto = 5", ":5:1: [sweep] to", {"it is 5"}},
    RefusedFigure{"sweep", "[sweep]\nto = 1e12", ":4:1: [sweep] to", {"it is 1000000000000"}},
    RefusedFigure{
        "sweep", "[sweep]\nparameter = \"theta1\"", ":4:1: [sweep] parameter", {"theta1_deg", "it is \"theta1\""}},
    RefusedFigure{"sweep", "[sweep]\nfrm = 1", ":4:1: [sweep] has no \"frm\"", {"did you mean \"from\"?"}},
    RefusedFigure{"sweep", "[sweep]\nfrom = \"1\"", ":4:1: [sweep] from", {"must be a number; it is a string (\"1\")"}},
    RefusedFigure{"sweep", "[sweep]\nfrom = nan", ":4:1: [sweep] from", {"must be finite; it is nan"}},
    RefusedFigure{"sweep", "[sweep]\nto = inf", ":4:1: [sweep] to", {"must be finite; it is inf"}},
    RefusedFigure{"sweep", "[sweep]\nexponent = 1", ":4:1: [sweep] exponent", {"must be true or false"}},
    RefusedFigure{"sweep",
                  "[sweep]\nexponent = true\nexponent_duration_s = -5",
                  ":5:1: [sweep] exponent_duration_s",
                  {"must be > 0"}},
    RefusedFigure{
        "sweep", "[system]\nlinks = 1\n[sweep]\nparameter = \"mass_ratio\"", ":6:1: [sweep] parameter", {"2 links"}},
    RefusedFigure{
        "sweep", "[system]\nlenght_m = 3", ":4:1: [system] has no \"lenght_m\"", {"did you mean \"length_m\"?"}},
    RefusedFigure{"sweep", "[curves]\nquantity = \"distance\"", ":3:2: a preset has no \"curves\"", {}},
    RefusedFigure{"sweep", "[video]\nfps = 60", ":3:2: a preset has no \"video\"", {}},
    RefusedFigure{"sweep", "sample_hz = 7", ":3:1: [scene] sample_hz", {"must divide the step rate"}}};

inline const std::vector<RefusedFigure> refused_figures_values{
    RefusedFigure{"sweep", "[sweep]\nparameter = \"mass_ratio\"\nfrom = 0\nto = 1", ":5:1: [sweep] from", {"> 0"}},
    RefusedFigure{"sweep", "[sweep]\nparameter = \"length_ratio\"\nfrom = -1\nto = 1", ":5:1: [sweep] from", {"> 0"}},
    RefusedFigure{"sweep", "[sweep]\nto = 1\nstep = 0.4", "", {"[sweep]", "step"}},
    RefusedFigure{"convergence", "[convergence]\nmethods = []", ":4:1: [convergence] methods", {}},
    RefusedFigure{
        "curves", "[[curve]]\ncolumn = \"x\"\n[[curve]]\ncolumn = \"x\"", ":6:1: [[curve]] 2 column", {"\"x\""}},
    RefusedFigure{"curves", "[[curve]]\ncolumn = \"time_s\"", ":4:1: [[curve]] 1 column", {"\"time_s\""}},
    RefusedFigure{"sweep",
                  "[[system.force]]\nkind = \"spring\"\nfrom = \"bob1\"\nto = [1, 0]\n[sweep]\nexponent = true",
                  ":8:1: [sweep] exponent",
                  {}},
    RefusedFigure{"section", "[system]\nangle_deg = [3, 3]", ":4:1: [system]", {"angle_deg"}}};

inline const std::vector<RefusedFigure> refused_figures_chart{
    RefusedFigure{"sweep", "[chart]\nsize = [0, 3]", ":4:1: [chart] size", {"it is [0, 3]"}},
    RefusedFigure{"sweep", "[chart]\nscale = 9", ":4:1: [chart] scale", {"at most 8; it is 9"}},
    RefusedFigure{"sweep", "[chart]\nscale = 0", ":4:1: [chart] scale", {"must be > 0; it is 0"}},
    RefusedFigure{"sweep",
                  "[chart]\ntheme = \"blue\"",
                  ":4:1: [chart] theme",
                  {"\"dark\", \"light\" or \"high-contrast\"; it is \"blue\""}},
    RefusedFigure{"sweep", "[chart]\nfps = 3", ":4:1: [chart] has no \"fps\"", {}}};

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
        "sweep", "[chart]\nscale = 0.001", ":4:1: [chart] scale", {"16 to 16384 px a side; 0.001 times 1600×900 px"}},
    RefusedFigure{"sweep", "[chart]\nscale = 8\nsize = [4000, 900]", ":4:1: [chart] scale", {"is 32000×7200"}},
    RefusedFigure{
        "sweep", "[sweep]\nfrom = 2e6\nto = 2e6", ":4:1: [sweep] from", {"from -1000000 to 1000000", "theta1_deg"}},
    RefusedFigure{"sweep", "[sweep]\ndifference = -1e300", ":4:1: [sweep] difference", {"from -1000000 to 1000000"}},
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
    RefusedFigure{"flip-map", "[system]\nangle_deg = [90, 90]", ":4:1: [system] angle_deg", {"flip map"}},
    RefusedFigure{"flip-map", "[system]\nlinks = 3", ":4:1: [system] links", {"flip map"}},
    RefusedFigure{"flip-map", "[system]\nstep_s = 0.1", ":4:1: [system] has no \"step_s\"", {}},
    RefusedFigure{"flip-map", "[flip_map]\ncolumns = 1", ":4:1: [flip_map] columns", {"from 2 to 1048576; it is 1"}},
    RefusedFigure{"flip-map", "[flip_map]\nduration_s = 0", ":4:1: [flip_map] duration_s", {"must be > 0"}},
    RefusedFigure{
        "sweep", "[sweep]\nparameter = \"system.mass_kg[3]\"", ":4:1: [sweep] parameter", {"whose last is [1]"}},
    RefusedFigure{"sweep", "[sweep]\nspacing = \"logarithmic\"", ":4:1: [sweep] spacing", {"takes points"}},
    RefusedFigure{"sweep",
                  "[sweep]\nspacing = \"logarithmic\"\npoints = 9",
                  ": [sweep] from",
                  {"must be > 0 for equal ratios; it is 0"}},
    RefusedFigure{"sweep", "[sweep]\npoints = 9\nstep = 1", ":5:1: [sweep] step", {"points"}},
    RefusedFigure{"sweep",
                  "[b]\ngravity_m_per_s2 = 9\n[sweep]\nparameter = \"system.gravity_m_per_s2\"",
                  ":6:1: [sweep] parameter",
                  {"in [b] as well"}},
    RefusedFigure{"sweep",
                  "[sweep]\nparameter = \"a.mass_kg[0]\"\nfrom = 1\ndifference = 1",
                  ":6:1: [sweep] difference",
                  {"must be 0"}},
    RefusedFigure{"sweep",
                  "[sweep]\nparameter = \"system.links\"\nfrom = 1\nto = 3\nstep = 0.5",
                  ":7:1: [sweep] step",
                  {"a whole number"}},
    RefusedFigure{
        "sweep",
        "[[system.force]]\nname = \"双\"\nkind = \"spring\"\nfrom = \"bob1\"\nto = [1, 0]\n[sweep]\nparameter = "
        "\"system.force.双.stiffness_N_per_m\"",
        ":9:1: [sweep] parameter",
        {"双", "font"}},
    RefusedFigure{"map", "[map]\nx_from = 10\nx_to = 5", ":5:1: [map] x_to", {"must be above x_from (10); it is 5"}},
    RefusedFigure{
        "map", "[map]\ny_parameter = \"theta1_deg\"", ":4:1: [map] y_parameter", {"another than x_parameter"}},
    RefusedFigure{"map",
                  "[map]\ny_parameter = \"system.links\"\ny_from = 1\ny_to = 4",
                  ":4:1: [map] y_parameter",
                  {"vary it in a sweep"}},
    RefusedFigure{"map", "[map]\ncolor_range = [0, 3]", ":4:1: [map] color_range", {"logarithmic scale"}},
    RefusedFigure{"map", "[map]\nquantity = \"speed\"", ":4:1: [map] quantity", {"divergence", "it is \"speed\""}},
    RefusedFigure{
        "flip-map", "[flip_map]\ntheta1_range_deg = [30, -30]", ":4:1: [flip_map] theta1_range_deg", {"must rise"}},
    RefusedFigure{"flip-map", "[flip_map]\nchecked = -1", ":4:1: [flip_map] checked", {"it is -1"}},
    RefusedFigure{"links", "[system]\nlinks = 2", "", {"one link"}},
    RefusedFigure{"links", "[system]\nlinks = 1\n[links]\nfrom = 5\nto = 3", ":7:1: [links] to", {"it is 3"}},
    RefusedFigure{"links", "[system]\nlinks = 1\nintegrator = \"rk4\"", ":5:1: [system] has no \"integrator\"", {}},
    RefusedFigure{"sweep", "[sweep]\nto = 90", ": [sweep] difference", {"\"divergence\"", "give sweep.difference"}},
    RefusedFigure{"sweep", "[sweep]\nquantity = \"distance_at_end\"", ": [sweep] difference", {"the same"}},
    RefusedFigure{"sweep",
                  "[sweep]\ndifference = 1e-300",
                  ":4:1: [sweep] difference",
                  {"1e-300 is lost in rounding", "give a greater sweep.difference"}},
    RefusedFigure{"sweep",
                  "[sweep]\nparameter = \"system.gravity_m_per_s2\"\nfrom = 9\nto = 10\ndifference = 0.01",
                  ": [sweep] quantity",
                  {"\"divergence\"", "released differently", "\"distance_at_end\""}},
    RefusedFigure{"sweep",
                  "[sweep]\nparameter = \"system.step_s\"\nfrom = 0.001\nto = 0.002\npoints = 2\n"
                  "quantity = \"parting_time\"",
                  ":8:1: [sweep] quantity",
                  {"\"parting_time\"", "let [b] differ from [a]"}},
    RefusedFigure{"map", "[map]\nquantity = \"divergence\"", ": [map] difference", {"give map.difference"}},
    RefusedFigure{
        "map", "[map]\nquantity = \"parting_time\"\ndifference = -1e-300", ":5:1: [map] difference", {"-1e-300"}},
    RefusedFigure{"curves", "[curves]\nquantity = \"distance\"", ":4:1: [curves] quantity", {"let [b] differ"}},
    RefusedFigure{"convergence",
                  "[convergence]\nmethods = [\"rk4\"]",
                  ":4:1: [convergence] methods",
                  {"the same", "let [b] differ", "\"one/other\""}},
    RefusedFigure{"fractal", "", ":2:1: [scene] kind", {"\"sweep\"", "it is \"fractal\""}}};

}  // namespace doppel
