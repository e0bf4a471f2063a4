#include "film/strips.hpp"

#include "film/words.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace doppel::strips_test {

/// The label of a picture that begins with `start`.
std::optional<Label> label_of(const std::vector<Label>& labels, const std::string& start) {
    const auto found = std::ranges::find_if(labels, [&](const Label& label) { return label.text.starts_with(start); });
    return found == labels.end() ? std::nullopt : std::optional(*found);
}

TEST(Strips, TheLastTimeStandsBelowItsTick) {
    for (const char* size : {"[1920, 1080]", "[480, 270]", "[720, 406]"}) {
        const auto scene = scene_of("butterfly", {fmt::format("video.size={}", size)});
        const auto layout = make_layout(scene);
        const auto labels = labels_of(scene, 0);
        const auto last = label_of(labels, "30 s");
        ASSERT_TRUE(last) << size;
        const float half = text_width("30", last->size) / 2, unit = text_width(" s", last->size);
        EXPECT_NEAR(last->anchor.x - unit - half, layout.strips[0].time.at(30), 3 * layout.text + 2) << size;
        EXPECT_TRUE(label_of(labels, "20")) << size << ": the label beside it has room";
    }
}

const std::vector<std::string> films{
    "butterfly",    "calm",       "damped",   "driven",      "fan",      "horizon", "kapitza",
    "loop",         "mass-ratio", "measured", "phase-dance", "raindrop", "rods",    "single-and-double",
    "slow-parting", "springs",    "triple",   "two-methods", "whip",     "whip-256"};

/// The film of a preset up to its first samples.
Scene beginning(const std::string& film, std::vector<std::string> keys) {
    if (film != "measured") keys.emplace_back("scene.duration_s=3");
    if (film == "whip-256") keys.emplace_back("system.integrator=\"taylor\"");
    return scene_of(film, keys);
}

TEST(Strips, EachHasAFifthOfThePictureAndEachWordNinePixels) {
    const auto check = [](const Scene& scene, const std::string& what) {
        const auto layout = make_layout(scene);
        float together = 0;
        const auto fifth = 0.197f * static_cast<float>(scene.preset.video.size.height);  // in whole pixels
        for (const auto& strip : layout.strips) {
            together += strip.area.height();
            if (!is_tall(scene.preset.video)) {
                EXPECT_GE(strip.area.height(), fifth) << what;
            }
        }
        EXPECT_GE(together, fifth) << what;
        const auto labels = labels_of(scene, 60);
        for (const auto& label : labels) {
            EXPECT_GE(label.size, 8.999f) << what << label.text;
            EXPECT_LE(box_of(label).right, layout.page.right + 1) << what << label.text;
        }
        expect_apart(labels, scene.preset.video.size, what);
    };
    for (const auto& film : films)
        for (const char* size : {"[1920, 1080]", "[640, 360]"})
            check(beginning(film, {fmt::format("video.size={}", size)}), fmt::format("{} {}: ", film, size));
    for (const char* film : {"pendulum-portrait", "kapitza", "raindrop", "slow-parting"})
        check(beginning(film, {"video.layout=\"portrait\"", "video.size=[390, 694]"}),
              fmt::format("{} on a phone: ", film));
}

TEST(Strips, LongWordsGoOnBelowOrEndEarly) {
    const auto scene =
        scene_of("butterfly", {"video.size=[640, 360]",
                               "title=\"Two pendulums that begin three thousandths of a degree apart, and "
                               "what becomes of them within half a minute of swinging\"",
                               "a.note=\"with a note that is a good deal longer than the half of the "
                               "picture above which it stands in a film\""});
    const auto labels = labels_of(scene, 0);
    expect_apart(labels, {640, 360}, "");
    for (const auto& label : labels) EXPECT_GE(label.size, 8.999f) << label.text;
    EXPECT_TRUE(label_of(labels, "Two pendulums"));
    EXPECT_TRUE(std::ranges::any_of(labels, [](const Label& label) { return label.text.ends_with(" …"); }));
}

TEST(Strips, LogarithmicOnesOfADecadeHaveNumbersAt1And2And5) {
    const auto labels = labels_of(scene_of("butterfly", {"video.distance_range=[0.7, 7.1]"}), 0);
    for (const char* number : {"1", "2", "5"})
        EXPECT_TRUE(std::ranges::any_of(labels, [&](const Label& label) { return label.text == number; })) << number;
}

