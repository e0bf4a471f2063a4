#include "film/recording.hpp"
#include "film/runs.hpp"
#include "film/strips.hpp"
#include "film/words.hpp"
#include "scene/resolved.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace doppel::single_test {

const std::string one = "[system]\nangle_deg = [120, 90]\n[scene]\nduration_s = 1\n[video]\nlayout = \"single\"\n";

TEST(Single, ShowsOnePendulumAndNothingOfAPair) {
    const auto scene = scene_of_text(one);
    const auto layout = make_layout(scene);
    ASSERT_EQ(layout.panels.size(), 1u);
    EXPECT_EQ(layout.panels[0].shown, std::vector<std::size_t>{0});
    ASSERT_EQ(layout.strips.size(), 1u);
    EXPECT_GE(layout.strips[0].area.height(), 0.2f * 1080);
    const auto composer = composed(scene, scene.samples);
    const auto words =
        words_of({composer->backdrop(), composer->frame(), composer->title_card(1), composer->end_card(1)});
    for (const char* word : {"θ₁ = 120°, θ₂ = 90°", "energy, J", "kinetic", "after 1 s"})
        EXPECT_TRUE(std::ranges::count(words, word)) << word;
    for (const auto& word : words) {
        EXPECT_EQ(word.find("two "), std::string::npos) << word;
        EXPECT_EQ(word.find("apart"), std::string::npos) << word;
    }
    const auto bob = state_at(scene, 60).a.bobs[1];
    EXPECT_TRUE(is_color(frame_of(scene, 60), layout.panels[0].at(bob.x, bob.y), themes[0].sides[0], 60));
}

TEST(Single, ItsTableIsThatOfSideA) {
    const auto single = table_of(scene_of_text(one));
    const auto pair =
        table_of(scene_of("butterfly", {"system.angle_deg=[120, 90]", "b.angle_deg=[120, 91]", "scene.duration_s=1"}));
    const auto cells = cells_of(single.at(0));
    EXPECT_EQ(cells.back(), "a_length_error_m");
    ASSERT_EQ(single.size(), pair.size());
    for (const std::size_t row : {0ul, 1ul, 60ul, 120ul}) EXPECT_TRUE(pair[row].starts_with(single[row])) << row;
    const auto manifest = manifest_of(scene_of_text(one));
    EXPECT_FALSE(manifest.contains("b"));
    EXPECT_TRUE(manifest["largest_distance"].is_null());
}

TEST(Single, RefusesWhatIsOfAPair) {
    const auto refused = [](const std::string& text, const char* words) {
        test::expect_error(ExitCode::bad_input, {words}, [&] { scene_of_text(text); });
    };
    refused(one + "[b]\nangle_deg = [91, 90]\n",
            "[video] layout \"single\" shows side a alone, but the preset has a table [b]; leave [b] out");
    refused(one + "panels = [\"pendulums\", \"distance\"]\n",
            "[video] panels must be about side a for the layout \"single\"; \"distance\" is about a pair");
    refused(one + "[video.view]\nfollow = 3\n",
            "[video.view] follow must be from 0 to 2, as there are masses; it is 3");
    refused(one + "[video.view]\nfollow = 1\ncenter_m = [0, 0]\n", "center_m is for a view that follows no mass");
    refused(one + "panels = [\"angles\"]\n[video.view]\nheight_m = 2\n",
            "[video] view is about the pendulums, but panels does not contain \"pendulums\"");
    refused("[scene]\nmember_columns = true\n",
            "[scene] member_columns is for the layout \"ensemble\"; it is \"side-by-side\"");
    const std::string ensemble = "[scene]\nduration_s = 1\n[video]\nlayout = \"ensemble\"\nmembers = ";
    refused(ensemble + "[{angle_deg = [1, 2]}, {weight = 3}]",
            "members[1] has no \"weight\"; it has angle_deg, color, length_m, mass_kg");
    refused(ensemble + "[{mass_kg = [1, 2]}, {mass_kg = [1, -2]}]", "must be > 0");
    refused(ensemble + "[{mass_kg = [1, 2]}, {mass_kg = [1, 2, 3]}]",
            "must have 2 numbers each, one a link; mass_kg of [1] has 3");
    test::expect_error(ExitCode::bad_input, {"must begin with side a and end with side b; [b] angle_deg is [9, 9]"},
                       [] {
                           scene_of("fan", {"b.angle_deg=[9, 9]", "video.members=[[1, 2], [3, 4]]"});
                       });
}

