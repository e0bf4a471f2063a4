// The pendulum has priority: its circle is large, centred in its panel, and no text overlaps it.
#include "film/layer.hpp"
#include "film/runs.hpp"
#include "film/words.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace doppel::large_pendulums_test {

constexpr std::array films{"butterfly", "calm",     "fan",        "horizon",     "loop",     "damped",
                           "kapitza",   "rods",     "mass-ratio", "phase-dance", "raindrop", "slow-parting",
                           "springs",   "measured", "triple",     "two-methods", "whip",     "whip-256"};
constexpr std::array sizes{Size{1920, 1080}, Size{480, 270}, Size{3840, 2160}, Size{1080, 1920}};

/// A film with fewer samples and another size; the method and step are chosen once.
Scene at_size(Scene scene, Size size) {
    scene.preset.video.size = size;
    scene.samples = std::min(scene.samples, 300L);
    return scene;
}

/// Whether text overlaps a circle.
bool meets(const Area& box, Point center, float radius) {
    const float dx = std::max({0.0f, box.left - center.x, center.x - box.right}),
                dy = std::max({0.0f, box.top - center.y, center.y - box.bottom});
    return std::hypot(dx, dy) < radius;
}

void expect_large_and_central(const Scene& scene, const Layout& layout, const std::string& what) {
    const auto& video = scene.preset.video;
    const auto width = static_cast<float>(video.size.width), height = static_cast<float>(video.size.height);
    for (const auto& panel : layout.panels) {
        EXPECT_NEAR(panel.center.x, (panel.area.left + panel.area.right) / 2, 1) << what;
        EXPECT_NEAR(panel.center.y, (panel.area.top + panel.area.bottom) / 2, 1) << what;
        EXPECT_EQ(panel.px_per_m, layout.panels[0].px_per_m) << what;
    }
    if (layout.reach == 0) return;  // a mechanism without an enclosing circle
    if (is_tall(video))             // strips have a fifth of the height
        EXPECT_GE(2 * layout.reach, (video.strips.size() > 1 ? 0.36f : 0.4f) * width) << what;
    else
        EXPECT_GE(2 * layout.reach, 0.45f * height) << what;
    for (const auto& panel : layout.panels) {
        const float outermost = layout.reach + layout.bob_radius;
        EXPECT_TRUE(panel.area.contains(Point{panel.center.x - outermost, panel.center.y - outermost})) << what;
        EXPECT_TRUE(panel.area.contains(Point{panel.center.x + outermost, panel.center.y + outermost})) << what;
    }
}

/// The bounds and the beginning of a motion, for pictures of any size.
struct Motion {
    MotionBounds bounds;
    std::vector<Snapshot> beginning;

    explicit Motion(const Scene& scene) {
        Recording recording(scene, {std::min(scene.samples, 240L) + 1}, true, never_stopped);
        bounds = recording.bounds();
        recording.play([&](const Snapshot& snapshot) { beginning.push_back(snapshot); });
    }
    std::vector<Label> labels(const Scene& scene) const {
        Composer composer(scene, bounds);
        for (const auto& snapshot : beginning)
            if (snapshot.pair.share == 0) composer.add(snapshot);
        return labels_in({composer.backdrop(), composer.frame()});
    }
};

void expect_words_in_place(const Scene& scene, const Layout& layout, const std::vector<Label>& labels,
                           const std::string& what) {
    expect_apart(labels, scene.preset.video.size, what);
    for (const auto& label : labels) {
        EXPECT_GE(label.size, 0.58f * layout.text * 21) << what << ": " << label.text;
        for (const auto& panel : layout.panels)
            EXPECT_FALSE(meets(box_of(label), panel.center, layout.reach)) << what << ": " << label.text;
    }
}

