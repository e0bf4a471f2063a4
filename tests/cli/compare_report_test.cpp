#include "cli/pictures.hpp"
#include "cli/xml.hpp"

#include <algorithm>
#include <fstream>

namespace doppel::compare_report_test {

namespace fs = std::filesystem;
using namespace test;
using CompareJunit = ProgramTest;
using CompareReports = ProgramTest;

/// Names that are special in markup, terminals and XML; the last is U+FFFE, U+FFFF and a byte that is not UTF-8.
const std::string sharp = "<a> & \"b' --> .png", steered = "line\nnext\x1b[1m\x01.png",
                  odd = "\xef\xbf\xbe\xef\xbf\xbf\xff\xc3\xa4.png";

/// Two pass, two differ (one in size), two are missing, one cannot be read; each has a different name.
void make_folders(const fs::path& folder) {
    for (const auto& name : {sharp, steered, odd, std::string("4.png"), std::string("5.png"), std::string("6.png")})
        make(folder / "one" / name, plain(10));
    fs::copy(folder / "one", folder / "two");
    make(folder / "two" / sharp, plain(90));
    make(folder / "two" / odd, plain(10, {8, 8}));
    fs::rename(folder / "two/4.png", folder / "two/7.png");
    std::ofstream(folder / "two/5.png") << "no picture";
}

const Element* case_of(const Element& root, const std::string& name) {
    const auto cases = root.all("testcase");
    const auto found = std::ranges::find_if(cases, [&](const auto* one) { return (*one)["name"] == name; });
    return found == cases.end() ? nullptr : *found;
}

TEST_F(CompareJunit, ReportsEveryPictureOnce) {
    make_folders(folder);
    const auto result = ends("compare one two --junit new/folder/report.xml", 4);
    const auto root = document_of(bytes_of(folder / "new/folder/report.xml"));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / "new/folder"), {}), 1);
    ASSERT_EQ(root.all("testsuite").size(), 1u);
    for (const auto* counted : {&root, root.all("testsuite")[0]}) {
        EXPECT_EQ((*counted)["tests"], "7");
        EXPECT_EQ((*counted)["failures"], "4");
        EXPECT_EQ((*counted)["errors"], "1");
        EXPECT_GE(std::stod((*counted)["time"]), 0);
    }
    EXPECT_EQ(root.all("testcase").size(), 7u);
    EXPECT_EQ(root.all("failure").size(), 4u);
    for (const char* name : {"line next [1m .png", "6.png"}) {
        const auto* passes = case_of(root, name);
        ASSERT_TRUE(passes) << name;
        EXPECT_TRUE(passes->children.empty());
        EXPECT_EQ((*passes)["classname"], "one");
    }
    const auto* differs = case_of(root, sharp);
    ASSERT_TRUE(differs && differs->children.size() == 1);
    EXPECT_EQ(differs->children[0].name, "failure");
    EXPECT_TRUE(has(differs->children[0].text, "128 pixels differ by more than 3/255"));
    EXPECT_TRUE(
        has(differs->children[0].text, "differing pixels 128, by more than 3/255 128, largest difference 80/255"));
    EXPECT_TRUE(has(differs->children[0]["message"], "two/" + sharp + ": differs"));
    const auto* resized = case_of(root, "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd\xc3\xa4.png");
    ASSERT_TRUE(resized && resized->children.size() == 1);
    EXPECT_TRUE(has(resized->children[0]["message"], "8×8 px, expected 16×8"));
    EXPECT_EQ(case_of(root, "4.png")->children.at(0)["message"], "two/4.png: missing");
    EXPECT_EQ(case_of(root, "7.png")->children.at(0)["message"], "one/7.png: missing");
    EXPECT_EQ(case_of(root, "5.png")->children.at(0).name, "error");
}

TEST_F(CompareJunit, OfTwoPicturesAndOfNoDifference) {
    make(folder / "one.png", plain(10));
    make(folder / "two.png", plain(90));
    std::ofstream(folder / "three.png") << "no picture";
    const auto report = [&](const char* actual, int code) {
        EXPECT_EQ(doppel({"compare", "one.png", actual, "--junit", "r.xml"}).code, code);
        return document_of(bytes_of(folder / "r.xml"));
    };
    EXPECT_EQ(report("one.png", 0)["failures"], "0");
    EXPECT_EQ(report("two.png", 1)["failures"], "1");
    EXPECT_EQ(report("three.png", 4)["errors"], "1");
}