TEST(Single, MembersOfAnEnsembleHaveMassesLengthsAndColoursOfTheirOwn) {
    const std::string text =
        "[scene]\nduration_s = 1\nmember_columns = true\n[system]\nintegrator = \"dop853\"\n[video]\nlayout = "
        "\"ensemble\"\nmembers = [{angle_deg = [60, 60], length_m = [1, 1]}, {angle_deg = [90, 90], mass_kg = [1, 4], "
        "length_m = [0.5, 0.5], color = \"#00ff00\"}, {angle_deg = [90, 90], length_m = [0.25, 0.5]}]\n";
    const auto scene = scene_of_text(text);
    ASSERT_EQ(scene.members.size(), 3u);
    EXPECT_EQ(scene.members[1].chain->mass[1], 4);
    EXPECT_EQ(scene.members[1].chain->length[0], Quad(1) / 2);
    EXPECT_EQ(scene.preset.b.length_m[0], Quad(1) / 4);
    // its last bob has the pendulum's colour, and the size that fits its mass
    EXPECT_TRUE(is_color(frame_of(scene, 0), make_layout(scene).panels[0].at(1, 0), {0, 1, 0, 1}, 60));
    // the table ends with the members' columns; the first and the last member are the pair
    const auto table = table_of(scene);
    const auto names = cells_of(table[0]), last = cells_of(table.back());
    const auto cell = [&](const std::string& name) {
        return last.at(static_cast<std::size_t>(std::ranges::find(names, name) - names.begin()));
    };
    EXPECT_EQ(names.back(), "member3_vy2_m_per_s");
    EXPECT_EQ(names.size(), 2 + 2 * 15 + 2 + 3 * 12);
    EXPECT_NEAR(std::stod(cell("member3_x2_m")), std::stod(cell("b_x2_m")), 1e-9);
    EXPECT_NEAR(std::stod(cell("member1_theta2_rad")), std::stod(cell("a_theta2_rad")), 1e-9);
    const auto plain = table_of(scene_of_text("[scene]\nduration_s = 1\n" + text.substr(text.find("[system]"))));
    for (std::size_t row = 0; row < plain.size(); ++row) EXPECT_TRUE(table[row].starts_with(plain[row])) << row;
    const auto resolved = resolved_toml(scene.preset);
    EXPECT_EQ(resolved_toml(read_preset({"x", "resolved", resolved})), resolved);
}

TEST(Single, TheLegendOfMembersCanBeReadInASmallPicture) {
    const auto scene = scene_of_text(
        "[scene]\nduration_s = 1\n[system]\nintegrator = \"dop853\"\n[video]\nsize = [640, 360]\nlayout = "
        "\"ensemble\"\nmembers = [{mass_kg = [1, 1], length_m = [1, 1]}, {mass_kg = [1.25, 4.75], length_m = [0.55, "
        "0.45]}, {mass_kg = [0.5, 0.5], length_m = [0.25, 0.65]}, {mass_kg = [1.5, 0.5], length_m = [0.2, 0.6]}]\n");
    const auto labels = labels_of(scene, 0);
    for (const auto& label : labels) EXPECT_GE(label.size, 8.999f) << label.text;
    expect_apart(labels, {640, 360}, "legend");
    EXPECT_TRUE(
        std::ranges::any_of(labels, [](const Label& label) { return label.text == "0.5 kg, 0.5 kg, 0.25 m, 0.65 m"; }));
}

