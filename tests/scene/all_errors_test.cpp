#include "scene/support.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace doppel::all_errors_test {

using Lines = std::vector<std::string>;

/// The messages about the preset, without the path.
Lines faults_of(const std::string& text, const std::vector<std::string>& arguments = {}) {
    try {
        preset_from(text, arguments);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::bad_input);
        Lines lines{error.what()};
        lines.insert(lines.end(), error.further().begin(), error.further().end());
        for (auto& line : lines)
            if (line.starts_with("x.toml:")) line.erase(0, 7);
        return lines;
    }
    return {};
}

Lines starts(Lines lines, std::size_t letters) {
    for (auto& line : lines) line = line.substr(0, letters);
    return lines;
}

TEST(AllErrors, AreInTheOrderOfFileAndThenCommandLine) {
    const auto errors = faults_of(R"([video]
fps = -2
theme = "blue"
sise = [64, 64]
crf = 99
[b]
angle_deg = "level"
[scene]
duration_s = [3]
[system]
gravity_m_per_s2 = -1
mas_kg = 3
)",
                                  {"video.hold_end_s=-1", "a.lable=\"x\"", "video.fps=\"fast\""});
    const Lines expected{
        R"(3:1: [video] theme must be "dark", "light" or "high-contrast"; it is "blue")",
        R"(4:1: [video] has no "sise"; did you mean "size"?)",
        "5:1: [video] crf must be from 0 to 51; it is 99",
        R"(7:1: [b] angle_deg must be a number, or an array of 2 numbers, one a link; it is a string ("level"))",
        "9:1: [scene] duration_s must be a number; it is an array ([3])",
        "11:1: [system] gravity_m_per_s2 must be > 0; it is -1",
        R"(12:1: [system] has no "mas_kg"; did you mean "mass_kg"?)",
        R"(--set a.lable: [a] has no "lable"; did you mean "label"?)",
        R"(--set video.fps: [video] fps must be a number or a fraction such as "1/30000"; it is "fast")",
        "--set video.hold_end_s: [video] hold_end_s must be ≥ 0; it is -1"};
    EXPECT_EQ(errors, expected);
}

/// Only one error is reported: the other may be its consequence.
TEST(AllErrors, OmitErrorsThatAnotherMayCause) {
    const auto alone = [](const std::string& text) {
        const auto errors = faults_of(text);
        EXPECT_EQ(errors.size(), 1u) << text << testing::PrintToString(errors);
        return errors.empty() ? "" : errors.front();
    };
    EXPECT_EQ(alone("[system]\nlinks = \"3\"\nmass_kg = [1, 2, 3]").substr(0, 19), "2:1: [system] links");
    EXPECT_EQ(alone("[system]\nlinsk = 3\nmass_kg = [1, 2, 3]").substr(0, 17), "2:1: [system] has");
    EXPECT_EQ(alone("[systm]\nlinks = 3\n[a]\nmass_kg = [1, 2, 3]").substr(0, 17), "1:2: a preset has");
    EXPECT_EQ(alone("[system]\nintegrator = \"dop583\"\ntolerance = 1e-9").substr(0, 24), "2:1: [system] integrator");
    EXPECT_EQ(alone("[video]\nformat = \"webn\"\ncodec = \"av1\"\ncrf = 60").substr(0, 19), "2:1: [video] format");
    EXPECT_EQ(alone("[video]\nsize = [641, 360]\nfps = \"x\"\n").substr(0, 16), "3:1: [video] fps");
    EXPECT_EQ(alone("[video]\nfps = \"x\"\n[scene]\nsample_hz = 7").substr(0, 16), "2:1: [video] fps");
    EXPECT_EQ(alone("[scene]\nkind = \"film\"\n[series]\nx = 1").substr(0, 17), "2:1: [scene] kind");
    EXPECT_EQ(alone("[[system.force]]\nkind = \"sprng\"\nstiffness_N_per_m = 3\nfrom = [0, 0]").substr(0, 26),
              "2:1: [[system.force]] 1 ki");
    EXPECT_EQ(alone("[[system.forces]]\nkind = \"spring\"\n[a]\ngravity_m_per_s2 = 0").substr(0, 17),
              "1:10: [system] ha");
    EXPECT_EQ(alone("[video.fonts]\ntext = 3\n[a]\nlabel = \"\xd8\xa7\"").substr(0, 23), "2:1: [video.fonts] text");
}

/// The key that decides is correct, so its value is used. Of two incompatible keys, either may be wrong.
TEST(AllErrors, IncludeErrorsOfSeveralKeys) {
    EXPECT_EQ(starts(faults_of("[system]\nlinks = 3\nmass_kg = [1, 2]\nfoo = 1\nlength_m = [1]"), 20),
              (Lines{"3:1: [system] mass_k", "4:1: [system] has no"}));
    EXPECT_EQ(starts(faults_of("[video]\nformat = \"mp4\"\ncrf = 60\ncodec = \"av1\"\nfps = 0"), 18),
              (Lines{"4:1: [video] codec", "5:1: [video] fps m"}));
    EXPECT_EQ(starts(faults_of("[system]\nmodel = \"angles\"\nintegrator = \"rattle\"\n[video]\nfps = 0"), 24),
              (Lines{"3:1: [system] integrator", "5:1: [video] fps must be"}));
    EXPECT_EQ(starts(faults_of("[a]\nlinks = 0\n[video]\nsize = [641, 360]"), 16),
              (Lines{"2:1: [a] links m", "4:1: [video] siz"}));
}

/// An element of a list that cannot be read is no unknown key.
TEST(AllErrors, OfAnElementAreOfItsValue) {
    EXPECT_EQ(faults_of("", {"system.model[0]=5"}),
              Lines{"--set system.model[0]: [system] model[0] is not an element of a list of numbers"});
    EXPECT_EQ(faults_of("[a]\nlabel = 3", {"a.label[1]=\"x\""}).size(), 1u);
}

TEST(AllErrors, AreReportedOnceAndAtMostTwenty) {
    std::string text = "[video]\n";
    for (int i = 0; i < 23; ++i) text += "key" + std::to_string(i) + " = 1\n";
    const auto errors = faults_of(text + "size = 3\n[video.fonts]\ntext = 1\n");
    ASSERT_EQ(errors.size(), 21u);
    EXPECT_TRUE(errors[0].starts_with("2:1: [video] has no \"key0\"")) << errors[0];
    EXPECT_TRUE(errors[19].starts_with("21:1: [video] has no \"key19\"")) << errors[19];
    EXPECT_EQ(errors[20], "and 5 more");
    EXPECT_EQ(faults_of("[video.fonts]\ntext = 1\n").size(), 1u);
}

}  // namespace doppel::all_errors_test
