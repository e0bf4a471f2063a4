#include "plot/axis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace doppel::ticks_test {

/// The number that a label shows: "−1.5 × 10⁻⁷", "10⁻⁴", "0.30".
double read(std::string text) {
    const auto replace = [&](std::string_view from, std::string_view to) {
        for (std::size_t at; (at = text.find(from)) != std::string::npos;) text.replace(at, from.size(), to);
    };
    replace("−", "-");
    replace("⁻", "-");
    const std::string_view raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    const std::string before = text;
    for (int digit = 0; digit < 10; ++digit) replace(raised[digit], std::to_string(digit));
    if (text == before) return std::stod(text);
    const std::size_t cross = text.find(" × 10");
    const std::string power = text.substr(cross == std::string::npos ? 2 : cross + 6);
    return (cross == std::string::npos ? 1.0 : std::stod(text.substr(0, cross))) * std::pow(10.0, std::stoi(power));
}

void expect_sound(const Axis& axis, const TickLabels& words, const std::vector<Tick>& ticks) {
    const double low = std::min(axis.low, axis.high), high = std::max(axis.low, axis.high);
    std::set<std::string> texts;
    const Tick* before = nullptr;
    for (std::size_t i = 0; i < ticks.size(); ++i) {
        ASSERT_GE(ticks[i].value, low);
        ASSERT_LE(ticks[i].value, high);
        ASSERT_TRUE(i == 0 || ticks[i].value > ticks[i - 1].value);
        if (ticks[i].text.empty()) continue;
        ASSERT_TRUE(texts.insert(ticks[i].text).second) << ticks[i].text;
        if (before) {
            const float apart = std::abs(axis.at(ticks[i].value) - axis.at(before->value));
            const float need = (words.length(before->text) + words.length(ticks[i].text)) / 2 + words.gap;
            ASSERT_GE(apart, need) << before->text << " " << ticks[i].text;
            const double step = ticks[i].value - before->value;
            ASSERT_NEAR(read(ticks[i].text), ticks[i].value, std::abs(step) / 2) << ticks[i].text;
            ASSERT_NEAR(read(before->text), before->value, std::abs(step) / 2) << before->text;
        }
        before = &ticks[i];
    }
}

/// Random ranges of all sizes and signs; logarithmic ones of up to 300 decades.
Axis any_axis(std::mt19937& random, int trial, bool logarithmic) {
    const auto between = [&](double a, double b) { return std::uniform_real_distribution(a, b)(random); };
    Axis axis{.from = 0, .to = static_cast<float>(between(60, 1500)), .logarithmic = logarithmic};
    if (logarithmic) {
        axis.low = std::pow(10, trial % 4 == 0 ? between(-300, 290) : between(-14, 4));
        const double decades = trial % 4 == 0 ? between(0, 300) : between(0.05, 20);
        axis.high = std::pow(10, std::min(std::log10(axis.low) + decades, 305.0));
    } else {
        const double size = std::pow(10, trial % 4 == 0 ? between(-300, 300) : between(-12, 12));
        const double middle = trial % 3 == 0 ? 0 : size * std::pow(10, between(-2, 6)) * (random() % 2 ? 1 : -1);
        axis.low = middle - size * between(0, 1), axis.high = middle + size * between(0.01, 1);
    }
    if (random() % 3 == 0) std::swap(axis.low, axis.high);
    return axis;
}

TEST(ChartTicks, AreValidForAnyRange) {
    std::mt19937 random(2026);
    for (int trial = 0; trial < 5000; ++trial) {
        const bool logarithmic = trial % 2 == 1;
        const Axis axis = any_axis(random, trial / 2, logarithmic);
        SCOPED_TRACE(testing::Message() << axis.low << " … " << axis.high);
        const TickLabels words{.size = 12, .gap = 8, .spacing = 30, .across = random() % 2 == 0};
        const auto ticks = chart_ticks(axis, words);
        ASSERT_NO_FATAL_FAILURE(expect_sound(axis, words, ticks));
        if (logarithmic) {
            const auto named = std::count_if(ticks.begin(), ticks.end(), [](const Tick& t) { return !t.text.empty(); });
            const bool has_room = axis.to > 6 * 30 && std::abs(std::log10(axis.high / axis.low)) > 2.1;
            ASSERT_TRUE(words.across || !has_room || named >= 2);
        } else {
            // equal steps, up to the rounding of the values
            for (std::size_t i = 2; i < ticks.size(); ++i)
                ASSERT_NEAR(
                    ticks[i].value - ticks[i - 1].value, ticks[1].value - ticks[0].value,
                    1e-9 * std::abs(axis.high - axis.low) + 1e-15 * std::max(std::abs(axis.low), std::abs(axis.high)));
            // five times the length of one label has space for two, whatever the range
            ASSERT_TRUE(words.across || axis.to < 5 * 30 || ticks.size() >= 2);
        }
    }
}

