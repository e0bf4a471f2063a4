#include "cli/process.hpp"
#include "cli/xml.hpp"
#include "output/png.hpp"

#include <fstream>

namespace doppel {
namespace golden_script_test {

namespace fs = std::filesystem;
using test::bytes_of;
using test::shell;

/// The script that the GitHub action runs, with the same variables.
TEST(GoldenScript, DrawsComparesAndReportsFilmsAndFigures) {
    const auto folder = test::fresh_folder();
    const auto run = [&](const std::string& more) {
        return shell(folder,
                     "export PROGRAM=\"$DOPPEL\" GOLDEN=golden OUT='drawn here' FRAMES=0:2 SIZE=160x90 "
                     "GITHUB_STEP_SUMMARY=summary SETS='scene.duration_s=0.5\n  video.layout=\"overlay\"\n' " +
                         more + "; '" DOPPEL_SOURCE_DIR "/.ci/golden'");
    };
    const auto film = run("PRESETS='\n  calm '");
    EXPECT_EQ(film.code, 2) << film.err;  // there is no golden yet
    fs::create_directories(folder / "golden");
    fs::copy(folder / "drawn here/actual/calm/frames", folder / "golden/calm");
    EXPECT_EQ(run("PRESETS=calm").code, 0);

    auto picture = read_png(folder / "golden/calm/000001.png");
    for (int x = 0; x < 40; ++x) picture.at(10 + x, 20)[0] ^= 64;
    write_png(folder / "golden/calm/000001.png", picture);
    EXPECT_EQ(run("PRESETS=calm").code, 1);
    EXPECT_TRUE(fs::exists(folder / "drawn here/calm.html"));
    EXPECT_TRUE(fs::exists(folder / "drawn here/calm/compare/000001.diff.png"));
    const auto junit = test::XmlReader(bytes_of(folder / "drawn here/calm.xml")).document();
    EXPECT_EQ(junit["tests"] + junit["failures"], "21");

    // the layout is no key of a figure; without it, the figure is drawn
    EXPECT_EQ(run("PRESETS=calm FIGURES=fig6").code, 2);
    EXPECT_EQ(run("FIGURES=fig6 SETS=scene.duration_s=0.5").code, 2);
    fs::copy(folder / "drawn here/actual/fig6/fig6.png", folder / "golden/fig6.png");
    EXPECT_EQ(run("FIGURES=fig6 SETS=scene.duration_s=0.5").code, 0);
    const auto summary = bytes_of(folder / "summary");
    for (const char* line : {"| calm | passes |", "| calm | differs |", "| fig6 | failed (exit code 2) |"})
        EXPECT_NE(summary.find(line), std::string::npos) << summary;
}

}  // namespace golden_script_test
}  // namespace doppel
