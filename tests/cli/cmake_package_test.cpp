#include "cli/pictures.hpp"
#include "cli/xml.hpp"

#include <fmt/format.h>

#include <fstream>

namespace doppel::cmake_package_test {

namespace fs = std::filesystem;
using namespace test;

constexpr const char* project = R"(cmake_minimum_required(VERSION 3.21)
project(sample NONE)
enable_testing()
find_package(doppel REQUIRED)
doppel_add_golden_test(NAME swing PRESET mine.toml FRAMES 0:2 SIZE 160x90 GOLDEN golden
                       SET scene.duration_s=0.1 "video.layout=\"overlay\"")
doppel_add_golden_test(NAME chart PRESET fig6 FIGURE SIZE 160x90 GOLDEN charts SET scene.duration_s=0.5)
)";

/// A user's project with an installed Doppel that was moved after its installation.
class CmakePackage : public ProgramTest {
protected:
    void SetUp() override {
        const auto build = fs::path(DOPPEL_TEST_OUTPUT).parent_path();
        const auto installed = run(fmt::format("cmake --install '{}' --prefix \"$PWD/first\"", build.string()));
        ASSERT_EQ(installed.code, 0) << installed.out << installed.err;
        fs::rename(folder / "first", folder / "moved here");
        std::ofstream(folder / "CMakeLists.txt") << project;
        ASSERT_EQ(run("'moved here/bin/doppel' show calm > mine.toml").code, 0);
        const auto configured = run("cmake -G Ninja -S . -B build -D CMAKE_PREFIX_PATH=\"$PWD/moved here\"");
        ASSERT_EQ(configured.code, 0) << configured.out << configured.err;
    }

    Outcome run(const std::string& script) const { return shell("unset CI; " + script); }
    Outcome run_tests() const { return run("ctest --test-dir build --output-on-failure"); }
};

TEST_F(CmakePackage, GoldenTestsPassFailAndAreRenewed) {
    const auto without = run_tests();
    EXPECT_NE(without.code, 0);
    EXPECT_TRUE(has(without.out, "golden is missing"));

    const auto refused = run("CI=true cmake --build build --target doppel-update-goldens");
    EXPECT_NE(refused.code, 0);
    EXPECT_TRUE(has(refused.out, "not by CI"));
    EXPECT_FALSE(fs::exists(folder / "golden"));

    const auto updated = run("cmake --build build --target doppel-update-goldens");
    EXPECT_EQ(updated.code, 0) << updated.out;
    EXPECT_TRUE(fs::exists(folder / "charts/fig6.png"));
    const auto passed = run("cp -r golden kept; CI=true ctest --test-dir build --output-on-failure");
    EXPECT_EQ(passed.code, 0) << passed.out;

    spoil(folder / "golden/000001.png");
    const auto failed = run_tests();
    EXPECT_NE(failed.code, 0);
    EXPECT_TRUE(has(failed.out, "1 tests failed out of 2"));
    EXPECT_TRUE(has(failed.out, "40 pixels differ by more than 3/255"));
    EXPECT_TRUE(fs::exists(folder / "build/doppel/swing/mine/compare/000001.diff.png"));
    const auto junit = document_of(bytes_of(folder / "build/doppel/swing/compare.xml"));
    EXPECT_EQ(junit["tests"] + junit["failures"], "21");
    const auto page = document_of(bytes_of(folder / "build/doppel/swing/compare.html"));
    EXPECT_EQ(page.all("img").size(), 3u);

    EXPECT_EQ(run("cmake --build build --target doppel-update-goldens-swing").code, 0);
    EXPECT_EQ(run("diff -r golden kept").code, 0);
}

TEST(CmakeInstall, InstallsWhatIsBuiltOrNothing) {
    const auto folder = fresh_folder();
    // a build folder without manual pages, and one without the program
    const auto build = fs::path(DOPPEL_TEST_OUTPUT).parent_path().string();
    const auto made = shell("mkdir -p half/tests && cp -r '" + build + "'/doppel '" + build + "'/generated '" + build +
                            "'/changelog* half && for f in cmake_install.cmake "
                            "tests/cmake_install.cmake; do [ ! -e '" +
                            build + "'/$f ] || sed \"s|" + build + "|$PWD/half|g\" '" + build + "'/$f >half/$f; done");
    ASSERT_EQ(made.code, 0) << made.err;
    const auto half = shell("cmake --install half --prefix \"$PWD/first\" && first/bin/doppel list");
    EXPECT_EQ(half.code, 0) << half.out << half.err;
    EXPECT_TRUE(has(half.out, "the manual pages and completions are not built"));
    EXPECT_TRUE(fs::exists(folder / "first/share/doppel/presets/calm.toml"));
    EXPECT_FALSE(fs::exists(folder / "first/share/man"));
    // its pages link to files that are there
    const auto lost = shell(R"(cd first/share/doc/doppel && ls docs/fit.md >/dev/null &&
        grep -roP --include='*.md' '(\]\(|src="|href=")\K[^)#:" ]+(?=[)#"])' . | while IFS=: read page link; do
            [ -e "$(dirname $page)/$link" ] || echo "$page: $link"; done)");
    EXPECT_EQ(lost.out + lost.err, "");

    fs::remove(folder / "half/doppel");
    const auto none = shell("cmake --install half --prefix \"$PWD/second\"");
    EXPECT_NE(none.code, 0);
    EXPECT_TRUE(has(none.err, "doppel: the program is not built"));
    EXPECT_FALSE(fs::exists(folder / "second"));
}

TEST_F(CmakePackage, RefusesWhatMakesNoSense) {
    const std::string good = "NAME one PRESET calm GOLDEN golden ";
    const std::vector<std::pair<std::string, std::string>> calls{
        {good, "give either FRAMES"},
        {good + "FRAMES 0:1 FIGURE", "give either FRAMES"},
        {good + "FIGURE SZE 3x3", "\"SZE;3x3\" is no argument"},
        {"NAME one PRESET calm FIGURE", "GOLDEN is missing"},
    };
    for (const auto& [arguments, words] : calls) {
        std::ofstream(folder / "CMakeLists.txt") << "cmake_minimum_required(VERSION 3.21)\nproject(sample NONE)\n"
                                                    "find_package(doppel REQUIRED)\ndoppel_add_golden_test("
                                                 << arguments << ")\n";
        const auto configured = run("cmake -S . -B build");
        EXPECT_NE(configured.code, 0);
        EXPECT_TRUE(has(configured.err, words));
    }
}

}  // namespace doppel::cmake_package_test
