#include "vector/page.hpp"

#include "render/renderer.hpp"
#include "vector/cairo_drawing.hpp"
#include "vector/paths.hpp"

#include <gtest/gtest.h>
#include <libdeflate.h>

#include <cmath>
#include <cstdlib>
#include <regex>

namespace doppel {
namespace page_test {

constexpr Size size{240, 160};
const std::atomic<bool> never = false;

DisplayList on_white(Item item) {
    return {filled(size, rgb(0xffffff)), std::move(item)};
}

/// The same list, drawn by Cairo.
Picture drawn_by_cairo(const DisplayList& list) {
    auto* surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, size.width, size.height);
    auto* context = cairo_create(surface);
    draw(list, {}, context);
    cairo_surface_flush(surface);
    Picture picture(size);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const auto* p = cairo_image_surface_get_data(surface) + y * cairo_image_surface_get_stride(surface) + 4 * x;
            auto* to = picture.at(x, y);
            to[0] = p[2], to[1] = p[1], to[2] = p[0], to[3] = 255;
        }
    cairo_destroy(context);
    cairo_surface_destroy(surface);
    return picture;
}

struct Difference {
    double mean = 0;  // of 255, over all samples
    int most = 0;
};

Difference difference(const DisplayList& list) {
    Renderer renderer(size, {});
    const auto& gl = renderer.draw(list, never);
    const auto cairo = drawn_by_cairo(list);
    Difference found;
    for (std::size_t i = 0; i < gl.rgba.size(); ++i) {
        const int off = std::abs(gl.rgba[i] - cairo.rgba[i]);
        found.mean += off / static_cast<double>(gl.rgba.size());
        found.most = std::max(found.most, off);
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

// Two ways of drawing the same, which share only the display list: they differ by the coverage of pixels at edges.
// Measured, of 255, most and mean: box and image 0; round box 14, 0.01; capsule 19, 0.04; disc 22, 0.02; ring 26, 0.08;
// stroke 28, 0.06.
TEST(Page, ShapesAreAsOpenGlDrawsThem) {
    const auto ink = rgb(0x2050a0);
    const std::vector<std::pair<const char*, Item>> items{
        {"box", Box{20, 30, 150, 90, 0, ink.with_alpha(0.6f)}},
        {"round box", Box{20, 30, 150, 90, 18, ink}},
        {"capsule", Capsule{{30, 40}, {180, 110}, 9, ink}},
        {"disc", Capsule{{100, 80}, {100, 80}, 33.3f, ink}},
        {"ring", Ring{{110, 75}, 50, 3, ink}},
        {"stroke", Stroke{{{{20, 120}, 1, 1, 1, 8}, {{150, 60}, 1, 1, 1, 0}, {{220, 130}}}, 4, ink}},
        {"image", Image{20, 20, 180, 140, chequered()}}};
    for (const auto& [name, item] : items) {
        const auto [mean, most] = difference(on_white(item));
        EXPECT_LE(most, 40) << name;
        EXPECT_LE(mean, 0.12) << name;
    }
}

/// How much ink there is, px, and its middle, px from the left and the top.
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

// FreeType and stb_truetype; Cairo's pictures have letters on whole pixels, OpenGL's on quarters. Measured, of
// regular and bold: ink 0.98 and 1.05 times as much, 0.2 and 0.5 px aside, 0.01 and 0.2 px above.
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
    const auto [mean, most] = difference(on_white(Capsule{{100, 80}, {100, 80}, 20, rgb(0xff8000), 24}));
    EXPECT_LE(most, 27);   // at the edges of the six rings; measured 18
    EXPECT_LE(mean, 0.2);  // measured 0.12
}

TEST(Page, CirclesAreRound) {
    const auto items = page_items({Ring{{100, 100}, 80, 2, rgb(0)}});
    const auto& path = std::get<Path>(items.at(0));
    Point from;
    int curves = 0;
    for (const auto& step : path.steps) {
        if (step.kind == Path::Step::Kind::curve) {
            ++curves;
            for (float t = 0; t <= 1; t += 0.05f) {
                const float u = 1 - t;
                const auto at = [&](float Point::*c) {
                    return u * u * u * from.*c + 3 * u * u * t * step.leave.*c + 3 * u * t * t * step.arrive.*c +
                           t * t * t * step.to.*c;
                };
                EXPECT_NEAR(distance({at(&Point::x), at(&Point::y)}, {100, 100}), 80, 80 * 0.0003);
            }
        }
        from = step.to;
    }
    EXPECT_EQ(curves, 4);
}

TEST(Page, AStrokeIsOnePathWhereItLooksTheSameAllAlong) {
    Stroke stroke{{{{10, 10}}, {{60, 20}}, {{90, 80}}}, 3, rgb(0)};
    EXPECT_EQ(page_items({stroke}).size(), 1u);
    stroke.vertices[1].alpha = 0.6f;  // 40 % in steps of 4 % at most, twice
    const auto items = page_items({stroke});
    EXPECT_EQ(items.size(), 19u);  // those on either side of the vertex look the same
    for (const auto& item : items) EXPECT_EQ(std::get<Path>(item).has_round_ends, std::get<Path>(item).color.a == 1);
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

const DisplayList poster{filled(size, rgb(0xffffff)), Capsule{{10, 10}, {90, 90}, 1, rgb(0xc04000)},
                         label("Tom & \"θ₁\" < 5", {10, 100}, 20, rgb(0), Align::left, Weight::bold),
                         label("plain", {10, 140}, 12, rgb(0))};

TEST(Page, APdfHasTextLinesAndTheFontsItNeeds) {
    const auto pdf = pdf_page(poster, {size, 180, {{"title", "Pendulums"}, {"encoder", "Doppel"}}});
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
    EXPECT_EQ(pdf, pdf_page(poster, {size, 180, {{"title", "Pendulums"}, {"encoder", "Doppel"}}}));
}

TEST(Page, AnSvgHasTextAsText) {
    const auto svg = svg_page(poster, {size, 180, {{"title", "A < B"}}});
    for (const auto* part :
         {R"(width="180pt" height="120pt" viewBox="0 0 240 160")", "<title>A &lt; B</title>",
          "font-weight=\"bold\">Tom &amp; &quot;θ₁&quot; &lt; 5</text>",
          "font-weight: normal; src: url(data:font/ttf;base64,", "font-weight: bold; src: url(data:font/ttf;base64,",
          R"(<path d="M10 10L90 90" fill="none" stroke="#c04000" stroke-width="2"/>)"})
        EXPECT_NE(svg.find(part), std::string::npos) << part;
    EXPECT_TRUE(svg.ends_with("</svg>\n"));
}

TEST(Page, PicturesOfNothingAreLeftOut) {
    EXPECT_TRUE(page_items({Box{5, 5, 5, 9}, Image{0, 0, 0, 0, chequered()}, Image{0, 0, 9, 9, nullptr},
                            Capsule{{}, {}, 0}, Stroke{{{{1, 1}}, {{2, 2}}}, 0}})
                    .empty());
}

}  // namespace page_test
}  // namespace doppel