TEST(Strips, WhenTheyDivergedStandsAtItsLine) {
    for (const auto& [film, size, sample] : {std::tuple("butterfly", "[1920, 1080]", 16 * 120),
                                             {"butterfly", "[480, 270]", 16 * 120},
                                             {"pendulum-portrait", "[1080, 1920]", 14 * 120},
                                             {"fan", "[1920, 1080]", 12 * 120}}) {
        const auto scene = scene_of(film, {fmt::format("video.size={}", size)});
        const auto layout = make_layout(scene);
        const auto words = label_of(labels_of(scene, sample), "diverged");
        ASSERT_TRUE(words) << film;
        Outcome outcome;
        for_each_snapshot(scene, sample, [&](const Snapshot& seen) { outcome.add(scene, seen.pair); });
        const double since = outcome.divergence.since().value_or(0);
        const auto& strip = layout.strips[0];
        const auto box = box_of(*words);
        EXPECT_TRUE(strip.area.contains(box)) << film << size;
        EXPECT_LT(std::abs(box.left - strip.time.at(since)), 14 * layout.text + 1) << film << size;
    }
}

/// The place in the list of the first item that passes the test; its size if there is none.
template <class Kind, class Test>
std::size_t place_of(const DisplayList& list, Test&& passes) {
    std::size_t place = 0;
    while (place < list.size() && items_in<Kind>({list[place]}, passes).empty()) ++place;
    return place;
}

/// The curves in a strip, with their places in the list.
std::vector<std::pair<std::size_t, Stroke>> curves_in(const Area& area, const DisplayList& list) {
    std::vector<std::pair<std::size_t, Stroke>> curves;
    for (std::size_t i = 0; i < list.size(); ++i)
        if (const auto* stroke = std::get_if<Stroke>(&list[i]); stroke && !stroke->vertices.empty())
            if (area.contains(stroke->vertices.front().at)) curves.emplace_back(i, *stroke);
    return curves;
}

TEST(Strips, NoLineCrossesTheWordsOfMarks) {
    const auto scene = scene_of("single-and-double");
    const auto area = make_layout(scene).strips[0].area;
    const auto list = composed(scene, 12 * 120)->frame();
    const auto words = place_of<Label>(list, [](const Label& label) { return label.text.starts_with("diverged"); });
    const auto curves = curves_in(area, list);
    ASSERT_EQ(curves.size(), 1u);
    ASSERT_LT(words, list.size());
    EXPECT_GT(words, curves[0].first);
    // the cursor, a line of the strip's height
    EXPECT_LT(place_of<Box>(list,
                            [&](const Box& box) {
                                return box.color == themes[0].cursor && box.top == area.top &&
                                       box.bottom == area.bottom;
                            }),
              words);
}

TEST(Strips, CurvesAreSeenBehindTheWordsOfMarks) {
    const auto scene = scene_of("horizon", {"video.size=[390, 844]"});
    const auto list = composed(scene, 20 * 120)->frame();
    const auto curves = curves_in(make_layout(scene).strips[0].area, list);
    ASSERT_EQ(curves.size(), 1u);
    const auto ground = themes[0].background.with_alpha(0.85f);
    EXPECT_LT(place_of<Box>(list, [&](const Box& box) { return box.color == ground; }), curves[0].first);
    const auto words = place_of<Label>(
        list, [](const Label& label) { return label.text.find("predictability") != std::string::npos; });
    EXPECT_LT(curves[0].first, words);
    EXPECT_LT(words, list.size());
}

TEST(Strips, OfRodErrorsSayWhereThereAreNone) {
    for (const std::string model : {"angles", "constraints"}) {
        const auto scene =
            scene_of("butterfly", {"system.model=" + model, "video.panels=[\"pendulums\", \"rod-error\"]"});
        EXPECT_EQ(label_of(labels_of(scene, 60), "none: angles keep the lengths").has_value(), model == "angles");
    }
}

TEST(Strips, DistancesHaveTwoDigits) {
    const auto scene = scene_of("triple", {});
    EXPECT_TRUE(label_of(labels_of(scene, 10 * 120), "6.0"));
}

