#include "base/embedded.hpp"
#include "film/support.hpp"

#include <fmt/ranges.h>
#include <gtest/gtest.h>

namespace doppel {
namespace shown_test {

TEST(Shown, IsWhatIsAskedForAndNoMore) {
    const auto words = [](const std::string& show, long last = 0) {
        const auto scene =
            scene_of("butterfly", {"video.show=" + show, "video.panels=[\"pendulums\"]", "title=\"T\"",
                                   "subtitle=\"S\"", "a.label=\"A\"", "a.note=\"\"", "b.label=\"B\"", "b.note=\"N\""});
        Composer composer(scene);
        for_each_snapshot(scene, last, [&](const Snapshot& snapshot) { composer.add(snapshot); });
        std::vector<std::string> all;
        for (const auto& list : {composer.backdrop(), composer.frame(), composer.end_card(1)})
            for (const auto& item : list)
                if (const auto* label = std::get_if<Label>(&item); label && !label->text.empty())
                    all.push_back(label->text);
        return fmt::format("{}", fmt::join(all, "|"));
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

}  // namespace shown_test
}  // namespace doppel