using Texts = std::vector<std::string>;

Texts texts_of(const std::vector<Tick>& ticks) {
    Texts all;
    for (const Tick& tick : ticks)
        if (!tick.text.empty()) all.push_back(tick.text);
    return all;
}

Texts texts(const Axis& axis, std::optional<double> every = {}, TickLabels words = {.across = false}) {
    return texts_of(chart_ticks(axis, words, every));
}

TEST(ChartTicks, ReadAsPeopleWrite) {
    EXPECT_EQ(texts({0, 0.5, 0, 300}), (Texts{"0.0", "0.1", "0.2", "0.3", "0.4", "0.5"}));
    EXPECT_EQ(texts({-1, 1, 0, 300}), (Texts{"−1.0", "−0.5", "0.0", "0.5", "1.0"}));
    EXPECT_EQ(texts({0, 180, 0, 500}, 45), (Texts{"0", "45", "90", "135", "180"}));
    EXPECT_EQ(texts({0, 180, 0, 130}, 45), (Texts{"0", "90", "180"}));
    EXPECT_EQ(texts({0, 3e-7, 0, 170}), (Texts{"0", "1 × 10⁻⁷", "2 × 10⁻⁷", "3 × 10⁻⁷"}));
    EXPECT_EQ(texts({1e-4, 1e-1, 0, 300, true}), (Texts{"10⁻⁴", "10⁻³", "10⁻²", "10⁻¹"}));
    EXPECT_EQ(texts({1e-16, 1, 0, 300, true}), (Texts{"10⁻¹⁵", "10⁻¹²", "10⁻⁹", "10⁻⁶", "10⁻³", "1"}));
    EXPECT_EQ(texts({0.1, 2, 0, 400, true}), (Texts{"0.1", "0.2", "0.5", "1", "2"}));
    EXPECT_EQ(texts({1, 100, 0, 300, true}, 30), (Texts{"1", "10", "10²"}));
}

TEST(ChartTicks, AreFewWhereValuesCannotBeDistinguished) {
    EXPECT_TRUE(texts({1, 1, 0, 300}).empty());
    EXPECT_TRUE(texts({1e10, 1e10 + 1e-300, 0, 300}).empty());
    EXPECT_TRUE(texts({0, 1, 0, 0}).empty());
    EXPECT_TRUE(texts({0, std::nan(""), 0, 100}).empty());
    EXPECT_GE(texts({-1.7e308, 1.7e308, 0, 300}).size(), 2u);
    EXPECT_GE(texts({1e10, 1e10 + 1e-3, 0, 300}).size(), 2u);
}

TEST(Axis, MapsAndClampsToItsEnds) {
    const Axis inverted{10, -10, 100, 300}, decades{1e-300, 1e300, 0, 600, true}, huge{-1.7e308, 1.7e308, 0, 2};
    EXPECT_FLOAT_EQ(inverted.at(10), 100);
    EXPECT_FLOAT_EQ(inverted.at(-5), 250);
    EXPECT_FLOAT_EQ(inverted.at(-50), 300);
    EXPECT_FLOAT_EQ(decades.at(1), 300);
    EXPECT_FLOAT_EQ(decades.at(0), 0);
    EXPECT_FLOAT_EQ(huge.at(0), 1);
    EXPECT_FLOAT_EQ((Axis{3, 3, 0, 10}.at(3)), 5);
}