TEST_F(CompareReports, SayWhatCouldNotBeDrawn) {
    make(folder / "one.png", plain(10));
    done("compare one.png one.png --junit report.xml --html report.html");
    ends("compare --render nothing golden --junit report.xml --html report.html", 2);
    const auto root = document_of(bytes_of(folder / "report.xml"));
    EXPECT_EQ(root["errors"], "1");
    EXPECT_TRUE((*root.all("error").at(0))["message"].starts_with("there is no preset \"nothing\"; "));
    EXPECT_TRUE(has(bytes_of(folder / "report.html"), "there is no preset"));
}

TEST_F(CompareReports, SayWhatIsNotThere) {
    make(folder / "one/1.png", plain(10));
    for (const std::string paths : {"one two", "two one", "one one/1.png"}) {
        const auto refused = ends("compare " + paths + " --junit report.xml --html report.html", 2);
        EXPECT_TRUE(one_line(refused.err));
        const auto words = refused.err.substr(8, refused.err.size() - 9);  // without "doppel: "
        EXPECT_EQ((*document_of(bytes_of(folder / "report.xml")).all("error").at(0))["message"], words);
        EXPECT_TRUE(has(bytes_of(folder / "report.html"), words));
        fs::remove(folder / "report.xml");
        fs::remove(folder / "report.html");
    }
}

TEST_F(CompareReports, ReplaceOnlyTheirOwn) {
    make(folder / "one.png", plain(10));
    for (const std::string option : {"--junit", "--html"}) {
        fs::remove(folder / "mine");
        const auto run = [&](const std::string& file) {
            return doppel({"compare", "one.png", "one.png", option, file});
        };
        for (int again = 0; again < 2; ++again) EXPECT_EQ(run("mine").code, 0);
        const std::string yours = option == "--html"
                                      ? "<!DOCTYPE html>\n<html lang=\"en\"></html>"
                                      : "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"mine\"/>";
        write_bytes(folder / "yours", yours);
        const auto refused = run("yours");
        EXPECT_EQ(refused.code, 4);
        EXPECT_TRUE(has(refused.err, "yours was not written by Doppel"));
        EXPECT_EQ(bytes_of(folder / "yours"), yours);
        fs::remove(folder / "link");
        fs::create_symlink("mine", folder / "link");
        EXPECT_EQ(run("link").code, 4);
        EXPECT_EQ(run("folder/").code, 2);
        EXPECT_EQ(run("/proc/no/report").code, 4);
    }
    EXPECT_EQ(doppel("compare one.png one.png --html a/../b --junit ./b").code, 2);
}

TEST_F(CompareReports, ReplaceNoInputAndNoOtherFileOfDoppels) {
    make(folder / "one/1.png", plain(10));
    fs::copy(folder / "one", folder / "two");
    done("simulate calm --set scene.duration_s=0.1");
    done("compare one two --junit r.xml");
    for (const std::string option : {"--junit", "--html"})
        for (const std::string file : {"one/1.png", "two/1.png", "out/calm/calm.csv", "out/calm/calm.json", "r.xml"}) {
            if (option == "--junit" && file == "r.xml") continue;
            const auto before = bytes_of(folder / file);
            const auto refused = ends({"compare", "one", "two", option, file}, 4);
            EXPECT_EQ(refused.out, "") << option << file;
            EXPECT_TRUE(has(refused.err, file));
            EXPECT_EQ(bytes_of(folder / file), before) << option << file;
        }
}

TEST_F(CompareReports, DoNotReadTheManifestsOfTheirFolder) {
    make(folder / "one.png", plain(10));
    // a file system that records access times shows whether the file was read
    ASSERT_EQ(shell("echo '{}' >other.json; touch -a -d 2001-01-01 other.json").code, 0);
    const auto result = shell(
        "\"$DOPPEL\" compare one.png one.png --junit r.xml --html r.html && "
        "\"$DOPPEL\" init mine.toml && stat -c %x other.json");
    EXPECT_TRUE(has(result.out, "\n2001-01-01")) << result.err;
    const auto refused = doppel("compare one.png one.png --junit other.json");
    EXPECT_EQ(refused.err, "doppel: other.json was not written by Doppel for this; give another file name\n");
}

TEST_F(CompareReports, AreNotForStandardOutput) {
    make(folder / "one.png", plain(10));
    for (const auto* option : {"--junit", "--html", "--out"}) {
        expect_refused({"compare", "one.png", "one.png", option, "-"}, 2, "cannot be standard output here");
        EXPECT_FALSE(fs::exists(folder / "-")) << option;
    }
}

}  // namespace doppel::compare_report_test
