#include "render/renderer.hpp"

#include "errors.hpp"
#include "render/pixels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <random>

namespace doppel::renderer_test {

constexpr Size size{320, 240};

/// Lists of all kinds of items, some of which remain in the next list as in a film.
class RandomLists {
public:
    DisplayList next() {
        std::shuffle(list_.begin(), list_.end(), random_);
        if (chance(0.2f)) list_.clear();
        if (list_.size() > 6) list_.resize(6);
        for (Item& item : list_) {
            if (auto* stroke = std::get_if<Stroke>(&item)) grow(*stroke);
            if (auto* capsule = std::get_if<Capsule>(&item); capsule && chance(0.3f)) move(*capsule);
        }
        for (int i = 0; i < 3; ++i) list_.push_back(item());
        return list_;
    }

private:
    float between(float a, float b) { return std::uniform_real_distribution<float>(a, b)(random_); }
    bool chance(float part) { return between(0, 1) < part; }
    Point point() { return {between(-40, 360), between(-40, 280)}; }
    Color color() { return {between(0, 1), between(0, 1), between(0, 1), chance(0.5f) ? 1 : between(0, 1)}; }

    void grow(Stroke& stroke) {
        Point at = stroke.vertices.empty() ? point() : stroke.vertices.back().at;
        const bool bends = chance(0.5f);
        for (int i = 0; i < 20; ++i) {
            const Point step =
                bends ? Point{between(-60, 80), between(-60, 60)} : Point{between(-6, 8), between(-6, 6)};
            at = {at.x + step.x, at.y + step.y};
            stroke.vertices.push_back({at, between(0, 1), between(0, 1)});
            if (bends && chance(0.8f)) stroke.vertices.back().bend = between(-3, 3);
            stroke.vertices.back().joint = chance(0.3f);
        }
    }

    /// Moves an item, possibly out of the picture.
    void move(Capsule& capsule) {
        const float x = between(-150, 150), y = between(-150, 150);
        for (Point* end : {&capsule.from, &capsule.to}) *end = {end->x + x, end->y + y};
    }

    Item item() {
        const Point a = point(), b = point();
        const float glow = chance(0.4f) ? between(0, 25) : 0;
        switch (random_() % 6) {
            case 0:
                return Box{a.x, a.y, a.x + between(0, 90), a.y + between(0, 90), between(0, 20), color()};
            case 1:
                return Capsule{a, chance(0.3f) ? a : b, between(0.1f, 20), color(), glow};
            case 2:
                return Ring{a, between(1, 50), between(0.2f, 9), color()};
            case 3: {
                Stroke stroke{.vertices = {}, .width = between(0.3f, 9), .color = color(), .glow = glow};
                grow(stroke);
                return stroke;
            }
            case 4:
                // long and oblique: redrawn in bands, clipped at their edges
                return Capsule{{between(-900, 0), a.y}, {between(320, 1200), b.y}, between(0.3f, 8), color(), glow};
            default: {
                const Weight weight = chance(0.5f) ? Weight::bold : Weight::regular;
                const float em = chance(0.5f) ? 16.0f : 31.5f;
                return Label{std::to_string(random_() % 1000) + " Öl", a, em, Align::center, weight, color()};
            }
        }
    }