TEST(ChartTicks, TakeTheSmallestStepThatLeavesTheSpacing) {
    const TickLabels words{.gap = 0, .spacing = 90};
    const auto ticks = chart_ticks({0, 30, 0, 1600}, words);
    ASSERT_EQ(ticks.size(), 16u);
    EXPECT_EQ(ticks[1].text, "2");
    EXPECT_EQ(chart_ticks({0, 1, 0, 1000}, words)[3].text, "0.3");
}

/// The labels beside a strip of a film, 216 px high.
Texts beside_strip(double low, double high, bool logarithmic) {
    return texts_of(spaced_ticks({low, high, 0, 216, logarithmic}, false, 27));
}

TEST(ChartTicks, OfAFewDecadesAreEnoughToReadValuesBy) {
    EXPECT_EQ(beside_strip(0.7, 7.1, true), (Texts{"1", "2", "5"}));
    EXPECT_EQ(beside_strip(0.2, 5, true), (Texts{"0.2", "0.5", "1", "2", "5"}));
    EXPECT_EQ(beside_strip(0.15, 9, true), (Texts{"0.3", "1", "3"}));
    EXPECT_EQ(beside_strip(1e-24, 30, true), (Texts{"10⁻²⁰", "10⁻¹⁰", "1"}));
    EXPECT_EQ(beside_strip(-170, 220, false), (Texts{"−100", "0", "100", "200"}));
}

TEST(ChartTicks, AreTwoWhereOneRoundNumberWouldBeAlone) {
    const TickLabels words{.gap = 10, .spacing = 30, .across = false};
    EXPECT_EQ(texts({-3.3, 3.3, 0, 60}, {}, words), (Texts{"−2", "2"}));
    EXPECT_EQ(texts({-9, 4, 0, 60}, {}, words), (Texts{"−8", "4"}));
    EXPECT_EQ(texts({-3.3, 3.3, 0, 25}, {}, words), (Texts{"0"}));
}

TEST(ChartTicks, AreTheGivenOnesWhereTheirLabelsFit) {
    std::vector<Tick> own;
    for (const double value : {0.25, 0.5, 1.0, 2.0, 4.0}) own.push_back(tick_at(value));
    const auto beside = [&](float length) {
        return texts_of(spaced_ticks({0.2, 5, 0, length, true}, false, 18, {}, own));
    };
    EXPECT_EQ(beside(300), (Texts{"0.25", "0.5", "1", "2", "4"}));
    EXPECT_EQ(beside(90), (Texts{"0.3", "1", "3"}));
    EXPECT_EQ(tick_at(-0.00002).text, "−2 × 10⁻⁵");
}

TEST(AxisItems, HaveNumbersInTheMarginAndTheirUnitAfterTheLast) {
    const Axis time{0, 30, 40, 560};
    const Area area{40, 10, 560, 200}, within{0, 0, 600, 240};
    AxisStyle look{.edge = AxisStyle::Edge::bottom, .em = 20, .unit = " s"};
    const auto ticks = spaced_ticks(time, true, 20);
    const auto last_of = [&](const Area& around) {
        std::string text;
        for (const auto& item : axis_items(time, ticks, area, around, look))
            if (const auto* label = std::get_if<Label>(&item)) text = label->text;
        return text;
    };
    EXPECT_EQ(last_of(within), "30 s");
    EXPECT_NE(last_of({0, 0, 565, 240}), "30 s") << "it would leave the margin";
    look.line = 0;
    for (const auto& item : axis_items(time, ticks, area, within, look))
        EXPECT_TRUE(std::holds_alternative<Label>(item));
}

TEST(Ticks, TwoLinesOfTextAreEnoughForTwoLabels) {
    std::mt19937 random(5);
    for (int trial = 0; trial < 2000; ++trial) {
        constexpr float em = 20;
        auto axis = any_axis(random, 1 + trial % 2, trial % 2 == 0);
        axis.to = 2 * em;
        const auto ticks = spaced_ticks(axis, false, em);
        const Tick *first = nullptr, *last = nullptr;
        for (const auto& tick : ticks)
            if (!tick.text.empty()) last = &tick, first = first ? first : last;
        ASSERT_NE(first, last) << axis.low << " " << axis.high;
        EXPECT_GE(std::abs(axis.at(first->value) - axis.at(last->value)), em) << axis.low << " " << axis.high;
    }
}

}  // namespace doppel::ticks_test