TEST(Strips, NarrowHeadingsKeepTheNumber) {
    const auto labels = [](const char* film, std::vector<std::string> keys = {}) {
        keys.emplace_back("video.size=[320, 180]");
        return labels_of(scene_of(film, keys), 0);
    };
    for (const auto& [film, words] :
         {std::pair("fan", "120°"), {"fan", "120.1°"}, {"springs", "… in place"}, {"springs", "… 1 mm to"}})
        EXPECT_TRUE(label_of(labels(film), words)) << words;
    EXPECT_TRUE(label_of(labels("kapitza", {"a.note=\"a b = the end of a long note\""}), "a b"));
}

TEST(Strips, ACurveBeginsWhereItEntersItsAxis) {
    // both start at the same place: the distance is 0, then below the axis for 0.17 s
    const auto scene = scene_of("single-and-double");
    const auto strip = make_layout(scene).strips[0];
    const auto curves = curves_in(strip.area, composed(scene, 12 * 120)->frame());
    ASSERT_EQ(curves.size(), 1u);
    const auto& points = curves[0].second.vertices;
    EXPECT_GT(points.front().at.x, strip.time.at(0.1));
    EXPECT_LT(points.front().at.x, strip.time.at(0.3));
    // and later it stays above the text of the divergence, below the limit of which the axis has a decade
    const auto words = label_of(labels_of(scene, 12 * 120), "diverged at 0.4 s");
    ASSERT_TRUE(words);
    for (const auto& point : points)
        EXPECT_FALSE(point.at.x > words->anchor.x && point.at.y > words->anchor.y - words->size) << point.at.x;
}

TEST(Strips, TextsOfMarksStandWhereTheyCoverLessOfTheCurve) {
    // left of a rising curve at the top, under one that has risen at the foot, each on its own
    for (const auto& [film, seconds, is_left] : {std::tuple("horizon", 35, true), {"pendulum-portrait", 20, false}}) {
        const auto scene = scene_of(film, {"video.size=[1080, 1920]"});
        const auto area = make_layout(scene).strips[0].area;
        const auto labels = labels_of(scene, seconds * 120);
        for (const char* words : {"numerical", "diverged"}) {
            const auto text = label_of(labels, words);
            ASSERT_TRUE(text) << film;
            const bool is_at_top = is_left && words == std::string("numerical");
            EXPECT_EQ(text->anchor.y < (area.top + area.bottom) / 2, is_at_top) << film << words;
        }
    }
}

TEST(Strips, CaptionsOfNarrowStripsShrinkOrSayThatTheyAreCut) {
    const auto labels = labels_of(
        scene_of("butterfly", {"video.size=[1280, 720]",
                               "video.panels=[\"pendulums\", \"distance\", \"exponent\", \"energy\", \"rod-error\", "
                               "\"rod-force\", \"energies-a\", \"energies-b\", \"angles\", \"rates\"]"}),
        120);
    const auto whole = label_of(labels, "energy error, of the potential range"), cut = label_of(labels, "potential");
    ASSERT_TRUE(whole && cut);
    EXPECT_LT(whole->size, label_of(labels, "angles, °")->size);
    EXPECT_TRUE(cut->text.ends_with(" …")) << cut->text;
}

TEST(Strips, ACurveIsCutWhereItLeavesItsAxis) {
    const auto scene = scene_of("butterfly", {"video.panels=[\"pendulums\", \"angles\"]", "scene.duration_s=4",
                                              "video.angles_range=[-45, 45]"});
    const auto strip = make_layout(scene).strips[0];
    for (const auto& [index, stroke] : curves_in(strip.area, composed(scene, 4 * 120)->frame())) {
        const auto& points = stroke.vertices;
        for (std::size_t i = 1; i < points.size(); ++i)
            EXPECT_FALSE(points[i].at.x > points[i - 1].at.x + 2 && points[i].at.y == points[i - 1].at.y &&
                         (points[i].at.y <= strip.area.top || points[i].at.y >= strip.area.bottom))
                << index << " " << i;
    }
}

TEST(Strips, TheProvedTimeOfDivergenceStandsBesideThatOfTheRun) {
    const auto scene = scene_of("butterfly", {"scene.certify=true", "scene.duration_s=17"});
    std::string words;  // in rows, because the line at which the proof ends is near
    for (const auto& label : labels_of(scene, 17 * 120)) words += label.text + " ";
    EXPECT_NE(words.find("diverged at 14.2 s, the true motions at 15.3 s"), std::string::npos) << words;
}

