#include "base/embedded.hpp"
#include "film/words.hpp"

#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace doppel {
namespace shown_test {

TEST(Shown, IsWhatIsAskedForAndNoMore) {
    const auto words = [](const std::string& show, long last = 0) {
        const auto scene =
            scene_of("butterfly", {"video.show=" + show, "video.panels=[\"pendulums\"]", "title=\"T\"",
                                   "subtitle=\"S\"", "a.label=\"A\"", "a.note=\"\"", "b.label=\"B\"", "b.note=\"N\""});
        Composer composer(scene);
        for_each_snapshot(scene, last, [&](const Snapshot& snapshot) { composer.add(snapshot); });
        return fmt::format("{}",
                           fmt::join(words_of({composer.backdrop(), composer.frame(), composer.end_card(1)}), "|"));
    };
    const std::string outcome = "|together to the end, 30 s|from a state-space distance of 7.4 × 10⁻⁵ to 7.4 × 10⁻⁵",
                      credit = fmt::format("|Doppel {} · butterfly", version());
    EXPECT_EQ(words(R"(["title", "subtitle", "clock", "labels", "credit"])"),
              "T|S|real time|A|B|N|0.00 s|T" + outcome + credit);
    EXPECT_EQ(words("[]"), "T" + outcome);  // the card is asked for by a key of its own
    EXPECT_EQ(words(R"(["title"])"), "T|T" + outcome);
    EXPECT_EQ(words(R"(["subtitle"])"), "S|T" + outcome);
    EXPECT_EQ(words(R"(["clock"])"), "real time|0.00 s|T" + outcome);
    EXPECT_EQ(words(R"(["labels"])"), "A|B|N|T" + outcome);
    EXPECT_EQ(words(R"(["credit"])"), "T" + outcome + credit);
}

TEST(Shown, WithoutLabelsOrHeaderPendulumsGetTheirRoom) {
    for (const char* preset : {"butterfly", "springs", "fan", "phase-dance"}) {
        const auto all = make_layout(scene_of(preset)), none = make_layout(scene_of(preset, {"video.show=[]"}));
        EXPECT_LT(none.panels[0].area.top, all.panels[0].area.top) << preset;
        EXPECT_GE(none.panels[0].px_per_m, all.panels[0].px_per_m) << preset;
    }
}

TEST(Shown, StripsOfEnergiesAnglesAndRatesHoldTheMotion) {
    const auto scene = scene_of("butterfly", {"video.panels=[\"energies-a\", \"energies-b\", \"angles\", \"rates\"]",
                                              "scene.duration_s=12", "a.label=\"left\""});
    Composer composer(scene);
    const auto layout = make_layout(scene);
    ASSERT_EQ(layout.strips.size(), 4u);
    std::array<Range, 4> seen{{{0, 0}, {0, 0}, {0, 0}, {0, 0}}};
    const auto see = [&](std::size_t strip, double value) {
        seen[strip] = {std::min(seen[strip].low, value), std::max(seen[strip].high, value)};
    };
    for_each_snapshot(scene, scene.samples, [&](const Snapshot& snapshot) {
        composer.add(snapshot);
        for (const std::size_t side : {0, 1}) {
            const auto& bobs = (side == 0 ? snapshot.pair.a : snapshot.pair.b).bobs;
            double kinetic = 0, potential = 0;
            for (const auto& bob : bobs) {
                kinetic += 0.5 * (bob.vx * bob.vx + bob.vy * bob.vy);
                potential += 9.8 * bob.y;
                see(2, bob.theta * 180 / pi);
                see(3, bob.omega * 180 / pi);
            }
            see(side, kinetic);
            see(side, potential);
        }
    });
    for (std::size_t k = 0; k < 4; ++k) {
        // the axis is a tenth longer at each end
        const double width = seen[k].high - seen[k].low;
        EXPECT_NEAR(layout.strips[k].value.low, seen[k].low - width / 10, 1e-6 * width) << k;
        EXPECT_NEAR(layout.strips[k].value.high, seen[k].high + width / 10, 1e-6 * width) << k;
    }
    const std::vector<DisplayList> lists{composer.backdrop(), composer.frame()};
    const auto words = words_of(lists);
    std::ptrdiff_t curves = 0;
    for (const auto& list : lists)
        curves += std::ranges::count_if(list, [](const Item& item) { return std::holds_alternative<Stroke>(item); });
    EXPECT_EQ(curves, 3 + 3 + 4 + 4);
    for (const char* word : {"energy of left, J", "energy of b, J", "kinetic", "potential", "total", "angles, °",
                             "angular rates, °/s", "a1", "b2"})
        EXPECT_NE(std::find(words.begin(), words.end(), word), words.end()) << word;
    EXPECT_NE(error_of([] {
                  scene_of("springs", {"video.panels=[\"rates\"]"});
              }).second.find("[video] panels \"rates\" is of chains"),
              std::string::npos);
}

}  // namespace shown_test
}  // namespace doppel
