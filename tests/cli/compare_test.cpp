#include "cli/process.hpp"
#include "output/png.hpp"

#include <algorithm>
#include <fstream>

namespace doppel::compare_test {

namespace fs = std::filesystem;
using test::doppel;
using test::fresh_folder;
using test::with;

const std::vector<std::string> tiny{"--set", "scene.duration_s=0.1", "--size", "160x90", "--progress", "none"};

TEST(Compare, PassesDiffersAndShowsTheDifference) {
    const auto folder = fresh_folder();
    const auto frames = with({"render", "calm", "--format", "png", "--frames", "0:3"}, tiny);
    ASSERT_EQ(doppel(folder, with(frames, {"-o", "one"})).code, 0);
    ASSERT_EQ(doppel(folder, with(frames, {"-o", "two"})).code, 0);
    const auto same = doppel(folder, {"compare", "one/calm/frames", "two/calm/frames"});
    EXPECT_EQ(same.code, 0) << same.out;
    EXPECT_EQ(same.out, "0 of 3 pictures differ\n");

    auto picture = read_png(folder / "two/calm/frames/000001.png");
    for (int i = 0; i < 40; ++i) picture.at(10 + i, 20)[0] ^= 64;
    write_png(folder / "two/calm/frames/000001.png", picture);
    fs::remove(folder / "two/calm/frames/000002.png");
    const auto differs = doppel(folder, {"compare", "one/calm/frames", "two/calm/frames"});
    EXPECT_EQ(differs.code, 1);
    EXPECT_NE(differs.out.find("000001.png: differs from"), std::string::npos) << differs.out;
    EXPECT_NE(differs.out.find("40 pixels differ by more than 3/255, and at most 4 may"), std::string::npos) << differs.out;
    EXPECT_NE(differs.out.find("two/calm/frames/000002.png: missing"), std::string::npos);
    EXPECT_TRUE(fs::exists(folder / "out/compare/000001.diff.png"));
    EXPECT_EQ(doppel(folder, {"compare", "one/calm/frames/000000.png", "two/calm/frames/000000.png"}).code, 0);
    EXPECT_EQ(doppel(folder, {"compare", "one/calm/frames", "two/calm/frames/000000.png"}).code, 2);

    fs::copy(folder / "two/calm/frames/000001.png", folder / "one/calm/frames/000001.egl.png");
    for (const char* actual : {"two/calm/frames/000001.png", "one/calm/frames/000001.egl.png"})  // one is a variant
        EXPECT_EQ(doppel(folder, {"compare", "one/calm/frames/000001.png", actual}).code, actual[0] == 't' ? 0 : 1);

    std::ofstream(folder / "broken.png") << "no picture";
    EXPECT_EQ(doppel(folder, {"compare", "broken.png", "two/calm/frames/000000.png"}).code, 4);
}

/// A folder of pictures, each of one colour; `pictures` has their names and red values.
void make_pictures(const fs::path& folder, const std::vector<std::pair<std::string, int>>& pictures) {
    fs::create_directories(folder);
    for (const auto& [name, red] : pictures) {
        Picture picture({8, 8});
        for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
            picture.rgba[i] = static_cast<std::uint8_t>(red), picture.rgba[i + 3] = 255;
        write_png(folder / name, picture);
    }
}

TEST(Compare, CountsEveryPictureOnce) {
    const auto folder = fresh_folder();
    make_pictures(folder / "one", {{"1.png", 10}, {"2.png", 10}});
    make_pictures(folder / "two", {{"1.png", 10}, {"3.png", 10}});
    const auto result = doppel(folder, {"compare", "one", "two"});
    EXPECT_EQ(result.code, 1);
    EXPECT_EQ(result.out, "two/2.png: missing\none/3.png: missing\n2 of 3 pictures differ\n");
}

TEST(Compare, ContinuesAfterAnUnreadablePicture) {
    const auto folder = fresh_folder();
    make_pictures(folder / "one", {{"1.png", 10}, {"2.png", 10}, {"3.png", 10}});
    make_pictures(folder / "two", {{"1.png", 10}, {"2.png", 10}, {"3.png", 90}});
    std::ofstream(folder / "two/1.png") << "no picture";
    const auto result = doppel(folder, {"compare", "one", "two"});
    EXPECT_EQ(result.code, 4);
    EXPECT_NE(result.out.find("two/1.png: cannot be decoded as PNG"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("two/3.png: differs from one/3.png"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("\n1 of 3 pictures differ\n"), std::string::npos) << result.out;
    EXPECT_EQ(result.err.rfind("doppel: 1 of 3 pictures could not be compared; the first: two/1.png: cannot be", 0), 0u)
        << result.err;
}

TEST(Compare, RemovesAnOldDifferenceWhenThePicturePasses) {
    const auto folder = fresh_folder();
    make_pictures(folder / "one", {{"1.png", 10}, {"2.png", 10}});
    make_pictures(folder / "two", {{"1.png", 90}, {"2.png", 90}});
    ASSERT_EQ(doppel(folder, {"compare", "one", "two"}).code, 1);
    ASSERT_TRUE(fs::exists(folder / "out/compare/1.diff.png"));
    make_pictures(folder / "two", {{"1.png", 10}, {"2.png", 90}});
    // a user's own picture, and a link to a picture
    make_pictures(folder / "out/compare", {{"3.diff.png", 0}});
    fs::create_symlink("2.diff.png", folder / "out/compare/4.diff.png");
    for (const char* side : {"one", "two"}) make_pictures(folder / side, {{"3.png", 10}, {"4.png", 10}});
    ASSERT_EQ(doppel(folder, {"compare", "one", "two"}).code, 1);
    EXPECT_FALSE(fs::exists(folder / "out/compare/1.diff.png"));
    for (const char* stays : {"2.diff.png", "3.diff.png", "4.diff.png"})
        EXPECT_TRUE(fs::exists(folder / "out/compare" / stays)) << stays;
}

TEST(Compare, ReplacesDifferencePicturesAlone) {
    const auto folder = fresh_folder();
    make_pictures(folder / "one", {{"1.png", 10}});
    make_pictures(folder / "two", {{"1.png", 90}});
    for (int again = 0; again < 2; ++again) EXPECT_EQ(doppel(folder, {"compare", "one", "two"}).code, 1);
    make_pictures(folder / "out/compare", {{"1.diff.png", 0}});
    const auto mine = test::bytes_of(folder / "out/compare/1.diff.png");
    const auto refused = doppel(folder, {"compare", "one", "two"});
    EXPECT_EQ(refused.code, 4);
    EXPECT_NE(refused.err.find("out/compare/1.diff.png is no difference picture"), std::string::npos) << refused.err;
    EXPECT_EQ(test::bytes_of(folder / "out/compare/1.diff.png"), mine);
}

TEST(Compare, ReportsUnreadablePictures) {
    const auto folder = fresh_folder();
    make_pictures(folder, {{"1.png", 10}});
    const std::string name(300, 'n');  // longer than file systems allow
    const auto refused = doppel(folder, {"compare", "1.png", name});
    EXPECT_EQ(refused.code, 4);
    EXPECT_EQ(refused.err, "doppel: " + name + ": cannot be read: File name too long\n");
}

TEST(Compare, ComparesOpacity) {
    const auto folder = fresh_folder();
    Picture picture({8, 8});
    std::fill(picture.rgba.begin(), picture.rgba.end(), std::uint8_t{200});
    write_png(folder / "one.png", picture, {.with_alpha = true});
    picture.at(3, 3)[3] = 0;
    write_png(folder / "two.png", picture, {.with_alpha = true});
    const auto result = doppel(folder, {"compare", "one.png", "two.png"});
    EXPECT_EQ(result.code, 1);
    EXPECT_NE(result.out.find("a pixel differs by 200/255"), std::string::npos) << result.out;
}

}  // namespace doppel::compare_test