TEST(Strips, OfSeveralMarksThatOfTheDivergenceStaysInALowStrip) {
    const auto scene =
        scene_of("pendulum-portrait", {"video.panels=[\"pendulums\", \"distance\", \"exponent\", \"energies-a\"]"});
    const auto area = make_layout(scene).strips[0].area;
    const auto labels = labels_of(scene, 20 * 120);
    const auto words = label_of(labels, "diverged at");
    ASSERT_TRUE(words);
    EXPECT_TRUE(area.contains(box_of(*words)));
    EXPECT_FALSE(label_of(labels, "numerical"));
}

TEST(Strips, LimitsAreNamedForWhatTheyAre) {
    const auto scene = scene_of("horizon", {"video.model_limit_s=5.3", "video.size=[960, 540]"});
    const auto layout = make_layout(scene);
    const auto labels = labels_of(scene, 0);
    EXPECT_FALSE(label_of(labels, "predictable"));
    const auto numerical = label_of(labels, "numerical predictability limit 3"),
               model = label_of(labels, "predictability limit of the model 5.3 s");
    ASSERT_TRUE(numerical);
    ASSERT_TRUE(model);
    EXPECT_TRUE(layout.strips[0].area.contains(box_of(*numerical)));
    EXPECT_NEAR(model->anchor.x, layout.strips[0].time.at(5.3), 10 * layout.text + 1);
    expect_apart(labels, {960, 540}, "");
    // no grid line crosses the text
    const auto picture = frame_of(scene, 0);
    const int y = static_cast<int>(numerical->anchor.y - 0.3f * numerical->size),
              x = static_cast<int>(numerical->anchor.x) - 2;
    for (int up = -3; up < 3; ++up) EXPECT_LT(picture.at(x, y + up)[0], 0x18) << up;
}

TEST(Strips, OneSideDoesNotCoverTheOther) {
    // both pendulums have the same curve
    for (const char* panel : {"angles", "rates", "rod-force", "total-energy", "rod-error"}) {
        const auto scene = scene_of("butterfly", {fmt::format("video.panels=[\"pendulums\", \"{}\"]", panel),
                                                  "system.model=\"constraints\"", "scene.duration_s=4"});
        const Drawn film(scene, 240);
        const auto& strip = film.layout.strips[0];
        for (const auto& color : themes[0].sides) {
            int seen = 0;
            for (float y = strip.area.top - 2; y < strip.area.bottom + 3; ++y)
                seen += film.has({strip.time.at(1.3), y}, color, 60);
            EXPECT_GE(seen, 1) << panel;
        }
    }
}

TEST(Strips, TheEnergyOfADrivenSideIsAMeanOverItsPeriod) {
    const auto scene = scene_of("kapitza", {"scene.duration_s=3"});
    Spread raw, mean;
    for_each_snapshot(scene, scene.samples, [&](const Snapshot& seen) {
        const auto value = strip_curves(StripKind::total_energy, scene, seen.pair, 0)[0].value;
        EXPECT_EQ(value.has_value(), scene.time(seen.pair.sample) >= 1 / 15.76) << seen.pair.sample;
        if (!value) return;
        raw.low = std::min(raw.low, seen.pair.a.energy), raw.high = std::max(raw.high, seen.pair.a.energy);
        if (mean.high == 0) mean.low = *value;
        mean.low = std::min(mean.low, *value), mean.high = std::max(mean.high, *value);
    });
    EXPECT_LT(mean.high - mean.low, 0.15 * (raw.high - raw.low));  // measured 0.09
    // a steady motor has no period, a slow one has none in this time
    for (const char* hz : {"0", "0.3"}) {
        const auto steady =
            scene_of_text(fmt::format("[scene]\nduration_s = 3\n[[system.torque]]\njoint = 1\n"
                                      "amplitude_N_m = 1\nfrequency_hz = {}\n",
                                      hz));
        PairRun pair(steady);
        EXPECT_TRUE(strip_curves(StripKind::total_energy, steady, pair.next(never_stopped), 0)[0].value) << hz;
    }
    PeriodMean of_line(0.5);  // the mean of a straight line is its value half a period ago, at samples and between them
    for (int n = 0; n <= 10; ++n) of_line.add(0.12 * n, 3 + 0.12 * n);
    EXPECT_NEAR(*of_line.at(1.2, 4.2), 3.95, 1e-14);
    EXPECT_NEAR(*of_line.at(1.27, 4.27), 4.02, 1e-14);
}

