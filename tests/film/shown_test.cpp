#include "base/embedded.hpp"
#include "film/words.hpp"
#include "output/fixtures.hpp"

#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace doppel::shown_test {

TEST(Shown, IsExactlyWhatIsRequested) {
    const auto words = [](const std::string& show, long last = 0) {
        const auto scene =
            scene_of("butterfly", {"video.show=" + show, "video.panels=[\"pendulums\"]", "title=\"T\"",
                                   "subtitle=\"S\"", "a.label=\"A\"", "a.note=\"\"", "b.label=\"B\"", "b.note=\"N\""});
        const auto composer = composed(scene, last);
        return fmt::format("{}",
                           fmt::join(words_of({composer->backdrop(), composer->frame(), composer->end_card(1)}), "|"));
    };
    const std::string
        outcome = "|together to the end, 30 s|state-space distance: 7.4 × 10⁻⁵ at the start, at most 7.4 × 10⁻⁵",
        credit = fmt::format("|Doppel {} · butterfly", version());
    EXPECT_EQ(words(R"(["title", "subtitle", "clock", "labels", "credit"])"),
              "T|S|real time|A|B|N|0.00 s|T" + outcome + credit);
    EXPECT_EQ(words("[]"), "T" + outcome);  // the card has a key of its own
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

TEST(Shown, StripsNameTheirCurves) {
    const auto scene = scene_of("butterfly", {"video.panels=[\"energies-a\", \"energies-b\", \"angles\", \"rates\"]",
                                              "scene.duration_s=2", "a.label=\"left\""});
    const auto composer = composed(scene, scene.samples);
    const std::vector<DisplayList> lists{composer->backdrop(), composer->frame()};
    const auto words = words_of(lists);
    EXPECT_EQ(items_in<Stroke>(lists[0]).size() + items_in<Stroke>(lists[1]).size(), 3u + 3 + 4 + 4);
    for (const char* word : {"energy of left, J", "energy of b, J", "kinetic", "potential", "total", "angles, °",
                             "angular rates, °/s", "a1", "b2"})
        EXPECT_TRUE(std::ranges::count(words, word)) << word;
    test::expect_error(ExitCode::bad_input, {"[video] panels \"rates\" is for chains"},
                       [] { scene_of("springs", {"video.panels=[\"rates\"]"}); });
}

}  // namespace doppel::shown_test
