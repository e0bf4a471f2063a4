#include "cli/process.hpp"
#include "cli/xml.hpp"
#include "image/golden.hpp"
#include "output/png.hpp"

#include <algorithm>
#include <fstream>

extern "C" {
#include <libavutil/base64.h>
}

namespace doppel::compare_page_test {

namespace fs = std::filesystem;
using namespace test;
using ComparePage = ProgramTest;

/// The decoded pictures of one kind on a page, in order.
std::vector<Picture> pictures_of(const Element& page, const std::string& kind, const fs::path& scratch) {
    constexpr std::string_view start = "data:image/png;base64,";
    std::vector<Picture> pictures;
    for (const auto* image : page.all("img")) {
        const auto& url = (*image)["src"];
        EXPECT_TRUE(url.starts_with(start)) << url.substr(0, 40);
        if ((*image)["class"] != kind) continue;
        std::string png(url.size(), '\0');
        const int length = av_base64_decode(reinterpret_cast<std::uint8_t*>(png.data()), &url[start.size()],
                                            static_cast<int>(png.size()));
        EXPECT_GT(length, 0);
        png.resize(static_cast<std::size_t>(std::max(length, 0)));
        write_bytes(scratch, png);
        pictures.push_back(read_png(scratch));
        EXPECT_EQ((*image)["width"], std::to_string(pictures.back().size.width));
        EXPECT_EQ((*image)["height"], std::to_string(pictures.back().size.height));
    }
    return pictures;
}

TEST_F(ComparePage, ContainsThePixelsAndNeedsNoOtherFile) {
    for (const char* side : {"one", "two"}) fs::create_directories(folder / side);
    const Size size{300, 200};  // 180 kB of noise: several blocks of base64
    for (const std::string name : {"<b>&\"'.png", "2.png", "same.png", "gone.png", "broken.png", "tall.png"}) {
        write_png(folder / "one" / name, noise(size, 1), {.with_alpha = true});
        write_png(folder / "two" / name, noise(size, name == "same.png" ? 1 : 2), {.with_alpha = true});
    }
    Picture clear = noise(size, 1);  // two differences: red of the first row, opacity of the second
    for (int x = 0; x < size.width; ++x) clear.at(x, 0)[0] ^= 5, clear.at(x, 1)[3] ^= 6;
    write_png(folder / "two/2.png", clear, {.with_alpha = true});
    write_png(folder / "two/tall.png", noise({10, 20}, 2));
    fs::remove(folder / "two/gone.png");
    std::ofstream(folder / "two/broken.png") << "no picture";
    EXPECT_EQ(doppel("compare one two --html page.html --junit report.xml").code, 4);

    const auto text = bytes_of(folder / "page.html");
    const auto page = document_of(text);
    EXPECT_EQ(page.all("h1")[0]->text, "4 of 6 pictures differ, 1 could not be compared");
    EXPECT_EQ(page.all("title")[0]->text, page.all("h1")[0]->text);
    EXPECT_EQ(page.all("section").size(), 4u);  // those that differ, and the list of those that cannot be compared
    EXPECT_EQ(page.all("h2")[1]->text, "2.png");
    EXPECT_EQ(page.all("h2")[2]->text, "<b>&\"'.png");
    EXPECT_EQ(page.all("input").size(), 2u);
    EXPECT_TRUE(has(text, "two/gone.png: missing"));
    EXPECT_TRUE(has(text, "two/broken.png: cannot be decoded"));
    EXPECT_TRUE(has(text, "10×20 px, expected 300×200"));
    EXPECT_EQ(doppel("compare one/2.png two/broken.png --html one.html").code, 4);
    EXPECT_EQ(document_of(bytes_of(folder / "one.html")).all("h1")[0]->text, "The picture could not be compared");
    for (const char* outside : {"http:", "https:", "src=\"/", "url(", "@import", "<script src"})
        EXPECT_FALSE(has(text, outside)) << outside;

    const auto expected = pictures_of(page, "expected", folder / "scratch.png");
    const auto actual = pictures_of(page, "actual", folder / "scratch.png");
    const auto difference = pictures_of(page, "difference", folder / "scratch.png");
    ASSERT_EQ(expected.size(), 3u);
    ASSERT_EQ(actual.size(), 3u);
    ASSERT_EQ(difference.size(), 2u);
    EXPECT_EQ(page.all("img").size(), 8u);
    const auto one = read_png(folder / "one/2.png"), two = read_png(folder / "two/2.png");
    EXPECT_EQ(expected[0].rgba, one.rgba);
    EXPECT_EQ(actual[0].rgba, two.rgba);
    EXPECT_EQ(difference[0].rgba, amplified_difference(one, two).rgba);
    for (std::size_t i = 0; i < one.rgba.size(); i += 4) {
        const int opacity = std::abs(one.rgba[i + 3] - two.rgba[i + 3]);
        const int red = std::min(255, 16 * std::max(std::abs(one.rgba[i] - two.rgba[i]), opacity));
        ASSERT_EQ(difference[0].rgba[i], red) << i;
        ASSERT_EQ(difference[0].rgba[i + 3], 255);
    }
}

TEST_F(ComparePage, SaysThatAllPass) {
    write_png(folder / "one.png", noise({8, 8}, 1));
    done("compare one.png one.png --html page.html");
    const auto page = document_of(bytes_of(folder / "page.html"));
    EXPECT_EQ(page.all("h1")[0]->text, "The picture passes");
    EXPECT_TRUE(page.all("img").empty() && page.all("section").empty());
    EXPECT_EQ(page.all("details")[0]->all("li").size(), 1u);
}

TEST_F(ComparePage, StyleAndScriptAreSmall) {
    std::uintmax_t bytes = 0;
    for (const char* file : {"output/page.css", "cli/compare.css", "cli/compare.js"})
        bytes += fs::file_size(fs::path(DOPPEL_SOURCE_DIR) / "src" / file);
    EXPECT_LT(bytes, 10'000u);  // measured 6500
}

}  // namespace doppel::compare_page_test
