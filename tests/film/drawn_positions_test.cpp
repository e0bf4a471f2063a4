#include "film/support.hpp"
#include "image/color.hpp"
#include "render/typeface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace doppel::drawn_positions_test {

// Where an exact result is known, the picture is compared with it, not with an earlier picture.

struct Blob {
    double x = 0, y = 0;  // centroid, px
    long area = 0;        // px
};

/// The pixels of exactly that colour within `radius` of a point.
Blob blob_at(const Picture& picture, Point place, float radius, Color color) {
    Blob blob;
    const auto whole = [](float at) { return static_cast<int>(at); };
    const Rect around{whole(place.x - radius), whole(place.y - radius), whole(place.x + radius) + 1,
                      whole(place.y + radius) + 1};
    for_each_pixel(around, [&](int x, int y) {
        if (!is_color(picture.at(x, y), color, 2)) return;
        blob.x += x + 0.5;
        blob.y += y + 0.5;
        ++blob.area;
    });
    blob.x /= static_cast<double>(blob.area);
    blob.y /= static_cast<double>(blob.area);
    return blob;
}

TEST(DrawnPositions, BobsAreWherePhysicsSaysInTheirColour) {
    // released at rest from 37°/−61° with unequal rods: sample 0 is known in closed form
    const auto [scene, layout, picture] =
        Drawn(scene_of("butterfly", {"system.angle_deg=[37, -61]", "b.angle_deg=[-80, 20]",
                                     "system.length_m=[1.3, 0.6]", "video.trail_s=0"}));
    const auto& theme = themes[0];
    const std::array starts{std::array{37.0, -61.0}, std::array{-80.0, 20.0}};
    for (std::size_t side = 0; side < 2; ++side) {
        const auto& panel = layout.panels[side];
        double x = 0, y = 0;
        for (std::size_t link = 0; link < 2; ++link) {
            const double length = link == 0 ? 1.3 : 0.6, angle = radians(starts[side][link]);
            x += length * std::sin(angle);
            y -= length * std::cos(angle);
            const Point expected{panel.center.x + panel.px_per_m * static_cast<float>(x),
                                 panel.center.y - panel.px_per_m * static_cast<float>(y)};
            const auto found =
                blob_at(picture, expected, 1.5f * layout.bob_radius, link == 1 ? theme.sides[side] : theme.bob);
            EXPECT_NEAR(found.x, expected.x, 0.3);  // measured 0.049
            EXPECT_NEAR(found.y, expected.y, 0.2);  // measured 0.04
            // the fully covered pixels of the disc: all except a ring half a pixel wide
            const double core = pi * std::pow(layout.bob_radius - 0.5, 2);
            EXPECT_NEAR(static_cast<double>(found.area), core, 0.06 * core);  // measured 3 %
        }
    }
}

TEST(DrawnPositions, BobsHaveAnAreaLikeTheirMass) {
    const auto [scene, layout, picture] = Drawn(scene_of("butterfly", {"system.mass_kg=[2, 0.5]", "video.trail_s=0"}));
    const auto& panel = layout.panels.front();
    const auto heavy = blob_at(picture, panel.at(1, 0), 1.5f * layout.bob_radius, themes[0].bob);
    const auto light = blob_at(picture, panel.at(2, 0), 1.5f * layout.bob_radius, themes[0].sides[0]);
    EXPECT_NEAR(static_cast<double>(heavy.area) / static_cast<double>(light.area), 4,
                0.4);  // measured 4.2: the smaller disc loses a larger share of its pixels to the edge
}

TEST(DrawnPositions, AxisTicksFallOnDecades) {
    const auto [scene, layout, picture] = Drawn(scene_of("butterfly", {"video.distance_range=[1e-5, 1e1]"}));
    const auto& strip = layout.strips[0];
    // between two lines of the time grid, only the lines of the decades have the grid's colour
    const int x = static_cast<int>(strip.time.at(27)) + 3;
    int rows = 0;
    for (int y = static_cast<int>(strip.area.top); y < static_cast<int>(strip.area.bottom); ++y) {
        if (!is_color(picture.at(x, y), themes[0].grid, 2)) continue;
        ++rows;
        const double decade = -5 + 6 * (strip.area.bottom - (y + 0.5)) / strip.area.height();
        EXPECT_NEAR(decade, std::round(decade), 0.75 * 6 / strip.area.height());  // within 3/4 of a pixel
    }
    EXPECT_GE(rows, 2);
}

TEST(DrawnPositions, TraceIsAtTheDistanceItShows) {
    // mirror images: while both rest, the distance keeps its initial value 2 (x1, x2), here 10^0.65
    const auto [scene, layout, picture] =
        Drawn(scene_of("butterfly", {"b.angle_deg=[-90, -90]", "video.distance_range=[1e-3, 1e3]"}));
    const auto& strip = layout.strips[0];
    const double distance = std::sqrt(4.0 + 16.0);
    const double y = strip.area.bottom - strip.area.height() * (std::log10(distance) + 3) / 6;
    const auto dot = blob_at(picture, {strip.area.left + 4, static_cast<float>(y)}, 12, themes[0].trace);
    EXPECT_GT(dot.area, 20);
    EXPECT_NEAR(dot.y, y, 0.5);  // measured 0.2
}

TEST(DrawnPositions, TimesAfterThePredictabilityLimitAreShaded) {
    const Drawn film(scene_of("horizon", {"scene.duration_s=35"}));
    ASSERT_TRUE(film.scene.horizon());
    const auto& strip = film.layout.strips[0];
    const float x = strip.time.at(*film.scene.horizon()), y = strip.area.top + 5;  // away from the lines of the axes
    EXPECT_TRUE(film.has({x - 6, y}, themes[0].background, 2));
    EXPECT_TRUE(film.has({x + 6, y}, themes[0].panel, 2));
    // a film that is predictable to its end has no horizon
    EXPECT_FALSE(scene_of("horizon", {"scene.duration_s=20"}).horizon());
    EXPECT_FALSE(scene_of("butterfly").horizon());
}

TEST(DrawnPositions, ADivergingRunStaysInItsPanel) {
    // explicit Euler with very large steps stretches the rods: bobs and trails leave the panel and must be clipped
    const auto scene =
        scene_of("butterfly", {"system.model=\"constraints\"", "system.step_s=\"1/120\"", "video.size=[640, 360]"});
    const auto layout = make_layout(scene);
    bool outside = false;
    PairRun pair(scene);
    long sample = 0;
    for (; sample < 2400 && !outside; ++sample) {
        const auto state = pair.next(never_stopped);
        const auto& bob = state.a.bobs[1];
        outside = !layout.panels.front().area.contains(layout.panels.front().at(bob.x, bob.y));
    }
    ASSERT_TRUE(outside);
    const auto picture = frame_of(scene, sample - 1), calm = frame_of(scene, 0);
    const auto& left = layout.panels[0].area;
    const auto& right = layout.panels[1].area;
    // the gap between the panels, and everything above them except the clock
    for (int y = static_cast<int>(left.top); y < static_cast<int>(left.bottom); ++y)
        for (int x = static_cast<int>(left.right) + 3; x < static_cast<int>(right.left) - 3; ++x)
            ASSERT_TRUE(is_color(picture.at(x, y), themes[0].background, 2)) << x << " " << y;
    for (int y = 0; y < static_cast<int>(left.top) - 8; ++y)
        for (int x = 0; x < 300; ++x)
            ASSERT_TRUE(std::equal(picture.at(x, y), picture.at(x, y) + 3, calm.at(x, y))) << x << " " << y;
}

}  // namespace doppel::drawn_positions_test