void expect_in_place_at_all_sizes(const Scene& scene, const std::string& name) {
    const Motion motion(at_size(scene, sizes[0]));
    for (const auto& size : sizes) {
        const auto sized = at_size(scene, size);
        const auto layout = doppel::make_layout(sized, motion.bounds);
        const auto what = fmt::format("{} {}x{}", name, size.width, size.height);
        expect_large_and_central(sized, layout, what);
        expect_words_in_place(sized, layout, motion.labels(sized), what);
    }
}

TEST(LargePendulums, CirclesAreLargeCentralAndFreeOfText) {
    for (const char* film : films) expect_in_place_at_all_sizes(scene_of(film), film);
}

TEST(LargePendulums, ASquareFilmHasItsStripBelowThem) {
    const auto layout = make_layout(at_size(scene_of("butterfly"), {1080, 1080}));
    EXPECT_GT(2 * layout.reach, 400);  // measured 462; 325 with the strip in a column
    EXPECT_GT(layout.strips[0].area.top, layout.panels[0].area.bottom);
}

TEST(LargePendulums, AnUprightFilmLeavesRoomForAnAppsButtonsAndHasLargeWords) {
    EXPECT_EQ(scene_of("butterfly", {"video.layout=\"portrait\""}).preset.video.size, (Size{1080, 1920}));
    const auto scene = at_size(scene_of("pendulum-portrait"), {1080, 1920});
    const auto layout = make_layout(scene);
    expect_large_and_central(scene, layout, "portrait");
    const auto labels = labels_of(scene, 240);
    expect_words_in_place(scene, layout, labels, "portrait");
    for (const auto& label : labels) {
        EXPECT_GE(box_of(label).top, 110) << label.text;
        EXPECT_LE(box_of(label).bottom, 1920 - 260) << label.text;
        EXPECT_GE(label.size, 28) << label.text;  // 1.6 times 20, or slightly less where it must fit
        EXPECT_EQ(label.text.find("θ"), std::string::npos) << label.text;
        EXPECT_EQ(label.text.find("tolerance"), std::string::npos) << label.text;
    }
}

TEST(LargePendulums, LongHeadingsLeaveTheCircleWhereItIs) {
    // text too long for one line: smaller, or in two lines, but the circle stays in the middle
    auto one_link = one_link_at("90", "90");
    one_link.emplace_back("b.gravity_m_per_s2=9.80665");
    for (const auto& arguments : std::vector<std::vector<std::string>>{
             {"b.angle_deg=[90.0000000000001, 12.3456789]"},
             {"b.omega_deg_per_s=[1.23456789, 2.3456789]", "b.mass_kg=[3.1415926, 4]", "b.length_m=[0.5, 0.6]"},
             {"title=\"A title that goes on and on, for as long as a double pendulum swings, and then some\""},
             one_link})
        expect_in_place_at_all_sizes(scene_of("butterfly", arguments), arguments[0]);
}

TEST(Divergence, NeedsACloseStartAndAWholeSecondAboveTheLimit) {
    const auto since = [](double start, const std::vector<std::pair<double, double>>& steps) {
        Divergence parting;
        parting.add(0, start);
        for (const auto& [time, distance] : steps) parting.add(time, distance);
        return parting.since();
    };
    using Steps = std::vector<std::pair<double, double>>;
    EXPECT_EQ(since(1e-4, Steps{{1, 0.5}, {2, 1.0}, {2.5, 3}, {3, 1}}), 2);
    EXPECT_EQ(since(1e-4, Steps{{1, 0.5}, {2, 1.0}, {2.5, 3}, {2.99, 1}}), std::nullopt) << "not yet a second";
    EXPECT_EQ(since(1e-4, Steps{{2, 1.5}, {2.5, 0.9}, {2.75, 1.5}, {3.5, 2}}), std::nullopt) << "they came back";
    EXPECT_EQ(since(1e-4, Steps{{2, 1.5}, {2.5, 0.9}, {2.75, 1.5}, {3.75, 2}}), 2.75);
    EXPECT_EQ(since(1e-4, Steps{{2, 1.5}, {3, 1.5}, {4, 0.1}}), 2) << "once parted, for good";
    EXPECT_EQ(since(0.1, Steps{{2, 1.5}, {3, 1.5}}), std::nullopt) << "never close";
    EXPECT_EQ(since(0.0999, Steps{{2, 1.5}, {3, 1.5}}), 2);
}

