#include "cli/pictures.hpp"

#include <algorithm>
#include <fstream>

namespace doppel::compare_test {

namespace fs = std::filesystem;
using namespace test;
using Compare = ProgramTest;

const Words tiny = "--set scene.duration_s=0.1 --size 160x90 --progress none";

TEST_F(Compare, PassesDiffersAndShowsTheDifference) {
    const auto frames = with("render calm --format png --frames 0:3", tiny);
    done(with(frames, "-o one"));
    done(with(frames, "-o two"));
    const auto same = done("compare one/calm/frames two/calm/frames");
    EXPECT_EQ(same.out, "0 of 3 pictures differ\n");

    spoil(folder / "two/calm/frames/000001.png");
    fs::remove(folder / "two/calm/frames/000002.png");
    const auto differs = ends("compare one/calm/frames two/calm/frames", 1);
    EXPECT_TRUE(has(differs.out, {"000001.png: differs from", "40 pixels differ by more than 3/255, and at most 4 may",
                                  "two/calm/frames/000002.png: missing"}));
    EXPECT_TRUE(fs::exists(folder / "out/compare/000001.diff.png"));
    done("compare one/calm/frames/000000.png two/calm/frames/000000.png");
    EXPECT_EQ(doppel("compare one/calm/frames two/calm/frames/000000.png").code, 2);

    fs::copy(folder / "two/calm/frames/000001.png", folder / "one/calm/frames/000001.egl.png");
    for (const char* actual : {"two/calm/frames/000001.png", "one/calm/frames/000001.egl.png"})  // one is a variant
        EXPECT_EQ(doppel({"compare", "one/calm/frames/000001.png", actual}).code, actual[0] == 't' ? 0 : 1);

    std::ofstream(folder / "broken.png") << "no picture";
    EXPECT_EQ(doppel("compare broken.png two/calm/frames/000000.png").code, 4);
}

/// A folder of pictures, each of one colour; `pictures` has their names and red values.
void make_pictures(const fs::path& folder, const std::vector<std::pair<std::string, int>>& pictures) {
    for (const auto& [name, red] : pictures) make(folder / name, plain(red));
}

TEST_F(Compare, CountsEveryPictureOnce) {
    make_pictures(folder / "one", {{"1.png", 10}, {"2.png", 10}});
    make_pictures(folder / "two", {{"1.png", 10}, {"3.png", 10}});
    const auto result = ends("compare one two", 1);
    EXPECT_EQ(result.out, "two/2.png: missing\none/3.png: missing\n2 of 3 pictures differ\n");
}

TEST_F(Compare, ContinuesAfterAnUnreadablePicture) {
    make_pictures(folder / "one", {{"1.png", 10}, {"2.png", 10}, {"3.png", 10}});
    make_pictures(folder / "two", {{"1.png", 10}, {"2.png", 10}, {"3.png", 90}});
    std::ofstream(folder / "two/1.png") << "no picture";
    const auto result = ends("compare one two", 4);
    EXPECT_TRUE(has(result.out, {"two/1.png: cannot be decoded as PNG", "two/3.png: differs from one/3.png",
                                 "\n1 of 3 pictures differ\n"}));
    EXPECT_TRUE(begins(result.err, "doppel: 1 of 3 pictures could not be compared; the first: two/1.png: cannot be"));
}

TEST_F(Compare, NamesFoldersThatItDoesNotEnter) {
    make_pictures(folder / "one", {{"1.png", 10}});
    make_pictures(folder / "one/more", {{"1.png", 10}});
    const auto result = done("compare one one");
    EXPECT_EQ(result.out, "one/more: this folder is not compared; name it to compare it\n0 of 1 pictures differ\n");
}

TEST_F(Compare, RemovesAnOldDifferenceWhenThePicturePasses) {
    make_pictures(folder / "one", {{"1.png", 10}, {"2.png", 10}});
    make_pictures(folder / "two", {{"1.png", 90}, {"2.png", 90}});
    ASSERT_EQ(doppel("compare one two").code, 1);
    ASSERT_TRUE(fs::exists(folder / "out/compare/1.diff.png"));
    make_pictures(folder / "two", {{"1.png", 10}, {"2.png", 90}});
    // a user's own picture, and a link to a picture
    make_pictures(folder / "out/compare", {{"3.diff.png", 0}});
    fs::create_symlink("2.diff.png", folder / "out/compare/4.diff.png");
    for (const char* side : {"one", "two"}) make_pictures(folder / side, {{"3.png", 10}, {"4.png", 10}});
    ASSERT_EQ(doppel("compare one two").code, 1);
    EXPECT_FALSE(fs::exists(folder / "out/compare/1.diff.png"));
    for (const char* stays : {"2.diff.png", "3.diff.png", "4.diff.png"})
        EXPECT_TRUE(fs::exists(folder / "out/compare" / stays)) << stays;
}

TEST_F(Compare, ReplacesDifferencePicturesAlone) {
    make_pictures(folder / "one", {{"1.png", 10}});
    make_pictures(folder / "two", {{"1.png", 90}});
    for (int again = 0; again < 2; ++again) EXPECT_EQ(doppel("compare one two").code, 1);
    make_pictures(folder / "out/compare", {{"1.diff.png", 0}});
    const auto mine = bytes_of(folder / "out/compare/1.diff.png");
    expect_refused("compare one two", 4, "out/compare/1.diff.png is no difference picture");
    EXPECT_EQ(bytes_of(folder / "out/compare/1.diff.png"), mine);
}

TEST_F(Compare, ReportsUnreadablePictures) {
    make_pictures(folder, {{"1.png", 10}});
    const std::string name(300, 'n');  // longer than file systems allow
    const auto refused = ends({"compare", "1.png", name}, 4);
    EXPECT_EQ(refused.err, "doppel: " + name + ": cannot be read: File name too long\n");
}

TEST_F(Compare, ComparesOpacity) {
    Picture picture({8, 8});
    std::fill(picture.rgba.begin(), picture.rgba.end(), std::uint8_t{200});
    write_png(folder / "one.png", picture, {.with_alpha = true});
    picture.at(3, 3)[3] = 0;
    write_png(folder / "two.png", picture, {.with_alpha = true});
    const auto result = ends("compare one.png two.png", 1);
    EXPECT_TRUE(has(result.out, "a pixel differs by 200/255"));
}

}  // namespace doppel::compare_test
