#include "cli/pictures.hpp"
#include "cli/xml.hpp"

#include <fstream>
#include <map>
#include <regex>

namespace doppel::golden_script_test {

namespace fs = std::filesystem;
using namespace test;
using GoldenScript = ProgramTest;

/// The script that the GitHub action runs, with the same variables.
TEST_F(GoldenScript, DrawsComparesAndReportsFilmsAndFigures) {
    const auto run = [&](const std::string& more) {
        return shell(
            "export PROGRAM=\"$DOPPEL\" GOLDEN=golden OUT='drawn here' FRAMES=0:2 SIZE=160x90 "
            "GITHUB_STEP_SUMMARY=summary FILM_SETS='scene.duration_s=0.5\n  video.layout=\"overlay\"\n' "
            "FIGURE_SETS=scene.duration_s=0.5 " +
            more + "; '" DOPPEL_SOURCE_DIR "/.ci/golden'");
    };
    const auto film = run("PRESETS='\n  calm '");
    EXPECT_EQ(film.code, 1) << film.err;  // there is no golden picture yet
    EXPECT_TRUE(fs::exists(folder / "drawn here/calm/compare/000001.actual.png"));
    const auto update = [&](const std::string& arguments) {
        const auto made = shell(
            "unset CI; \"$DOPPEL\" compare --update --size 160x90 --set scene.duration_s=0.5 --render " + arguments);
        EXPECT_EQ(made.code, 0) << made.err;
    };
    update("calm golden/calm --frames 0:2 --set video.layout=overlay");
    EXPECT_EQ(run("PRESETS=calm").code, 0);

    spoil(folder / "golden/calm/000001.png");
    EXPECT_EQ(run("PRESETS=calm").code, 1);
    EXPECT_TRUE(fs::exists(folder / "drawn here/calm.html"));
    EXPECT_TRUE(fs::exists(folder / "drawn here/calm/compare/000001.diff.png"));
    const auto junit = document_of(bytes_of(folder / "drawn here/calm.xml"));
    EXPECT_EQ(junit["tests"] + junit["failures"], "21");

    EXPECT_EQ(run("FIGURES=fig6 FIGURE_SETS='video.layout=\"overlay\"'").code, 2);  // not a key of a figure
    EXPECT_EQ(run("FIGURES=fig6").code, 1);
    EXPECT_TRUE(fs::exists(folder / "drawn here/fig6/compare/fig6.actual.png"));
    update("fig6 golden");
    EXPECT_EQ(run("PRESETS=calm FIGURES=fig6").code, 1);  // only the film differs
    const auto summary = bytes_of(folder / "summary");
    EXPECT_TRUE(has(
        summary, {"| calm | passes |", "| calm | differs |", "| fig6 | failed (exit code 2) |", "| fig6 | passes |"}));
}

/// The first and second group of `pattern` for each match.
std::map<std::string, std::string> pairs_in(const std::string& text, const std::regex& pattern) {
    std::map<std::string, std::string> found;
    for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match)
        found.emplace((*match)[1], (*match)[2]);
    return found;
}

