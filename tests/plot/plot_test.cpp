#include "plot/plot.hpp"

#include "base/error.hpp"
#include "plot/plot_figures.hpp"
#include "render/typeface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace doppel::plot_test {

constexpr const Theme &dark = themes[0], &light = themes[1];

struct Words {
    float left, top, right, bottom;
    std::string text;
};

/// The areas of all texts of a list: from the top of a capital to the tail of a comma.
std::vector<Words> words_of(const PageList& list) {
    std::vector<Words> all;
    for (const auto& [text, anchor, size, align, weight, color] : items_of<Label>(list)) {
        if (text.empty()) continue;
        const float width = text_width(text, size, weight);
        const float left = anchor.x - (align == Align::left ? 0 : align == Align::center ? width / 2 : width);
        all.push_back({left, anchor.y - 0.76f * size, left + width, anchor.y + 0.23f * size, text});
    }
    return all;
}

/// Texts neither overlap nor leave the picture.
void expect_legible(const Page& page, float slack = 0.01f) {
    const std::vector<Words> all = words_of(page.items);
    const float width = static_cast<float>(page.size.width) / page.scale;
    const float height = static_cast<float>(page.size.height) / page.scale;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Words& a = all[i];
        EXPECT_TRUE(a.left >= -slack && a.top >= -slack && a.right <= width + slack && a.bottom <= height + slack)
            << '"' << a.text << "\" leaves the picture: " << a.left << " " << a.top << " " << a.right << " "
            << a.bottom;
        for (std::size_t j = 0; j < i; ++j) {
            const Words& b = all[j];
            const bool apart = a.left >= b.right - slack || b.left >= a.right - slack || a.top >= b.bottom - slack ||
                               b.top >= a.bottom - slack;
            EXPECT_TRUE(apart) << '"' << a.text << "\" and \"" << b.text << '"';
        }
    }
}

TEST(Plot, TextsNeverOverlapOrLeaveThePicture) {
    int number = 0;
    for (const Figure& figure : all_figures()) {
        for (const Size size : {Size{480, 270}, {800, 600}, {1280, 720}, {1600, 900}, {900, 1600}}) {
            SCOPED_TRACE(testing::Message() << "figure " << number << ", " << size.width << " × " << size.height);
            expect_legible(compose(figure, size, size.width == 800 ? dark : light));
        }
        ++number;
    }
}

TEST(Plot, TextsNeverOverlapForAnyCurves) {
    std::mt19937 random(11);
    const auto between = [&](double a, double b) { return std::uniform_real_distribution(a, b)(random); };
    for (int trial = 0; trial < 150; ++trial) {
        Plot plot{.x = {.label = "time, s"}, .y = {.label = "what is measured, J", .logarithmic = trial % 3 == 0}};
        for (int c = 0; c < 2 + trial % 7; ++c) {
            Curve walk{
                .label = std::string("walk ") + std::string(random() % 9, 'n'), .mark = Mark(random() % 3), .hue = c};
            double value = between(1, 100);
            for (int i = 0; i < 5 + trial; ++i) {
                walk.x.push_back(i);
                walk.y.push_back(value *= between(0.8, 1.25));
            }
            plot.curves.push_back(walk);
        }
        plot.rules = {{Rule::Orientation::vertical, between(0, 5), "a moment"},
                      {Rule::Orientation::horizontal, between(1, 100), "a limit"}};
        const Size size{320 + 10 * trial, 240 + 4 * trial};
        SCOPED_TRACE(trial);
        expect_legible(compose({.title = "Walks", .panels = {plot}}, size, dark));
    }
}

TEST(Plot, BothThemesHaveOneLayout) {
    for (const Figure& figure : all_figures()) {
        const auto a = words_of(composed(figure, {640, 360}, dark)), b = words_of(composed(figure, {640, 360}, light));
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t i = 0; i < a.size(); ++i) {
            EXPECT_EQ(a[i].text, b[i].text);
            EXPECT_EQ(a[i].left, b[i].left);
        }
    }
}

