#include "film/layer.hpp"
#include "film/runs.hpp"

namespace doppel::trail_test {

using namespace test;

TEST(Trail, IsInterruptedOnlyWhereItJumps) {
    const auto scene = scene_of("butterfly", {});
    Trail trail(scene, make_style(scene.preset.video, 1, 1), {}, 2, 50);
    const double interval_s = 1 / scene.preset.sample_hz.value();
    // 20 px a sample to the right; after 30 samples once back to the left
    for (int i = 0; i < 60; ++i) trail.add({20.0f * static_cast<float>(i % 30), 100}, i * interval_s, i * interval_s);
    DisplayList list;
    trail.draw({0, 0, 640, 480}, 59 * interval_s, std::nullopt, list);
    EXPECT_EQ(list.size(), 2U);
}

}  // namespace doppel::trail_test
