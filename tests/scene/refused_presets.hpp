#pragma once

#include <ostream>
#include <string>
#include <vector>

// Presets with errors and their messages, for the tests of the reader and of the schema.

namespace doppel {

/// The text of presets/x.toml, and the complete message of its error.
struct RefusedPreset {
    const char *text, *message;
};

inline void PrintTo(const RefusedPreset& c, std::ostream* out) {
    *out << c.text;
}

inline const std::vector<RefusedPreset> refused_keys{
    RefusedPreset{"[system]\nlenght_m = [1, 1]",
                  R"(presets/x.toml:2:1: [system] has no "lenght_m"; did you mean "length_m"?)"},
    RefusedPreset{"titel = \"x\"", R"(presets/x.toml:1:1: a preset has no "titel"; did you mean "title"?)"},
    RefusedPreset{"[vidoe]\nfps = 3", R"(presets/x.toml:1:2: a preset has no "vidoe"; did you mean "video"?)"},
    RefusedPreset{
        "[scene]\nzzzzzzzz = 1",
        R"(presets/x.toml:2:1: [scene] has no "zzzzzzzz"; it has certify, duration_s, energy_columns, kind, member_columns, sample_hz)"},
    RefusedPreset{"scene = 3", "presets/x.toml:1:1: scene must be a table; it is a whole number (3)"},
    RefusedPreset{"[scene", "presets/x.toml:1:7: Error while parsing table header: encountered end-of-file"}};

inline const std::vector<RefusedPreset> refused_system{
    RefusedPreset{"[b]\n\nmass_kg = [1, -1]", "presets/x.toml:3:1: [b] mass_kg[1] must be > 0; it is -1"},
    RefusedPreset{"[system]\nlength_m = [0, 1]", "presets/x.toml:2:1: [system] length_m[0] must be > 0; it is 0"},
    RefusedPreset{"[a]\nangle_deg = [1, nan]", "presets/x.toml:2:1: [a] angle_deg[1] must be finite; it is nan"},
    RefusedPreset{"[system]\nomega_deg_per_s = [inf, 0]",
                  "presets/x.toml:2:1: [system] omega_deg_per_s[0] must be finite; it is inf"},
    RefusedPreset{"[system]\nangle_deg = [1, 2, 3]",
                  "presets/x.toml:2:1: [system] angle_deg must have 2 numbers, one a link; it has 3: [1, 2, 3]"},
    RefusedPreset{
        "[system]\nangle_deg = \"90\"",
        "presets/x.toml:2:1: [system] angle_deg must be a number, or an array of 2 numbers, one a link; it is a "
        "string (\"90\")"},
    RefusedPreset{"[system]\nangle_deg = [90, \"90\"]",
                  "presets/x.toml:2:1: [system] angle_deg[1] must be a number; it is a string (\"90\")"},
    RefusedPreset{
        "[system]\nangle_deg = [9223372036854775807, 1]",
        "presets/x.toml:2:1: [system] angle_deg[0] must be from -1000000 to 1000000: beyond, rounding hides the "
        "motion; it is 9223372036854775807"},
    RefusedPreset{"[system]\ngravity_m_per_s2 = 0",
                  "presets/x.toml:2:1: [system] gravity_m_per_s2 must be > 0; it is 0"},
    RefusedPreset{"[system]\ngravity_m_per_s2 = true",
                  "presets/x.toml:2:1: [system] gravity_m_per_s2 must be a number; it is a boolean (true)"},
    RefusedPreset{"[system]\nlinks = 2.0",
                  "presets/x.toml:2:1: [system] links must be a whole number; it is a decimal number (2)"},
    RefusedPreset{"[system]\nlinks = 0", "presets/x.toml:2:1: [system] links must be from 1 to 10000; it is 0"},
    RefusedPreset{
        "[system]\nmodel = \"angels\"",
        R"(presets/x.toml:2:1: [system] model must be "auto", "angles", "constraints" or "mechanism"; it is "angels"; did you mean "angles"?)"},
    RefusedPreset{
        "[system]\nintegrator = \"magic\"",
        R"(presets/x.toml:2:1: [system] integrator must be "euler", "semi-implicit-euler", "midpoint", "rk4", "dopri5", "dop853", "adams", "gauss4", "gauss6", "taylor", "rattle" or "rattle6"; it is "magic")"},
    RefusedPreset{"[system]\nintegrator = 4",
                  "presets/x.toml:2:1: [system] integrator must be a string; it is a whole number (4)"},
    RefusedPreset{"[system]\nprecision = \"half\"",
                  R"(presets/x.toml:2:1: [system] precision must be "double" or "quad"; it is "half")"},
    RefusedPreset{"[system]\nintegrator = \"taylor\"\nstep_s = 0.1",
                  R"(presets/x.toml:3:1: [system] step_s is for methods with a fixed step; "taylor" uses tolerance)"},
    RefusedPreset{"[system]\nintegrator = \"dop853\"\ntolerance = 0",
                  "presets/x.toml:3:1: [system] tolerance must be > 0; it is 0"},
    RefusedPreset{
        "[system]\nmodel = \"angles\"\nintegrator = \"rattle\"",
        R"(presets/x.toml:3:1: [system] integrator "rattle" supports constraints and mechanism, not model = "angles")"},
    RefusedPreset{"[system]\nmodel = \"constraints\"\nintegrator = \"gauss6\"",
                  R"(presets/x.toml:3:1: [system] integrator "gauss6" supports angles, not model = "constraints")"},
    RefusedPreset{"[system]\nstabilise = \"baumgarte\"\nmodel = \"angles\"",
                  "presets/x.toml:2:1: [system] stabilise is for constraints; with angles as coordinates rods have "
                  "constant length"},
    RefusedPreset{
        "[system]\nstabilise = \"projection\"\nintegrator = \"rattle6\"",
        R"(presets/x.toml:2:1: [system] stabilise is not needed with "rattle6", which keeps the constraints itself)"},
    RefusedPreset{"[system]\nstabilise_rate_per_s = 20",
                  "presets/x.toml:2:1: [system] stabilise_rate_per_s is for stabilise = \"baumgarte\"; it is \"none\""},
    RefusedPreset{"[system]\nstabilise = \"baumgarte\"\nintegrator = \"taylor\"",
                  "presets/x.toml:2:1: [system] stabilise \"baumgarte\" adds terms without a Taylor series; use "
                  "\"projection\" or another integrator than \"taylor\""},
    RefusedPreset{"[system]\njoint_coulomb_N_m = [0, 0.1]\nmodel = \"constraints\"",
                  "presets/x.toml:3:1: [system] model \"constraints\" does not support this chain: links with mass, "
                  "friction or a drive need angles"},
    RefusedPreset{
        "[system]\njoint_coulomb_N_m = [0, 0.1]\nstabilise = \"projection\"",
        "presets/x.toml:3:1: [system] stabilise is for constraints; links with mass, friction or a drive need angles"},
    RefusedPreset{
        "[system]\njoint_coulomb_N_m = [0, 0.1]\nintegrator = \"gauss4\"",
        "presets/x.toml:3:1: [system] integrator \"gauss4\" does not support Coulomb friction (joint_coulomb_N_m)"},
    RefusedPreset{"[system]\njoint_coulomb_N_m = [0, 0.1]\nintegrator = \"rattle\"",
                  "presets/x.toml:3:1: [system] integrator \"rattle\" needs model = \"constraints\"; links with mass, "
                  "friction or a drive need angles"},
    RefusedPreset{"[system]\nrod_mass_kg = [1, 1]\nmodel = \"mechanism\"",
                  "presets/x.toml:3:1: [system] model \"mechanism\" does not support this chain: links with mass, "
                  "friction or a drive need angles"},
    RefusedPreset{
        "[system]\nstabilise = \"tape\"",
        R"(presets/x.toml:2:1: [system] stabilise must be "none", "baumgarte" or "projection"; it is "tape")"},
    RefusedPreset{"[system]\ntolerance = 1e-9",
                  R"(presets/x.toml:2:1: [system] tolerance is for adaptive methods; "euler" uses step_s)"},
    RefusedPreset{
        "[system]\nstep_s = \"fast\"",
        "presets/x.toml:2:1: [system] step_s must be a number or a fraction such as \"1/30000\"; it is \"fast\""},
    RefusedPreset{"[system]\nstep_s = -0.1", "presets/x.toml:2:1: [system] step_s must be > 0; it is -0.1"},
    RefusedPreset{
        "[a.track]\nfile = \"data/double-pendulum-track/piece-00.csv\"\noffset_deg = [1e300, 0]",
        "presets/x.toml:3:1: [a.track] offset_deg[0] must be from -1000000 to 1000000: beyond, rounding hides "
        "the motion; it is 1e+300"},
    RefusedPreset{"[system.pivot]\nphase_deg = -1e7",
                  "presets/x.toml:2:1: [system.pivot] phase_deg must be from -1000000 to 1000000: beyond, rounding "
                  "hides the motion; it is -10000000"},
    RefusedPreset{"[system.pivot]\ndirection_deg = 1e7",
                  "presets/x.toml:2:1: [system.pivot] direction_deg must be from -1000000 to 1000000: beyond, rounding "
                  "hides the motion; it is 10000000"},
    RefusedPreset{"[system.pivot]\nfrequency_hz = 2",
                  "presets/x.toml:2:1: [system.pivot] frequency_hz has no effect without amplitude_m"},
    RefusedPreset{"[a.pivot]\namplitude_m = 1\n[b.pivot]\nphase_deg = 90",
                  "presets/x.toml:4:1: [b.pivot] phase_deg has no effect without amplitude_m"},
    RefusedPreset{"[[system.torque]]\nphase_deg = 1e7",
                  "presets/x.toml:2:1: [[system.torque]] 1 phase_deg must be from -1000000 to 1000000: beyond, "
                  "rounding hides the motion; it is 10000000"},
    RefusedPreset{"[system]\nstep_s = 1e-300",
                  "presets/x.toml:2:1: [system] step_s is no fraction of whole numbers up to 9.2e18; it is 1e-300"}};

inline const std::vector<RefusedPreset> refused_rates{
    RefusedPreset{
        "[scene]\nsample_hz = 7",
        "presets/x.toml:2:1: [scene] sample_hz must divide the step rate, 30000 Hz on side a; it is 7; use 6 or 8"},
    RefusedPreset{"[b]\nstep_s = \"1/100\"",
                  "presets/x.toml: [scene] sample_hz must divide the step rate, 100 Hz on side b; it is 120; use 100"},
    RefusedPreset{"[scene]\nduration_s = 0", "presets/x.toml:2:1: [scene] duration_s must be > 0; it is 0"},
    RefusedPreset{"[scene]\nduration_s = 0.01",
                  "presets/x.toml:2:1: [scene] duration_s must be a whole number of samples at 120 Hz; 0.01 s are 1.2"},
    RefusedPreset{"[scene]\nduration_s = 1e12",
                  "presets/x.toml:2:1: [scene] duration_s must be at most 100000000 samples; it is 120000000000000"},
    RefusedPreset{
        "[scene]\nkind = \"trio\"",
        R"(presets/x.toml:2:1: [scene] kind must be "pair", "grid", "series", "section" or "work-precision"; it is "trio"; did you mean "grid"?)"},
    RefusedPreset{"[video]\nspeed = 30",
                  "presets/x.toml:2:1: [video] speed times sample_hz, the frames a second without fps, must be at most "
                  "1000 and a "
                  "fraction of whole numbers up to 1000000; it is 3600; set fps"}};

inline const std::vector<RefusedPreset> refused_video{
    RefusedPreset{"[video]\nsize = [641, 360]",
                  "presets/x.toml:2:1: [video] size must be even for H.264 in yuv420p; it is [641, 360]; [642, "
                  "360] is possible"},
    RefusedPreset{"[video]\nsize = [0, 100]",
                  "presets/x.toml:2:1: [video] size[0] must be from 64 to 16384 px; it is 0"},
    RefusedPreset{
        "[video]\nformat = \"avi\"",
        R"(presets/x.toml:2:1: [video] format must be "mp4", "webm", "gif", "apng", "png", "html", "y4m" or "rgb"; it is "avi")"},
    RefusedPreset{"[video]\ncrf = 60", "presets/x.toml:2:1: [video] crf must be from 0 to 51; it is 60"},
    RefusedPreset{
        "[video]\ntheme = \"drak\"",
        R"(presets/x.toml:2:1: [video] theme must be "dark", "light" or "high-contrast"; it is "drak"; did you mean "dark"?)"},
    RefusedPreset{
        "[video]\npreset = \"quick\"",
        R"(presets/x.toml:2:1: [video] preset must be "doppel", "ultrafast", "superfast", "veryfast", "faster", "fast", "medium", "slow", "slower" or "veryslow"; it is "quick")"},
    RefusedPreset{
        "[video]\nside_colors = [\"red\", \"#0000ff\"]",
        R"(presets/x.toml:2:1: [video] side_colors[0] must be a colour such as "#ff9f40"; it is a string ("red"))"},
    RefusedPreset{"[video]\nside_colors = [\"#0000ff\"]",
                  "presets/x.toml:2:1: [video] side_colors must have 2 colours, a and b; it has 1: [\"#0000ff\"]"},
    RefusedPreset{
        "[video]\nside_colors = [1, 2]",
        "presets/x.toml:2:1: [video] side_colors[0] must be a colour such as \"#ff9f40\"; it is a whole number (1)"},
    RefusedPreset{
        "[video]\npanels = []",
        R"(presets/x.toml:2:1: [video] panels must contain at least one of "pendulums", "distance", "exponent", "energy", "rod-error", "rod-force", "energies-a", "energies-b", "angles", "rates" or "total-energy")"},
    RefusedPreset{
        "[video]\npanels = [\"phase\"]",
        R"(presets/x.toml:2:1: [video] panels[0] must be "pendulums", "distance", "exponent", "energy", "rod-error", "rod-force", "energies-a", "energies-b", "angles", "rates" or "total-energy"; it is "phase")"},
    RefusedPreset{"[video]\npanels = \"energy\"",
                  "presets/x.toml:2:1: [video] panels must be an array of strings; it is a string (\"energy\")"},
    RefusedPreset{"[video]\ntrail_s = -1",
                  "presets/x.toml:2:1: [video] trail_s must be from 0 (none) to 3600; it is -1"},
    RefusedPreset{"[video]\npanels = [\"distance\"]\nenergy_range = [1, 10]",
                  "presets/x.toml:3:1: [video] energy_range is for \"energy\", which panels does not contain"},
    RefusedPreset{"[video]\ndistance_range = [1, 2]",
                  "presets/x.toml:2:1: [video] distance_range must increase by 1 to 60 powers of ten; it is [1, 2]"}};

// The text is that of [video]; the message continues after the key's line and column and "[video] ".

inline const std::vector<RefusedPreset> refused_video_keys{
    RefusedPreset{
        "layout = \"fan\"",
        R"([video] layout must be "side-by-side", "overlay", "ensemble", "phase", "portrait" or "single"; it is "fan")"},
    RefusedPreset{"members = 5", R"([video] members is for the layout "ensemble"; it is "side-by-side")"},
    RefusedPreset{"members = 1\nlayout = \"ensemble\"", "[video] members must be from 2 to 1000; it is 1"},
    RefusedPreset{"phase = \"section\"\nlayout = \"phase\"\nphase_link = 1",
                  "[video] phase \"section\" is where link 1 passes 0 upwards, so it needs phase_link from 2 on"},
    RefusedPreset{"phase_link = 3\nlayout = \"phase\"",
                  "[video] phase_link must be from 1 to 2, as there are links; it is 3"},
    RefusedPreset{
        "panels = [\"distnce\"]",
        R"([video] panels[0] must be "pendulums", "distance", "exponent", "energy", "rod-error", "rod-force", "energies-a", "energies-b", "angles", "rates" or "total-energy"; it is "distnce"; did you mean "distance"?)"},
    RefusedPreset{"panels = [\"distance\"]\nlayout = \"overlay\"",
                  R"([video] panels must contain "pendulums" for the layout "overlay")"},
    RefusedPreset{"exponent_range = [1, 1]\npanels = [\"exponent\"]",
                  "[video] exponent_range must increase; it is [1, 1]"},
    RefusedPreset{"size = [1280, 720]\nlayout = \"portrait\"",
                  R"([video] size must be higher than wide for the layout "portrait"; it is [1280, 720])"},
    RefusedPreset{"size = [301, 200]",
                  "[video] size must be even for H.264 in yuv420p; it is [301, 200]; [302, 200] is possible"},
    RefusedPreset{"size = [16384, 16384]",
                  "[video] size exceeds what libav encodes as H.264; it is [16384, 16384]; [16254, 16254] is possible, "
                  "and [8192, 4352] for players limited to level 6.2 of H.264"},
    RefusedPreset{
        "transparent = true\nformat = \"webm\"\ncodec = \"av1\"",
        R"([video] transparent needs a format with opacity: png, apng, html, rgb, or webm (VP9, yuv420p); the codec is "av1")"},
    RefusedPreset{
        "transparent = true\nformat = \"webm\"\npixel_format = \"yuv444p\"",
        R"([video] transparent needs a format with opacity: png, apng, html, rgb, or webm (VP9, yuv420p); the pixel_format is "yuv444p")"},
    RefusedPreset{
        "fps = 60\nformat = \"gif\"",
        "[video] fps must be at most 50, as a frame of a GIF takes 2 to 65535 hundredths of a second; it is 60"},
    RefusedPreset{"codec = \"av1\"", R"([video] codec is a choice of webm; the format is "mp4")"},
    RefusedPreset{"pixel_format = \"yuv444p\"\nformat = \"gif\"",
                  R"([video] pixel_format is of mp4, webm and y4m; the format is "gif")"},
    RefusedPreset{"crf = 20\nformat = \"png\"", R"([video] crf is of mp4 and webm; the format is "png")"},
    RefusedPreset{"preset = \"slow\"\nformat = \"apng\"", R"([video] preset is of mp4 and webm; the format is "apng")"},
    RefusedPreset{
        "transparent = true",
        R"([video] transparent needs a format with opacity: png, apng, html, rgb, or webm (VP9, yuv420p); the format is "mp4")"},
    RefusedPreset{"poster_s = 30.001", "[video] poster_s must be up to 30 s; it is 30.001"},
    RefusedPreset{"contact_sheet = [0, 4]", "[video] contact_sheet[0] must be from 1 to 32; it is 0"},
    RefusedPreset{"contact_sheet = [4, 33]", "[video] contact_sheet[1] must be from 1 to 32; it is 33"},
    RefusedPreset{"hold_end_s = -1", "[video] hold_end_s must be ≥ 0; it is -1"},
    RefusedPreset{"title_card_s = 4000", "[video] title_card_s must be from 0 (none) to 3600; it is 4000"},
    RefusedPreset{
        "members = [[1, 2]]\nlayout = \"ensemble\"",
        "[video] members must be a whole number, or 2 to 8 lists of angles or tables; it is an array ([[1, 2]])"},
    RefusedPreset{"members = [[1, 2], 3]\nlayout = \"ensemble\"",
                  "[video] members must be a whole number, or 2 to 8 lists of angles or tables; 3 is a whole number"},
    RefusedPreset{"members = [[1, 2], [3]]\nlayout = \"ensemble\"",
                  "[video] members must have 2 numbers each, one a link; angle_deg of [1] has 1"},
    RefusedPreset{
        "members = [[1, 2], [3, 4]]\nlayout = \"ensemble\"\n[b]\nangle_deg = [5, 6]",
        "[video] members must begin with side a and end with side b; [b] angle_deg is [5, 6], the member's [3, "
        "4]"},
    RefusedPreset{"glow_px = -1", "[video] glow_px must be from 0 (none) to 100; it is -1"},
    RefusedPreset{"glow_px = 2\nlayout = \"ensemble\"",
                  R"([video] glow_px must be 0 for the layout "ensemble", whose trails do not glow; it is 2)"},
    RefusedPreset{"trail_s = nan", "[video] trail_s must be finite; it is nan"},
    RefusedPreset{"theme = \"drak\"",
                  R"([video] theme must be "dark", "light" or "high-contrast"; it is "drak"; did you mean "dark"?)"},
    RefusedPreset{"colors.backgruond = \"#000000\"",
                  R"([video.colors] has no "backgruond"; did you mean "background"?)"},
    RefusedPreset{"colors.background = 3",
                  "[video.colors] background must be a colour such as \"#ff9f40\"; it is a whole number (3)"},
    RefusedPreset{
        "show = [\"titel\"]",
        R"([video] show[0] must be "title", "subtitle", "clock", "labels", "credit", "rods", "bobs", "circle" or "twin"; it is "titel"; did you mean "title"?)"},
    RefusedPreset{"fps = 1001",
                  "[video] fps must be at most 1000 and a fraction of whole numbers up to 1000000; it is 1001"},
    RefusedPreset{
        "fps = \"24000001/1001\"",
        "[video] fps must be at most 1000 and a fraction of whole numbers up to 1000000; it is 24000001/1001"},
    RefusedPreset{"speed = []",
                  "[video] speed must be a speed, or times, s, with speeds such as [[0, 1], [6.8, 0.25]]; it is []"},
    RefusedPreset{"speed = [[0, 1, 2]]",
                  "[video] speed must be a speed, or times, s, with speeds such as [[0, 1], [6.8, 0.25]]; [0, 1, 2] is "
                  "none"},
    RefusedPreset{"speed = [[0, 0]]", "[video] speed must be from 0.001 to 1000; it is 0"},
    RefusedPreset{"speed = [[1, 1]]", "[video] speed must begin at 0 s; it begins at 1 s"},
    RefusedPreset{"speed = [[0, 1], [40, 2]]",
                  "[video] speed must have increasing times, up to 30 s; 40 s comes after 0 s"},
    RefusedPreset{"speed = [[0, 1], [5, 1e-9]]", "[video] speed must be from 0.001 to 1000; it is 1e-09"},
    RefusedPreset{"speed_ease_s = 1",
                  "[video] speed_ease_s is for a speed that changes, such as speed = [[0, 1], [6.8, 0.25]]"},
    RefusedPreset{"widths_px.trail = 1000", "[video.widths_px] trail must be from 0 (nothing) to 200 px; it is 1000"},
    RefusedPreset{"fonts_px.title = 1", "[video.fonts_px] title must be from 4 to 400 px; it is 1"}};

}  // namespace doppel
