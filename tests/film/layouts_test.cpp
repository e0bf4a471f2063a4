#include "film/runs.hpp"
#include "film/strips.hpp"
#include "film/words.hpp"
#include "scene/resolved.hpp"

#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>

namespace doppel::layouts_test {

TEST(Layouts, NothingOverlapsAndAllIsOnThePage) {
    const std::vector<std::string> all{"\"distance\"",  "\"exponent\"",  "\"energy\"",
                                       "\"rod-error\"", "\"rod-force\"", "\"angles\""};
    for (const auto* layout_name : {"side-by-side", "overlay", "phase", "portrait", "ensemble"})
        for (const auto* size : {"[1920, 1080]", "[480, 270]", "[1080, 1920]", "[3840, 2160]"})
            for (std::size_t strips = 0; strips <= all.size(); ++strips) {
                std::string panels = "[\"pendulums\"";
                for (std::size_t i = 0; i < strips; ++i) panels += ", " + all[i];
                if (std::string(layout_name) == "portrait" && std::string(size) != "[1080, 1920]") continue;
                const auto scene = scene_of(
                    "butterfly", {fmt::format("video.layout=\"{}\"", layout_name), fmt::format("video.size={}", size),
                                  "video.panels=" + panels + "]", "scene.duration_s=1", "b.angle_deg=[60, -90]"});
                const auto layout = make_layout(scene);
                const auto what = fmt::format("{} {} {}", layout_name, size, strips);
                std::vector<Area> areas;
                for (const auto& panel : layout.panels) areas.push_back(panel.area);
                for (const auto& strip : layout.strips) areas.push_back(strip.area);
                const Area picture{0, 0, static_cast<float>(scene.preset.video.size.width),
                                   static_cast<float>(scene.preset.video.size.height)};
                for (std::size_t i = 0; i < areas.size(); ++i) {
                    EXPECT_TRUE(picture.contains(areas[i])) << what;
                    EXPECT_GT(areas[i].width(), 20) << what;
                    EXPECT_GT(areas[i].height(), 6) << what;
                    for (std::size_t j = 0; j < i; ++j)
                        EXPECT_FALSE(areas[i].overlaps(areas[j])) << what << ' ' << i << ' ' << j;
                }
                const auto labels = labels_of(scene, 60);
                ASSERT_GE(labels.size(), 4u) << what;  // title, subtitle, speed, clock
                expect_apart(labels, scene.preset.video.size, what);
                for (const auto& label : labels)
                    for (const auto& panel : layout.panels)
                        EXPECT_TRUE(panel.area.contains(box_of(label)) || !panel.area.overlaps(box_of(label)))
                            << what << ": " << label.text;
                if (std::string(size) == "[480, 270]" && strips <= 3) {
                    EXPECT_GE(2 * layout.reach, 0.45f * 270) << what;  // measured 0.57
                    for (const auto& strip : layout.strips) EXPECT_GE(strip.area.height(), 20) << what;
                }
                // the pendulums' circle stays inside its panel
                for (const auto& panel : layout.panels) {
                    const auto& [x, y] = panel.center;
                    EXPECT_TRUE(panel.area.contains(Point{x - layout.reach, y - layout.reach})) << what;
                    EXPECT_TRUE(panel.area.contains(Point{x + layout.reach, y + layout.reach})) << what;
                }
            }
}

TEST(Layouts, LargeTextsDoNotOverlap) {
    const FontSizes usual;
    for (const auto* layout : {"side-by-side", "overlay", "portrait"})
        for (const auto& [key, member, help] : font_size_names) {
            const auto set = fmt::format("video.fonts_px.{}={}", key, 2.4 * usual.*member);
            const auto scene = scene_of("butterfly", {fmt::format("video.layout=\"{}\"", layout), set,
                                                      "title=\"Two pendulums\"", "subtitle=\"Short\""});
            expect_apart(labels_of(scene, 60), scene.preset.video.size, fmt::format("{} {}", layout, set));
        }
}

TEST(Layouts, PhaseHeadIsAtItsAngleAndRate) {
    const Drawn film(scene_of("butterfly", {"video.layout=\"phase\"", "b.angle_deg=[-30, 300]",
                                            "system.omega_deg_per_s=[0, 120]", "video.trail_s=0.1"}));
    ASSERT_TRUE(film.layout.phase);
    const auto& [panel, area, angle, rate] = *film.layout.phase;
    EXPECT_TRUE(film.has({angle.at(90), rate.at(120)}, themes[0].sides[0]));
    EXPECT_TRUE(film.has({angle.at(-60), rate.at(120)}, themes[0].sides[1])) << "300° is −60°";
}

TEST(Layouts, SectionPointsLieWhereTheUpperLinkPassesUpwards) {
    // almost without gravity, both links turn together: ω1 is almost constant, and θ1 passes 0 once a turn
    const std::vector<std::string> arguments{
        "video.layout=\"phase\"",       "video.phase=\"section\"",           "video.phase_link=2",
        "system.gravity_m_per_s2=1e-9", "system.omega_deg_per_s=[360, 360]", "scene.duration_s=3",
        "system.integrator=\"taylor\""};
    const auto scene = scene_of("butterfly", arguments);
    const auto layout = make_layout(scene);
    const Point expected{layout.phase->angle.at(0), layout.phase->rate.at(360)};
    const auto color = mixed(themes[0].panel, themes[0].sides[0], 0.8f);
    EXPECT_FALSE(is_color(frame_of(scene, 80), expected, color, 40));  // it starts at 90°: 0.75 s to go
    EXPECT_TRUE(is_color(frame_of(scene, 100), expected, color, 40));
}

TEST(Layouts, EnsembleRunsFromOneSideToTheOther) {
    const auto scene = scene_of("fan", {"video.members=5", "scene.duration_s=1"});
    ASSERT_EQ(scene.members.size(), 5u);
    // its ends are the pair, bit for bit
    for_each_snapshot(scene, 60, [](const Snapshot& snapshot) {
        EXPECT_EQ(snapshot.members.front().back().x, snapshot.pair.a.bobs.back().x) << snapshot.pair.sample;
        EXPECT_EQ(snapshot.members.back().back().y, snapshot.pair.b.bobs.back().y) << snapshot.pair.sample;
    });
}

TEST(Layouts, ExponentSoFarIsTheSlopeOfTheLogarithm) {
    const auto scene = scene_of("butterfly");
    PairState state;
    state.distance = 1e-4 * std::exp(0.7 * 10);
    state.sample = 1200;
    EXPECT_NEAR(*growth_rate(scene, state, 1e-4), 0.7, 1e-15);  // measured 0
    EXPECT_FALSE(growth_rate(scene, state, 0));
    state.sample = 179;  // earlier than 1/20 of 30 s
    EXPECT_FALSE(growth_rate(scene, state, 1e-4));
}

TEST(Layouts, ForcesOfTheRodsAreDrawnWherePhysicsSays) {
    // hanging at rest, two masses of 1 kg: the tension is 2 g in the upper rod and g in the lower
    const auto scene =
        scene_of("butterfly", {"system.angle_deg=[0, 0]", "b.angle_deg=[0.5, 0]", "scene.duration_s=2",
                               "video.panels=[\"pendulums\", \"rod-force\"]", "video.rod_force_range=[0, 40]"});
    ASSERT_TRUE(scene.a.motion.wants_tension);
    const Drawn film(scene, 120);
    const auto& strip = film.layout.strips[0];
    const float x = strip.time.at(0.5);
    EXPECT_TRUE(film.has({x, strip.value.at(9.8)}, themes[0].sides[1], 60));
    EXPECT_TRUE(film.has({x, strip.value.at(19.6)}, mixed(themes[0].sides[1], themes[0].text, 0.6f), 60));
    EXPECT_FALSE(scene_of("butterfly").a.motion.wants_tension) << "only where it is shown";
}

TEST(Layouts, AxesContainTheWholeMotion) {
    struct Pair {
        const char* preset;
        std::vector<std::string> keys;
        double min_share = 0;  // of the strip's height that the curve of the distance covers
    };
    const std::vector<std::string> quick{"scene.duration_s=10", "system.integrator=\"rk4\"",
                                         "system.step_s=\"1/1200\""};
    const std::string energies = "video.panels=[\"energies-a\", \"energies-b\", \"angles\", \"rates\", \"exponent\"]",
                      errors = "video.panels=[\"energy\", \"rod-error\", \"rod-force\"]";
    // unchanged films; chains with equal starts, other energies, masses and lengths; other strips
    for (auto [preset, keys, min_share] :
         std::vector<Pair>{{"butterfly", {}, 0.75},
                           {"mass-ratio", {}, 0.6},
                           {"slow-parting", {}, 0.6},
                           {"single-and-double", {}},
                           {"butterfly", one_link_at("10", "90"), 0.5},  // 0.59
                           {"butterfly", one_link_at("90", "10")},
                           {"butterfly", one_link_at("5", "-5")},
                           {"butterfly", {"a.angle_deg=[0, 1]", "b.angle_deg=[170, 170]"}},
                           {"butterfly", {"a.mass_kg=[1, 0.1]", "b.mass_kg=[3, 1]"}},
                           {"butterfly", {"a.length_m=[0.1, 0.1]", "b.length_m=[2, 1]"}},
                           {"butterfly", {"b.omega_deg_per_s=[720, -720]"}},
                           {"triple", {"a.angle_deg=[1, 2, 3]", "b.angle_deg=[2, 3, 1]"}},
                           {"butterfly", {energies}},
                           {"butterfly", {errors, "system.model=\"constraints\""}},
                           {"triple", {errors}},
                           {"whip", {errors}}}) {
        const auto what = fmt::format("{} {}", preset, fmt::join(keys, " "));
        if (!keys.empty() && min_share == 0) keys.insert(keys.end(), quick.begin(), quick.end());
        const auto scene = scene_of(preset, keys);
        const auto strips = make_layout(scene).strips;
        std::vector<Spread> seen(strips.size());
        double start = 0;
        for_each_snapshot(scene, scene.samples, [&](const Snapshot& snapshot) {
            if (snapshot.pair.sample == 0) start = snapshot.pair.distance;
            for (std::size_t k = 0; k < strips.size(); ++k)
                for (const auto& curve : strip_curves(strips[k].kind, scene, snapshot.pair, start))
                    if (curve.value) seen[k].add(*curve.value);
        });
        for (std::size_t k = 0; k < strips.size(); ++k) {
            const Axis axis = strips[k].value;
            const auto& spread = seen[k];
            EXPECT_LE(spread.high, axis.high) << what << ' ' << k;
            if (!axis.logarithmic) {  // a tenth longer at each end
                const double width = spread.high - spread.low;
                EXPECT_NEAR(axis.low, spread.low < 0 ? spread.low - width / 10 : 0, 1e-9 * width) << what << ' ' << k;
                EXPECT_NEAR(axis.high, spread.high > 0 ? spread.high + width / 10 : 0, 1e-9 * width)
                    << what << ' ' << k;
            } else if (strips[k].kind != StripKind::distance) {
                EXPECT_TRUE(spread.count == 0 || spread.maximum >= axis.high / 11) << what << ' ' << k;
                EXPECT_LE(axis.high / axis.low, spread.count == 0 ? 1.01e16 : 1.01e6) << what << ' ' << k;
            } else if (min_share > 0) {
                EXPECT_GE(spread.minimum, axis.low) << what;
                EXPECT_GT(std::log(spread.maximum / spread.minimum) / std::log(axis.high / axis.low), min_share)
                    << what;
            } else if (start > 0.1) {
                EXPECT_GE(start, axis.low) << what;
                EXPECT_GE(spread.maximum, axis.high / 10) << what;
            }
        }
    }
    // the ranges are finite for any preset
    for (const char* key :
         {"system.length_m=[1e200, 1]", "system.mass_kg=[1e300, 1]", "system.mass_kg=[1e-300, 1]",
          "system.gravity_m_per_s2=1e300", "system.length_m=[1e-200, 1e-200]", "b.mass_kg=[1e300, 1]"}) {
        const Axis axis = make_layout(scene_of("butterfly", {key})).strips.front().value;
        EXPECT_GT(axis.low, 0) << key;
        EXPECT_GE(axis.high / axis.low, 9.99) << key;
        EXPECT_LE(axis.high / axis.low, 1.01e60) << key;
        EXPECT_LT(axis.high, 1e61) << key;
    }
}

TEST(Layouts, OnlyPairsWithACloseStartDiverge) {
    const auto outcome = [](std::vector<std::string> keys) {
        keys.emplace_back("system.integrator=\"taylor\"");
        const auto scene = scene_of("butterfly", keys);
        const auto composer = composed(scene, scene.samples);
        const auto end = composer->end_card(1);
        EXPECT_EQ(says(composer->frame(), "diverged at"), says(end, "diverged after"));
        return says(end, "diverged after") ? "parted"
               : says(end, "together")     ? "together"
               : says(end, "apart")        ? "apart"
                                           : "";
    };
    EXPECT_STREQ(outcome({"scene.duration_s=20"}), "parted");
    EXPECT_STREQ(outcome({"scene.duration_s=1"}), "together");
    EXPECT_STREQ(outcome(one_link_at("10", "90")), "apart");
}

TEST(Layouts, ColoursWidthsAndSizesAreThePresets) {
    const Drawn film(scene_of("butterfly", {"video.colors.background=\"#203040\"", "video.colors.bob=\"#00ff00\"",
                                            "video.side_colors=[\"#ff0000\", \"#0000ff\"]", "video.widths_px.bob=60",
                                            "video.trail_s=0", "video.glow_px=0", "video.fonts_px.title=80"}));
    EXPECT_TRUE(film.has({5, 5}, rgb(0x203040), 0));
    const auto last = film.layout.panels[0].at(2, 0), first = film.layout.panels[0].at(1, 0);
    for (const float away : {0.f, 54.f}) {
        EXPECT_TRUE(film.has({first.x, first.y - away}, rgb(0x00ff00), 0)) << away;
        EXPECT_TRUE(film.has({last.x, last.y - away}, rgb(0xff0000), 0)) << away;
    }
    EXPECT_FALSE(film.has({first.x, first.y - 64}, rgb(0x00ff00), 0));
    EXPECT_EQ(film.layout.style.font.title, 80);
}

TEST(Layouts, WhatIsResolvedReadsBackToTheSame) {
    const std::vector<std::vector<std::string>> all{
        {"video.layout=\"ensemble\"", "video.members=17", "video.colors.rod=\"#123456\"", "video.widths_px.trail=5",
         "video.fonts_px.axis=30"},
        {"video.layout=\"ensemble\"", "video.members=[[90, 90], [90.001, 90], [90.003, 90.5]]"},
        {"video.layout=\"phase\"", "video.phase=\"section\"", "video.phase_link=2", "video.glow_px=3"},
        {"video.layout=\"portrait\"", "video.poster_s=5", "video.contact_sheet=[2, 3]", "video.hold_end_s=\"1/3\""},
        {"video.format=\"webm\"", "video.codec=\"av1\"", "video.crf=60", "video.title_card_s=1"},
        {"video.format=\"png\"", "video.transparent=true", "video.panels=[\"rod-force\", \"exponent\", \"pendulums\"]",
         "video.exponent_range=[-1, 2]"},
        {"video.pixel_format=\"yuv420p10\"", "video.speed=\"1/4\"", "video.theme=\"high-contrast\""},
        {"video.format=\"gif\""}};
    for (const auto& arguments : all) {
        const auto text = resolved_toml(read_preset(find_preset("butterfly"), sets(arguments)));
        EXPECT_EQ(resolved_toml(read_preset({"butterfly", "resolved", text})), text);
        for (const auto& argument : arguments) {
            const auto key =
                argument.substr(0, argument.find('=')).substr(argument.find_last_of('.', argument.find('=')) + 1);
            EXPECT_NE(text.find(key + " = "), std::string::npos) << key << " is missing in\n" << text;
        }
    }
}

TEST(Layouts, OfTinyPicturesNothingOverlaps) {
    for (const auto* preset : {"butterfly", "horizon", "phase-dance", "triple", "fan"})
        for (const auto size : {Size{160, 90}, Size{212, 118}, Size{240, 134}, Size{280, 158}}) {
            const auto scene = scene_of(preset, {fmt::format("video.size=[{}, {}]", size.width, size.height)});
            expect_apart(labels_of(scene, scene.samples * 3 / 4), size, fmt::format("{} {}", preset, size.width));
        }
}

}  // namespace doppel::layouts_test