TEST(Strips, PotentialEnergyCountsFromTheLowestPoint) {
    const auto scene =
        scene_of("butterfly", {"system.mass_kg=[2, 3]", "system.length_m=[0.5, 0.25]", "system.angle_deg=[0, 60]",
                               "b.angle_deg=[0, 0]", "system.omega_deg_per_s=[0, 0]"});
    PairRun pair(scene);
    const auto start = pair.next(never_stopped);
    const auto potential = [&](StripKind kind) { return *strip_curves(kind, scene, start, 0)[1].value; };
    EXPECT_NEAR(potential(StripKind::energies_a), 3 * 9.8 * 0.25 / 2, 1e-12);
    EXPECT_NEAR(potential(StripKind::energies_b), 0, 1e-12);
}

TEST(Strips, CaptionsDoNotTouchTheirAxis) {
    for (const char* size : {"[1920, 1080]", "[720, 406]", "[480, 270]"})
        for (const char* film : {"slow-parting", "two-methods", "raindrop"}) {
            const auto scene = scene_of(film, {fmt::format("video.size={}", size), "scene.duration_s=3"});
            const auto layout = make_layout(scene);
            const auto labels = labels_of(scene, 60);
            for (const auto& strip : layout.strips)
                for (const auto& label : labels)
                    if (label.anchor.y <= strip.area.top && label.anchor.y > strip.cell.top &&
                        label.anchor.x >= strip.cell.left && label.anchor.x < strip.area.left) {
                        EXPECT_LE(box_of(label).bottom, strip.area.top - 0.6f * px(layout.style.font.axis))
                            << film << size << label.text;
                    }
        }
}

TEST(Strips, AxesHaveTrueMinusSigns) {
    for (const auto& label : labels_of(scene_of("phase-dance", {"scene.duration_s=1"}), 60))
        EXPECT_EQ(label.text.starts_with('-'), false) << label.text;
}

TEST(Strips, OfATransparentFilmLetThePageThrough) {
    const auto scene =
        scene_of("butterfly", {"video.transparent=true", "video.format=\"png\"", "video.size=[480, 270]"});
    const auto layout = make_layout(scene);
    EXPECT_LT(layout.style.theme.grid.a, 0.5f);
    EXPECT_LT(layout.style.theme.panel.a, 0.2f);
    const auto own = make_layout(
        scene_of("butterfly", {"video.transparent=true", "video.format=\"png\"", "video.colors.grid=\"#ff0000\""}));
    EXPECT_EQ(own.style.theme.grid.a, 1);
}

/// The lines of marks that a text crosses.
void expect_to_cross_no_mark(const Layout& layout, const std::vector<Label>& labels, const std::vector<double>& times) {
    const auto& strip = layout.strips[0];
    for (const auto& label : labels)
        for (const double time : times) {
            const auto box = box_of(label);
            const float x = strip.time.at(time);
            EXPECT_FALSE(strip.area.overlaps(box) && box.left < x && x < box.right) << label.text << time;
        }
}

TEST(Strips, TextsOfMarksCrossNoLineAndNoCurve) {
    for (const auto* size : {"[1080, 1920]", "[1920, 1080]"}) {
        const auto scene = scene_of("horizon", {fmt::format("video.size={}", size)});
        const auto composer = composed(scene, scene.samples);
        const auto layout = make_layout(scene);
        const auto labels = labels_in({composer->backdrop(), composer->frame()});
        ASSERT_TRUE(label_of(labels, "diverged")) << size;
        ASSERT_TRUE(label_of(labels, "numerical")) << size;
        expect_to_cross_no_mark(layout, labels, {*scene.horizon(), 32.3});
        const auto curve = items_in<Stroke>(
            composer->frame(), [&](const Stroke& stroke) { return stroke.color == layout.style.theme.trace; });
        ASSERT_FALSE(curve.empty());
        for (const auto& label : labels) {
            auto ink = box_of(label);
            if (label.text.find_first_of("gpqy") == std::string::npos) ink.bottom = label.anchor.y;
            for (const auto& vertex : curve[0].vertices)
                EXPECT_FALSE(layout.strips[0].area.overlaps(ink) && ink.contains(vertex.at)) << size << label.text;
        }
    }
}

