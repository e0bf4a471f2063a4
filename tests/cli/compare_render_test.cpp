// compare --render: draws and compares in one call. Variants of goldens.
#include "cli/pictures.hpp"
#include "cli/xml.hpp"

#include <fmt/format.h>

namespace doppel::compare_render_test {

namespace fs = std::filesystem;
using namespace test;

/// The frames 0 to 2 of a film are golden; `render` is `compare --render` of it.
class CompareRender : public ProgramTest {
protected:
    void SetUp() override {
        const auto made = render("--frames 0:3 --update");
        ASSERT_EQ(made.code, 0) << made.err;
        EXPECT_EQ(made.out,
                  "golden/000000.png: new\ngolden/000001.png: new\ngolden/000002.png: new\n"
                  "0 of 3 pictures differ\n");
    }

    Outcome run(const Words& arguments, const char* ci = nullptr) const {
        return doppel(arguments, [&] { ci ? setenv("CI", ci, 1) : unsetenv("CI"); });
    }
    Outcome render(const Words& more, const char* ci = nullptr) const {
        return run(with("compare --render calm golden --set scene.duration_s=0.1 --size 160x90", more), ci);
    }
    fs::path golden(const std::string& name) const { return folder / "golden" / name; }
};

TEST_F(CompareRender, DrawsTheFramesWhoseNumbersAreGolden) {
    // the pictures are those of render, also alone and with a card before them
    const Words card = "--set video.title_card_s=0.05";
    ASSERT_EQ(run(with("render calm --set scene.duration_s=0.1 --size 160x90 --format png", card)).code, 0);
    for (const char* name : {"000000.png", "000001.png", "000002.png"}) fs::remove(golden(name));
    for (const char* name : {"000003.png", "000007.png", "000018.png"})
        fs::copy(folder / "out/calm/frames" / name, golden(name));
    fs::remove_all(folder / "out");
    const auto same = render(card);
    EXPECT_EQ(same.code, 0) << same.err;
    EXPECT_EQ(same.out, "0 of 3 pictures differ\n");
    EXPECT_FALSE(fs::exists(folder / "out"));

    fs::copy(golden("000007.png"), golden("000099.png"));
    fs::copy(golden("000007.png"), golden("notes.png"));
    const auto beyond = render(card);
    EXPECT_EQ(beyond.code, 1);
    EXPECT_EQ(beyond.out,
              "golden/000099.png: there is no such frame\ngolden/notes.png: there is no such frame\n"
              "2 of 5 pictures differ\n");
}

TEST_F(CompareRender, KeepsWhatDiffersAndUpdatesOnlyThat) {
    const auto good = bytes_of(golden("000001.png"));
    spoil(golden("000001.png"));
    spoil(golden("000002.png"), 1);  // passes
    const auto faint = bytes_of(golden("000002.png"));
    const auto differs = render("--junit report.xml --html report.html");
    EXPECT_EQ(differs.code, 1);
    EXPECT_TRUE(
        differs.out.starts_with("out/calm/compare/000001.actual.png: differs from golden/000001.png: 40 pixels "))
        << differs.out;
    EXPECT_TRUE(
        differs.out.ends_with("; expected, actual and difference ×16: out/calm/compare/000001.diff.png\n"
                              "1 of 3 pictures differ\n"))
        << differs.out;
    EXPECT_EQ(bytes_of(folder / "out/calm/compare/000001.actual.png"), good);
    const auto junit = document_of(bytes_of(folder / "report.xml"));
    EXPECT_EQ(junit["tests"] + junit["failures"], "31");
    EXPECT_EQ(document_of(bytes_of(folder / "report.html")).all("img").size(), 3u);

    const auto spoilt = bytes_of(golden("000001.png"));
    const auto refused = render("--update", "true");
    EXPECT_EQ(refused.code, 2);
    EXPECT_TRUE(has(refused.err, "not by CI; CI is set to \"true\""));
    EXPECT_EQ(bytes_of(golden("000001.png")), spoilt);
    const auto updated = render("--update", "false");
    EXPECT_EQ(updated.code, 0) << updated.err;
    EXPECT_EQ(updated.out, "golden/000001.png: updated\n0 of 3 pictures differ\n");
    EXPECT_EQ(bytes_of(golden("000001.png")), good);
    EXPECT_EQ(bytes_of(golden("000002.png")), faint);
    EXPECT_EQ(render({}).code, 0);
    EXPECT_EQ(listing(folder / "out/calm/compare"), Names{});
}

TEST_F(CompareRender, UpdatesNoPictureOfOthers) {
    write_png(golden("000001.png"), Picture({160, 90}), {.metadata = {}});
    const auto mine = bytes_of(golden("000001.png"));
    fs::rename(golden("000002.png"), folder / "elsewhere.png");
    write_png(folder / "elsewhere.png", Picture({160, 90}), {.metadata = {{"encoder", "Doppel 1"}}});
    fs::create_symlink("../elsewhere.png", golden("000002.png"));
    const auto refused = render("--update");
    EXPECT_EQ(refused.code, 4);
    for (const char* name : {"golden/000001.png", "golden/000002.png"})
        EXPECT_TRUE(has(refused.out, fmt::format("{} is no PNG of Doppel", name)));
    EXPECT_EQ(bytes_of(golden("000001.png")), mine);
    EXPECT_TRUE(fs::is_symlink(golden("000002.png")));
}

TEST_F(CompareRender, PassesIfAnyVariantMatches) {
    fs::copy(golden("000001.png"), golden("000001.egl.png"));
    spoil(golden("000001.png"));
    fs::rename(golden("000002.png"), golden("000002.egl.png"));
    const auto passes = render("--junit report.xml --html report.html");
    EXPECT_EQ(passes.code, 0) << passes.err;
    EXPECT_EQ(passes.out,
              "000001.png: matches golden/000001.egl.png\n000002.png: matches golden/000002.egl.png\n"
              "0 of 3 pictures differ\n");
    for (const char* report : {"report.xml", "report.html"})
        EXPECT_TRUE(has(bytes_of(folder / report), "000001.png: matches golden/000001.egl.png"));

    // the same with folders
    ASSERT_EQ(run("render calm --set scene.duration_s=0.1 --size 160x90 --format png --frames 0:3").code, 0);
    const auto folders = run("compare golden out/calm/frames");
    EXPECT_EQ(folders.code, 0) << folders.out;
    EXPECT_EQ(folders.out, passes.out);

    auto far = read_png(golden("000001.egl.png"));
    spoil(golden("000001.egl.png"), 255);
    for (int y = 30; y < 60; ++y) far.at(50, y)[1] ^= 128;
    write_png(golden("000001.far.png"), far);
    for (const auto& command : {Words{"compare", "golden", "out/calm/frames"}, Words()}) {
        const auto differs = command.empty() ? render({}) : run(command);
        EXPECT_EQ(differs.code, 1);
        EXPECT_TRUE(has(differs.out, "differs from golden/000001.far.png, the nearest of 3: 30 pixels"));
    }
    EXPECT_TRUE(has(render("--update").out, "golden/000001.png: updated; golden/000001.egl.png stays as it was; "));
}

TEST_F(CompareRender, ComparesStillsAndFigures) {
    const Words brief = "--set scene.duration_s=0.5";
    fs::create_directory(folder / "kept");
    for (const auto& [command, name] :
         {std::pair(with("compare --render calm --at 0.25 --size 160x90", brief), "calm.0.25s.png"),
          {with("compare --render fig6 --size 320x180", brief), "fig6.png"}}) {
        const auto file = fmt::format("kept/{}", name);
        const auto none = run(with(command, "kept"));
        EXPECT_EQ(none.code, 1) << none.err;
        EXPECT_EQ(run(with(command, "kept --update")).out, file + ": new\n");
        EXPECT_EQ(run(with(command, "kept")).code, 0);
        fs::rename(folder / file, folder / "kept/other.png");
        const auto missing = run(with(command, "kept --junit missing.xml"));
        EXPECT_EQ(missing.code, 1) << missing.err;
        const auto drawn = fmt::format("out/{}/compare/{}.actual.png", command[2], fs::path(name).stem().string());
        EXPECT_EQ(missing.out, fmt::format("{}: missing; drawn now: {}; --update makes it the golden\n", file, drawn));
        EXPECT_TRUE(fs::exists(folder / drawn) && fs::exists(folder / "missing.xml"));
        EXPECT_EQ(run(with(command, "kept/other.png")).code, 0);
        fs::rename(folder / "kept/other.png", folder / "kept/other.egl.png");
        EXPECT_EQ(run(with(command, "kept/other.png")).code, 0);  // a variant alone
        fs::rename(folder / "kept/other.egl.png", folder / "kept/other.png");
        spoil(folder / "kept/other.png");
        EXPECT_EQ(run(with(command, "kept/other.png")).code, 1);
        fs::remove(folder / "kept/other.png");
    }
    EXPECT_TRUE(fs::exists(folder / "out/calm/compare/other.actual.png"));
    EXPECT_TRUE(fs::exists(folder / "out/fig6/compare/other.diff.png"));
}

TEST_F(CompareRender, RefusesWhatMakesNoSense) {
    for (const auto& [arguments, words] : std::vector<std::pair<Words, std::string>>{
             {"compare golden", "compare needs EXPECTED and ACTUAL, or --render PRESET and EXPECTED"},
             {"compare golden golden --render calm", "compare needs EXPECTED and ACTUAL, or --render"},
             {"compare golden golden --update", "--update requires --render"},
             {"compare --render calm golden --at 1 --frames 0:1", "--at excludes --frames"},
             {"compare --render fig6 golden --at 1", "--at and --frames are for films; fig6 is a"},
             {"compare --render calm golden --at 1000", "--at 1000: calm ends at"},
             {"compare --render calm golden --frames 0:99999", "--frames 0:99999: calm has the"},
             {"compare --render calm none", "none: there is no golden frame such as 000000.png"},
             {"compare --render calm golden/000000.png", "golden/000000.png is a picture; give its time with"}})
        expect_refused(arguments, 2, words);
    EXPECT_EQ(run("compare golden golden --junit a.xml --html b.html --list-outputs").out, "a.xml\nb.html\n");
}

}  // namespace doppel::compare_render_test