TEST_F(GoldenScript, TheExampleOfTheDocumentationPasses) {
    const fs::path source(DOPPEL_SOURCE_DIR);
    const auto page = bytes_of(source / "docs/ci.md"), action = bytes_of(source / "action.yml");
    const auto example =
        page.substr(page.find("```yaml"), page.find("```\n", page.find("```yaml")) - page.find("```yaml"));
    const auto given = pairs_in(example, std::regex("    ([a-z-]+): \"?([^\" \n]+)"));
    const auto defaults =
        pairs_in(action, std::regex("  ([a-z-]+):\n    description: [^\n]*\n    default: ([^\n\"]*)"));
    std::string variables;
    for (const auto& [variable, input] : pairs_in(action, std::regex("([A-Z_]+): \\$\\{\\{ inputs.([a-z-]+) \\}\\}"))) {
        const auto value = given.contains(input) ? given.at(input) : defaults.contains(input) ? defaults.at(input) : "";
        variables += " " + variable + "='" + value + "'";
    }
    ASSERT_EQ(given.size(), 6u) << example;
    fresh_folder();  // empties it
    const auto after = page.find("```sh", page.find("The goldens are"));
    const auto commands = page.substr(after + 5, page.find("```\n", after) - after - 5);
    const auto made = shell(
        "set -e; unset CI; doppel() { \"$DOPPEL\" \"$@\"; }; mkdir presets; "
        "doppel init presets/mine.toml" +
        commands);
    ASSERT_EQ(made.code, 0) << made.err;
    const auto result = shell("export PROGRAM=\"$DOPPEL\"" + variables + "; '" DOPPEL_SOURCE_DIR "/.ci/golden'");
    EXPECT_EQ(result.code, 0) << variables << result.out << result.err;
    EXPECT_TRUE(fs::exists(folder / "doppel-golden/fig6.html") && fs::exists(folder / "doppel-golden/mine.html"));
}

TEST_F(GoldenScript, ReportsWhatItCannotDraw) {
    // a replacement for the program that draws nothing, prints its arguments and reads its input
    write_bytes(folder / "draws", "#!/bin/sh\ncat\necho \"ran $*\" | cut -d' ' -f 1-5\n");
    write_bytes(folder / "fails", "#!/bin/sh\nexit 1\n");
    for (const char* program : {"draws", "fails"}) fs::permissions(folder / program, fs::perms::owner_all);
    const auto run = [&](const std::string& more) {
        return shell("export PROGRAM=./draws GOLDEN=golden OUT=drawn FRAMES=0:2 SIZE= GITHUB_STEP_SUMMARY=summary " +
                     more + "; '" DOPPEL_SOURCE_DIR "/.ci/golden'");
    };
    struct Case {
        const char* variables;
        int code;
        const char *err, *out;
    };
    for (const auto& [variables, code, err, out] :
         {Case{"PRESETS=' '", 2, "golden: PRESETS and FIGURES: there is nothing to draw", ""},
          {"GOLDEN= PRESETS=calm", 2, "golden: GOLDEN: is empty", ""},
          {"OUT=-x PRESETS=calm", 2, "golden: OUT: begins with \"-\"", ""},
          {"FRAMES= PRESETS=calm", 2, "golden: FRAMES: is empty", ""},
          {"PRESETS='--help\ncalm'", 2, "golden: --help: is no preset", "ran compare --render calm golden/calm\n"},
          {"PRESETS='a/x.toml\nb/x.toml\ncalm'", 2, "golden: b/x.toml: has the name of a/x.toml",
           "ran compare --render a/x.toml golden/x\nran compare --render calm golden/calm\n"},
          {"PRESETS=a/x.toml FIGURES=b/x.toml", 2, "golden: b/x.toml: has the name of a/x.toml",
           "ran compare --render a/x.toml golden/x\n"},
          {"PROGRAM=./fails PRESETS=calm", 4, "golden: calm: exit code 1 without a report", ""},
          {"PROGRAM=./none PRESETS=calm", 127, "none", ""},
          {"PRESETS='one\ntwo' FIGURES=three", 0, "",
           "ran compare --render one golden/one\nran compare --render two golden/two\n"
           "ran compare --render three golden/three.png\n"}}) {
        const auto outcome = run(variables);
        EXPECT_EQ(outcome.code, code) << variables << outcome.err;
        EXPECT_TRUE(has(outcome.err, err)) << variables;
        EXPECT_EQ(outcome.out, out) << variables;
    }
    const auto summary = bytes_of(folder / "summary");
    EXPECT_TRUE(has(summary, {"| PRESETS and FIGURES | there is nothing to draw", "| calm | failed (exit code 4) |"}));
}

}  // namespace doppel::golden_script_test