TEST(Strips, EachUprightOneOfFiveHasTwoNumbers) {
    const auto scene = scene_of(
        "butterfly", {"video.size=[1080, 1920]",
                      "video.panels=[\"pendulums\", \"energy\", \"distance\", \"exponent\", \"angles\", \"rates\"]"});
    const auto layout = make_layout(scene);
    for (const auto& strip : layout.strips) {
        const float em = px(layout.style.font.axis);
        ASSERT_GT(strip.area.height(), 2 * em);
        const auto ticks = spaced_ticks(strip.value, false, em);
        EXPECT_GE(std::ranges::count_if(ticks, [](const Tick& tick) { return !tick.text.empty(); }), 2)
            << name_of(strip.kind);
    }
    EXPECT_TRUE(label_of(labels_of(scene, 16 * 120), "diverged")) << "smaller, where it would not fit";
}

TEST(Strips, OnLightNoColourLooksBlackAndAllCanBeSeen) {
    const auto scene = scene_of("butterfly", {"video.theme=light"});
    const auto style = make_layout(scene).style;
    const auto luminance = [](const Color& color) {
        const auto decode = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
        return 0.2126 * decode(color.r) + 0.7152 * decode(color.g) + 0.0722 * decode(color.b);
    };
    std::vector<Color> colors;
    for (const auto kind : {StripKind::angles, StripKind::rates})
        for (const auto& curve : strip_curves(kind, scene, blank_snapshot(scene).pair, 1, style))
            colors.push_back(curve.color);
    for (const auto& curve : strip_curves(StripKind::energies_a, scene, blank_snapshot(scene).pair, 1, style))
        if (curve.name != "total") colors.push_back(curve.color);
    for (const auto& pendulum : shown_pendulums(scene, style)) {
        colors.insert(colors.end(), {pendulum.color, pendulum.rod, pendulum.bob});
        EXPECT_NE(pendulum.rod, style.theme.rod) << "each side has its hue";
    }
    for (int k = 0; k <= 8; ++k) colors.push_back(member_color(style.theme, k / 8.0));
    for (const auto& color : colors) {
        EXPECT_GT(luminance(color), 0.03) << hexadecimal(color);               // measured 0.04
        EXPECT_GT(1.05 / (luminance(color) + 0.05), 3) << hexadecimal(color);  // WCAG; measured 3.1
    }
}

TEST(Strips, ASmallFilmSaysWhatItLeavesOut) {
    const auto three = "video.panels=[\"pendulums\", \"energy\", \"distance\", \"exponent\"]";
    const auto tiny = scene_of("butterfly", {"video.size=[160, 90]", three});
    const auto composer = composed(tiny, 16 * 120);
    const auto labels = labels_in({composer->backdrop(), composer->frame()});
    expect_apart(labels, {160, 90}, "160 × 90");
    EXPECT_EQ(composer->left_out(), "") << "a thumbnail";
    const auto layout = make_layout(tiny);
    for (const auto& strip : layout.strips) EXPECT_GT(strip.area.height(), 6) << "curves can be seen";
    const auto small = scene_of("horizon", {"video.size=[390, 220]"});
    EXPECT_NE(composed(small, 40 * 120)->left_out().find("\"numerical predictability limit 31.3 s\""),
              std::string::npos);
    for (const char* title : {"a", "to be continued…"}) {
        const auto scene = scene_of("butterfly", {fmt::format("title={}", title)});
        EXPECT_EQ(composed(scene, 16 * 120)->left_out(), "") << title;
    }
}

TEST(Strips, AnUprightPhasePortraitHasThreeAnglesAndHalfTheWidth) {
    for (const char* film : {"driven", "phase-dance"}) {
        const auto scene = beginning(film, {"video.size=[1080, 1920]"});
        const auto layout = make_layout(scene);
        ASSERT_TRUE(layout.phase) << film;
        EXPECT_GT(layout.phase->panel.width(), 0.53f * layout.page.width()) << film;  // 0.49 before
        const auto labels = labels_of(scene, 0);
        for (const char* angle : {"−180", "0", "180"}) EXPECT_TRUE(label_of(labels, angle)) << film << angle;
    }
}

}  // namespace doppel::strips_test