TEST(Single, MembersTakeNumbersOfTheirOwnSidesAndStripsTheirColours) {
    const std::string text =
        "[scene]\nduration_s = 1\n[system]\nintegrator = \"dop853\"\n[video]\nlayout = \"ensemble\"\npanels = "
        "[\"pendulums\", \"angles\"]\nmembers = [{angle_deg = [60, 60], color = \"#ff0000\"}, {angle_deg = [90, 90]}, "
        "{angle_deg = [90, 90], length_m = [2, 2]}]\n";
    const auto scene = scene_of_text(text);
    EXPECT_EQ(scene.members[1].chain->length[0], 1);  // not halfway to the last member's
    EXPECT_EQ(scene.preset.b.length_m[0], 2);
    const auto style = make_layout(scene).style;
    const auto curves = strip_curves(StripKind::angles, scene, blank_snapshot(scene).pair, 0, style);
    EXPECT_EQ(curves[1].name, "first 2");
    EXPECT_EQ(curves[1].color, (Color{1, 0, 0, 1}));
    EXPECT_EQ(curves[3].name, "last 2");
    EXPECT_EQ(curves[3].color, style.theme.palette[2]);
}

/// Its legend makes the panel narrower, which makes the legend higher again.
TEST(Single, ALongLegendOfMembersIsBelowTheSubtitle) {
    const auto scene =
        scene_of("butterfly", {"video.layout=ensemble", "scene.duration_s=1", "video.size=[1280, 720]",
                               "video.members=[[60.123, 100.5], [80, 100.25], [61, 100], [62, 103], [64.5, 120], "
                               "[65, 121], [66, 1], [61, 1]]"});
    expect_apart(labels_of(scene, 0), {1280, 720}, "long legend");
}

TEST(Single, AViewHasItsCentreAndHeightAndFollowsAMass) {
    const auto view = [](const std::string& keys) {
        return make_layout(scene_of_text(one + "[video.view]\n" + keys)).panels[0];
    };
    const auto zoomed = view("center_m = [0.5, -1]\nheight_m = 2");
    EXPECT_FLOAT_EQ(zoomed.px_per_m, zoomed.area.height() / 2);
    EXPECT_FLOAT_EQ(zoomed.at(0.5, -1).x, (zoomed.area.left + zoomed.area.right) / 2);
    EXPECT_FLOAT_EQ(zoomed.at(0, 0).y, zoomed.area.top);
    // the mass that the view follows stays in the middle
    const auto scene = scene_of_text(one + "[video.view]\nfollow = 2\nheight_m = 2\n");
    const auto panel = make_layout(scene).panels[0];
    for (const long sample : {0L, 50L})
        EXPECT_TRUE(is_color(frame_of(scene, sample), panel.center, themes[0].sides[0], 60)) << sample;
}

TEST(Single, TrailsAlone) {
    for (const char* keys : {"show = []\n", "[video.widths_px]\nrod = 0\nbob = 0\ngrid = 0\ntrace = 0\nmark = 0\n"}) {
        const auto scene = scene_of_text(one + keys);
        const auto list = composed(scene, 60)->frame();
        const auto area = make_layout(scene).panels[0].area;
        const auto is_high = [&](const Capsule& one) { return one.from.y < 600 && area.contains(one.from); };
        EXPECT_TRUE(items_in<Capsule>(list, is_high).empty()) << keys;
        EXPECT_FALSE(items_in<Stroke>(list).empty()) << keys;
        EXPECT_TRUE(items_in<Ring>(composed(scene, 0)->backdrop()).empty()) << keys;
    }
    const auto bare = scene_of_text(one + "panels = [\"pendulums\"]\n[video.widths_px]\ntrail = 0\n");
    EXPECT_TRUE(items_in<Stroke>(composed(bare, 60)->frame()).empty());
    // a pair without the shadows of the second pendulum
    const auto capsules = [](const std::string& show) {
        const auto scene = scene_of("butterfly", {"b.angle_deg=[60, 90]", "video.show=" + show});
        return items_in<Capsule>(composed(scene, 60)->frame()).size();
    };
    EXPECT_EQ(capsules(R"(["rods", "bobs", "twin"])") - capsules(R"(["rods", "bobs"])"), 2u * 4);
}

}  // namespace doppel::single_test
