#include "plot/page.hpp"

#include "render/pixels.hpp"
#include "render/renderer.hpp"

#include <gtest/gtest.h>
#include <libdeflate.h>

#include <cmath>
#include <cstdlib>
#include <regex>

namespace doppel::page_test {

constexpr Size size{240, 160};
const std::atomic<bool> never = false;

DisplayList on_white(Item item) {
    return {filled(size, rgb(0xffffff)), std::move(item)};
}

/// The same list drawn by Cairo.
Picture drawn_by_cairo(const DisplayList& list) {
    return picture_of({.size = size, .items = page_list(list)});
}

struct Difference {
    double mean = 0;  // of 255, over all samples
    int maximum = 0;
};

Difference difference(const DisplayList& list) {
    Renderer renderer(size, {});
    const auto& gl = renderer.draw(list, never);
    const auto cairo = drawn_by_cairo(list);
    Difference found;
    for (std::size_t i = 0; i < gl.rgba.size(); ++i) {
        const int off = std::abs(gl.rgba[i] - cairo.rgba[i]);
        found.mean += off / static_cast<double>(gl.rgba.size());
        found.maximum = std::max(found.maximum, off);
    }
    return found;
}

std::shared_ptr<Picture> chequered() {
    auto picture = std::make_shared<Picture>(Size{4, 3});
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 4; ++x) {
            auto* p = picture->at(x, y);
            p[0] = (x + y) % 2 ? 200 : 10, p[1] = static_cast<std::uint8_t>(60 * x), p[2] = 90,
            p[3] = x == 0 ? 128 : 255;
        }
    return picture;
}

// OpenGL and Cairo share only the display list: their pictures differ by the coverage of pixels at edges.
// Measured, of 255, maximum and mean: box 0; round box 14, 0.01; capsule 19, 0.04; disc 22, 0.02; ring 26, 0.08;
// stroke 28, 0.06.
TEST(Page, ShapesAreAsOpenGlDrawsThem) {
    const auto ink = rgb(0x2050a0);
    const std::vector<std::pair<const char*, Item>> items{
        {"box", Box{20, 30, 150, 90, 0, ink.with_alpha(0.6f)}},
        {"round box", Box{20, 30, 150, 90, 18, ink}},
        {"capsule", Capsule{{30, 40}, {180, 110}, 9, ink}},
        {"disc", Capsule{{100, 80}, {100, 80}, 33.3f, ink}},
        {"ring", Ring{{110, 75}, 50, 3, ink}},
        {"stroke", Stroke{{{{20, 120}, 1, 1, 1, 8}, {{150, 60}, 1, 1, 1, 0}, {{220, 130}}}, 4, ink}}};
    for (const auto& [name, item] : items) {
        const auto [mean, maximum] = difference(on_white(item));
        EXPECT_LE(maximum, 40) << name;
        EXPECT_LE(mean, 0.12) << name;
    }
}

/// The area of the ink, px², and its centre, px from the left and the top.
struct Ink {
    double amount = 0, x = 0, y = 0;
};

Ink ink_of(const Picture& picture) {
    Ink ink;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const double dark = 1 - picture.at(x, y)[1] / 255.0;
            ink.amount += dark, ink.x += dark * x, ink.y += dark * y;
        }
    return {ink.amount, ink.x / ink.amount, ink.y / ink.amount};
}

// FreeType and stb_truetype. Measured, regular and bold: ratio of ink 1.00, difference 0.1 px across, 0.01 px upwards.
TEST(Page, TextIsWhereOpenGlWritesIt) {
    for (const auto weight : {Weight::regular, Weight::bold})
        for (const auto align : {Align::left, Align::center, Align::right}) {
            const auto list = on_white(label("θ₁ = 90.003°, d ≈ 10⁻⁵", {120, 80}, 9, rgb(0), align, weight));
            Renderer renderer(size, {});
            const auto gl = ink_of(renderer.draw(list, never)), cairo = ink_of(drawn_by_cairo(list));
            EXPECT_NEAR(cairo.amount / gl.amount, 1, 0.07);
            EXPECT_NEAR(cairo.x, gl.x, 0.7);
            EXPECT_NEAR(cairo.y, gl.y, 0.3);
        }
}

TEST(Page, GlowsFallOffAsOpenGlDrawsThem) {
    const auto [mean, maximum] = difference(on_white(Capsule{{100, 80}, {100, 80}, 20, rgb(0xff8000), 24}));
    EXPECT_LE(maximum, 27);  // at the edges of the six rings; measured 18
    EXPECT_LE(mean, 0.2);    // measured 0.12
}

TEST(Page, LinesAreDashedCutAndFilled) {
    const Area within{50, 20, 150, 120};
    const auto drawn = [&](const Polylines& lines) {
        return picture_of({.size = size, .items = {filled(size, rgb(0xffffff)), lines}});
    };
    const auto ink = [](const Picture& picture, int y) {
        std::vector<bool> dark;
        for (int x = 0; x < size.width; ++x) dark.push_back(picture.at(x, y)[1] < 128);
        return dark;
    };
    const auto dashed = ink(drawn({{{{30, 60.5f}, {230, 60.5f}}}, 3, rgb(0), 12, 8, within}), 60);
    // round ends make each dash 3 px longer and each gap 3 px shorter
    for (int x = 0; x < size.width; ++x) {
        const int from_dash = (x - 30 + 20) % 20;
        const bool inside = x >= 50 && x < 150, is_gap = from_dash >= 14 && from_dash < 18;
        if (!inside || from_dash < 12 || is_gap) {
            EXPECT_EQ(dashed[static_cast<std::size_t>(x)], inside && !is_gap) << x;
        }
    }
    const auto polygon = ink(drawn({{{{60, 10}, {200, 10}, {200, 140}, {60, 140}}}, 0, rgb(0), 0, 0, within}), 60);
    for (int x = 0; x < size.width; ++x) EXPECT_EQ(polygon[static_cast<std::size_t>(x)], x >= 60 && x < 150) << x;
}