    std::mt19937 random_{20240229};
    DisplayList list_;
};

TEST(Renderer, DrawsTheSamePixelsAsIfItDrewAllAnew) {
    DisplayList backdrop{filled(size, rgb(0x11151d)), Ring{{160, 120}, 80, 5, rgb(0x98a2b3)},
                         Stroke{{{{20, 20}, 1}, {{300, 200}, 0.3f}}, 7, rgb(0xffa640)}};
    Renderer old(size, backdrop);
    RandomLists lists;
    Picture last;
    std::size_t left_alone = 0;
    for (int round = 0; round < 60; ++round) {
        const DisplayList list = lists.next();
        const Picture& picture = old.draw(list);
        Renderer fresh(size, backdrop);
        ASSERT_EQ(picture.rgba, fresh.draw(list).rgba) << "in round " << round;
        for (std::size_t i = 3; i < picture.rgba.size(); i += 4) ASSERT_EQ(picture.rgba[i], 255) << "it is opaque";

        // pixels outside the changed area are unchanged
        if (round > 0) {
            std::size_t same = 0, expected = 0;
            for_each_pixel(picture, [&](int x, int y) {
                const auto meets = [&](const Rect& r) { return !intersection(r, {x, y, x + 1, y + 1}).empty(); };
                if (std::ranges::any_of(old.changed(), meets)) return;
                ++expected;
                same += std::equal(picture.at(x, y), picture.at(x, y) + 4, last.at(x, y));
            });
            ASSERT_EQ(same, expected) << "in round " << round;
            left_alone += same;
        }
        last = picture;
    }
    EXPECT_GT(left_alone, 100000u);  // of 4.5 million; otherwise the test has no effect
}

TEST(Renderer, TouchesOnlyWhatChanges) {
    Renderer renderer(size, {filled(size, black)});
    DisplayList list{Capsule{{50, 50}, {50, 50}, 10, white}, Capsule{{250, 200}, {250, 200}, 10, white}};
    renderer.draw(list);
    EXPECT_EQ(renderer.changed(), (std::vector<Rect>{{0, 0, size.width, size.height}}));
    renderer.draw(list);
    EXPECT_TRUE(renderer.changed().empty());
    std::get<Capsule>(list[1]).color = rgb(0xffa640);
    renderer.draw(list);
    ASSERT_EQ(renderer.changed().size(), 1u);
    EXPECT_EQ(renderer.changed()[0], (Rect{239, 189, 261, 211}));
}

TEST(Renderer, RefusesSizesThatOpenGlCannotDraw) {
    for (const Size wrong : {Size{1000000, 10}, Size{10, 1000000}, Size{0, 10}, Size{10, -1}}) {
        const auto [code, message] = test::thrown_by([&] { Renderer renderer(wrong); });
        EXPECT_EQ(code, ExitCode::io_failed) << wrong.width << " × " << wrong.height;
        EXPECT_NE(message.find(std::to_string(wrong.width)), std::string::npos) << message;
    }
}

TEST(Renderer, DrawsLargePicturesInPartsAsInOne) {
    const Size large{4200, 4000};  // 16.8 million px: two pieces, which meet at row 3809
    DisplayList list{Capsule{{100, 3700}, {4100, 3950}, 30, rgb(0xffa640)}, Box{2000, 3800.5f, 2100, 3820.5f, 6, white},
                     Ring{{600, 3809}, 40, 7, white},
                     Label{"at the seam", {3000, 3815}, 40, Align::center, Weight::bold, white}};
    Stroke stroke{.vertices = {}, .width = 9, .color = rgb(0x4fb0ff)};
    for (int i = 0; i < 60; ++i) {
        const float t = 0.3f * static_cast<float>(i);
        stroke.vertices.push_back({{1000 + 30 * t, 3809 + 60 * std::sin(t)}, t / 20});
    }
    list.push_back(stroke);
    Renderer in_parts(large, {filled(large, black)}), in_one(large, {filled(large, black)});
    in_one.draw({});
    EXPECT_EQ(in_one.draw(list).rgba, in_parts.draw(list).rgba);  // the change is smaller than 16 million px
}

TEST(Renderer, StopsBetweenThePartsOfAPictureAndDrawsOnLater) {
    const std::atomic<bool> stopped = true;
    EXPECT_THROW(Renderer(size, {}, Gl::automatic, stopped), Error);
    const DisplayList dot{Capsule{{20, 20}, {20, 20}, 5, white}};
    Renderer renderer(size), other(size);
    renderer.draw({});
    EXPECT_EQ(test::thrown_by([&] { renderer.draw(dot, stopped); }).first, ExitCode::interrupted);
    EXPECT_EQ(renderer.draw(dot).rgba, other.draw(dot).rgba);
}

TEST(Renderer, RefusesLettersThatFitNowhere) {
    Renderer renderer(size);
    EXPECT_THROW(renderer.draw({Label{.text = "W", .anchor = {0, 0}, .size = 3000, .color = white}}), Error);
}

}  // namespace doppel::renderer_test