TEST(Divergence, IsInTheManifest) {
    // by a method that stays accurate; explicit Euler, 0.5 rad wrong from 11 s on, gives 14.2
    const auto scene = scene_of("butterfly", {"system.integrator=\"taylor\"", "system.tolerance=1e-13"});
    EXPECT_NEAR(manifest_of(scene)["parted_s"].get<double>(), 15.35, 0.01);
    EXPECT_TRUE(manifest_of(scene_of("calm"))["parted_s"].is_null());
}

TEST(Fan, HasAColourBarAndSaysWhoseDistanceItIs) {
    const auto scene = at_size(scene_of("fan"), {1920, 1080});
    const auto layout = make_layout(scene);
    const auto bar = items_in<Box>(layout.words);  // one box for each pixel, each up to the end
    ASSERT_GT(bar.size(), 200u);
    EXPECT_LT(bar[0].bottom, layout.panels[0].area.top);
    EXPECT_EQ(bar[0].color, member_color(layout.style.theme, 0));
    EXPECT_EQ(bar.back().color, member_color(layout.style.theme, 1));
    EXPECT_EQ(bar.back().left + 1, bar.back().right);
    const auto composer = composed(scene, 60);
    EXPECT_TRUE(says(composer->frame(), "first to last"));
    EXPECT_GE(items_in<Stroke>(composer->frame()).size(), 200u) << "a trail each";
    // many pendulums have thinner rods than few
    const auto few = make_layout(at_size(scene_of("fan", {"video.members=5"}), {1920, 1080})),
               many = make_layout(at_size(scene_of("fan", {"video.members=200"}), {1920, 1080}));
    EXPECT_NEAR(few.bob_radius / many.bob_radius, 5, 1e-3);  // √(200/8)
    EXPECT_GT(few.rod_radius / many.rod_radius, 3);
}

TEST(Fan, ShowsListedMembersLargeWithALegend) {
    const std::string list = "video.members=[[120, 120], [120.01, 120], [140, 120], [170.5, 120]]";
    const auto scene = at_size(scene_of("fan", {list}), {1920, 1080});
    ASSERT_EQ(scene.members.size(), 4u);
    const std::array angles{120.0, 120.01, 140.0, 170.5};
    const auto layout = make_layout(scene);
    const auto picture = frame_of(scene, 0);
    for (std::size_t k = 0; k < angles.size(); ++k) {
        EXPECT_NEAR(static_cast<double>(scene.members[k].chain->angle[0]) * 180 / pi, angles[k], 1e-12);
        const auto color = layout.style.theme.palette[k];
        const auto is_of = [&](const Capsule& dot) { return dot.color == color; };
        EXPECT_FALSE(items_in<Capsule>(layout.words, is_of).empty()) << k;
        if (k == 1) continue;  // hidden behind the first
        const double x = std::sin(radians(angles[k])) + std::sin(radians(120.0)),
                     y = -std::cos(radians(angles[k])) - std::cos(radians(120.0));
        EXPECT_TRUE(is_color(picture, layout.panels[0].at(x, y), color)) << k;
    }
    // the distance is that between the first and the last
    EXPECT_EQ(scene.preset.a.angle_deg[0], parse_quad("120"));
    EXPECT_EQ(scene.preset.b.angle_deg[0], parse_quad("170.5"));
    expect_in_place_at_all_sizes(scene, "list");
    for (const auto* words : {"θ₁ =", "120°", "120.01°", "170.5°"}) EXPECT_TRUE(says(layout.words, words)) << words;
}

}  // namespace doppel::large_pendulums_test