TEST(Page, AStrokeDoesNotAddUpWhereItCrossesItself) {
    const Stroke loop{{{{40, 40}}, {{200, 120}}, {{200, 40}}, {{40, 120}}}, 8, rgb(0).with_alpha(0.5f)};
    const auto picture = drawn_by_cairo(on_white(loop));
    EXPECT_EQ(picture.at(120, 80)[0], picture.at(80, 60)[0]);
    EXPECT_NEAR(picture.at(80, 60)[0], 128, 1);
}

/// The bytes of a PDF's compressed streams.
std::string streams_of(const std::string& pdf) {
    std::string all;
    const std::string open = "stream\n";
    auto* inflate = libdeflate_alloc_decompressor();
    for (std::size_t at = pdf.find(open); at != std::string::npos; at = pdf.find(open, at + 1)) {
        const std::size_t begin = at + open.size(), end = pdf.find("\nendstream", begin);
        if (end == std::string::npos) break;
        std::string plain(4'000'000, '\0');
        std::size_t size_of_it = 0;
        if (libdeflate_zlib_decompress(inflate, &pdf[begin], end - begin, plain.data(), plain.size(), &size_of_it) ==
            LIBDEFLATE_SUCCESS)
            all += plain.substr(0, size_of_it);
    }
    libdeflate_free_decompressor(inflate);
    return all;
}

const Page poster{.size = size,
                  .items = {filled(size, rgb(0xffffff)), Capsule{{10, 10}, {90, 90}, 1, rgb(0xc04000)},
                            label("Tom & \"θ₁\" < 5", {10, 100}, 20, rgb(0), Align::left, Weight::bold),
                            label("plain", {10, 140}, 12, rgb(0))}};

TEST(Page, APdfHasTextLinesAndTheFontsItNeeds) {
    const Metadata metadata{{"title", "Pendulums"}, {"encoder", "Doppel"}};
    const auto pdf = page_file(poster, PictureFormat::pdf, 180, metadata);
    EXPECT_EQ(pdf.substr(0, 8), "%PDF-1.5");
    const auto all = pdf + streams_of(pdf);
    std::smatch box;
    ASSERT_TRUE(std::regex_search(all, box, std::regex(R"(/MediaBox \[ 0 0 ([\d.]+) ([\d.]+) \])")));
    EXPECT_NEAR(std::stod(box[1]), 180, 1e-3);
    EXPECT_NEAR(std::stod(box[2]), 120, 1e-3);
    for (const auto* part :
         {"Tj", "BT", "/FontFile2", "/ToUnicode", "(Pendulums)", "+DejaVuSans\n", "+DejaVuSans-Bold\n"})
        EXPECT_NE(all.find(part), std::string::npos) << part;
    EXPECT_LT(pdf.size(), 20'000u) << "of the font only what is needed: they have 82 and 79 kB";
    EXPECT_EQ(all.find("CreationDate"), std::string::npos);
    EXPECT_NE(pdf.find("%%EOF\n% Doppel\n"), std::string::npos);
    EXPECT_EQ(pdf, page_file(poster, PictureFormat::pdf, 180, metadata));
}

TEST(Page, AnSvgSaysWhatItIs) {
    const auto svg = page_file(poster, PictureFormat::svg, 180, {{"title", "A < B"}, {"comment", "c"}});
    for (const auto* part : {R"(width="180pt" height="120pt" viewBox="0 0 180 120")",
                             "<title>A &lt; B</title>\n<desc>c</desc>", "<!-- Doppel -->\n<svg "})
        EXPECT_NE(svg.find(part), std::string::npos) << part;
    EXPECT_LT(svg.size(), 30'000u);
    EXPECT_TRUE(svg.ends_with("</svg>\n"));
}

TEST(Page, PicturesOfNothingAreLeftOut) {
    const Page page{.size = size,
                    .items = {Box{5, 5, 5, 9}, Image{{}, chequered()}, Image{{0, 0, 9, 9}, nullptr}, Capsule{{}, {}, 0},
                              Stroke{{{{1, 1}}, {{2, 2}}}, 0}, Polylines{{}, 1}}};
    EXPECT_TRUE(extent(picture_of(page)).empty());
}

TEST(Page, ImagesAreCrispAndAsOpaqueAsTheirPixels) {
    const auto pixels = chequered();  // 4 × 3, each 20 × 30
    const auto drawn = picture_of({.size = size, .items = {filled(size, rgb(0)), Image{{10, 20, 90, 110}, pixels}}});
    EXPECT_EQ(extent(drawn).right, 90);
    EXPECT_EQ(extent(drawn).bottom, 110);
    for (int y = 20; y < 110; ++y)
        for (int x = 10; x < 90; ++x) {
            const auto* p = pixels->at((x - 10) / 20, (y - 20) / 30);
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(drawn.at(x, y)[c], p[c] * p[3] / 255, 1) << x << " " << y;
        }
}

}  // namespace doppel::page_test