TEST(Plot, ScaleTwoDoublesEveryLength) {
    for (const Figure& figure : all_figures()) {
        const Page once = compose(figure, {800, 450}, light), twice = compose(figure, {1600, 900}, light, 2);
        EXPECT_EQ(2 * once.scale, twice.scale);
        ASSERT_EQ(once.items.size(), twice.items.size());
        for (std::size_t i = 0; i < once.items.size(); ++i) {
            ASSERT_EQ(once.items[i].index(), twice.items[i].index());
            if (const auto* label = std::get_if<Label>(&once.items[i])) {
                const auto& other = std::get<Label>(twice.items[i]);
                EXPECT_EQ(label->anchor.x, other.anchor.x);
                EXPECT_EQ(label->size, other.size);
            }
            if (const auto* image = std::get_if<Image>(&once.items[i]); image && !image->within) {
                const auto& other = std::get<Image>(twice.items[i]);
                EXPECT_NEAR(image->at.right, other.at.right, 0.51);  // drawn for smaller pixels
                EXPECT_NEAR(2 * image->pixels->size.height, other.pixels->size.height, 2);
            }
        }
    }
}

TEST(Plot, LabelsAllNamedCurves) {
    auto words = words_in(composed(sweep(), {1600, 900}, light));
    for (const char* text :
         {"Chaos sets in near 63°", "by release angle", "Explicit Euler.", "exponent", "parted", "to compare with",
          "first chaos", "regular", "release angle θ1, °", "Lyapunov exponent λ, 1/s",
          "pairs parted within twenty seconds, %", "0", "45", "90", "135", "180"})
        EXPECT_GE(words[text], 1) << text;
    words = words_in(composed(convergence(), {480, 270}, dark));
    for (int order = 1; order <= 8; ++order) EXPECT_EQ(words["order " + std::to_string(order)], 1) << order;
}

TEST(Plot, ReportsTextsLeftOut) {
    const Figure figure{.title = "title", .subtitle = "subtitle", .panels = sweep().panels, .captions = {"caption"}};
    EXPECT_TRUE(compose(figure, {1600, 900}, light).notes.empty());
    using Notes = std::vector<std::string>;
    EXPECT_EQ(compose(figure, {609, 300}, light, 1, 1.0f).notes, (Notes{"there is no space for the captions"}));
    EXPECT_EQ(compose(figure, {609, 260}, light, 1, 1.0f).notes,
              (Notes{"there is no space for the subtitle and the captions"}));
    EXPECT_EQ(compose(figure, {480, 180}, light, 1, 1.0f).notes.back(),
              "text is reduced to 0.71 times its size for lack of space");
}

TEST(Plot, TextOnPaperIsAsHighAsAskedFor) {
    // 8.6 cm with labels of 20 px as 8 pt: 609 px; the height for 16:9
    const auto page = compose(sweep(), {609, 343}, light, 1, 1.0f);
    EXPECT_EQ(page.scale, 1);
    float minimum = 1e9f;
    for (const auto& label : items_of<Label>(page.items)) minimum = std::min(minimum, label.size);
    EXPECT_GE(minimum, 0.72f * 20 - 0.01f);  // the label of a grey curve in little space; all others are larger
}

TEST(Plot, ManyPanelsInASmallPictureKeepTheirCurves) {
    Figure figure{.title = "twelve"};
    for (int i = 0; i < 12; ++i)
        figure.panels.push_back({.title = "panel",
                                 .x = {.label = "x"},
                                 .y = {.label = "y"},
                                 .curves = {Curve{.x = {0, 1, 2}, .y = {0, 1, 0}}}});
    for (const Size size : {Size{1600, 900}, Size{480, 270}, Size{320, 180}})
        EXPECT_EQ(items_of<Polylines>(composed(figure, size, light)).size(), 12u) << size.width;
}

}  // namespace doppel::plot_test
