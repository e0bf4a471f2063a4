#include "render/pixels.hpp"
#include "render/stroke.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace doppel::strokes_test {

constexpr Size size{160, 120};

Stroke stroke(std::vector<Point> points, float width, Color color = white) {
    Stroke made{.vertices = {}, .width = width, .color = color};
    for (const Point& p : points) made.vertices.push_back({p, 1});
    return made;
}

TEST(Stroke, IsAsOpaqueAtItsJointsAndCrossingsAsElsewhere) {
    // a loop that crosses itself, with joints of all angles, cusps, and a repeated vertex
    std::vector<Point> points{{20, 20}, {140, 100}, {140, 100}, {140, 20}, {20, 100}, {20, 20}, {80, 20}, {20, 22}};
    for (int i = 0; i <= 60; ++i) {
        const float angle = static_cast<float>(i) * 0.1f;
        points.push_back({80 + 30 * std::sin(2 * angle), 60 + 30 * std::cos(3 * angle)});
    }
    const Picture picture = drawn(size, {stroke(points, 9, white.with_alpha(0.4f))});
    int maximum = 0;
    for_each_pixel(picture, [&](int x, int y) { maximum = std::max<int>(maximum, picture.at(x, y)[0]); });
    EXPECT_EQ(maximum, 102);  // 0.4 · 255
    for (const auto& [x, y] : {std::pair(80, 60), {138, 98}, {140, 60}}) EXPECT_EQ(picture.at(x, y)[0], 102) << x;
}

TEST(Stroke, OfOneVertexIsADisc) {
    for (const auto& points : {std::vector<Point>{{40, 50}}, std::vector<Point>{{40, 50}, {40, 50}}}) {
        const Ink seen = ink(drawn(size, {stroke(points, 20)}));
        EXPECT_NEAR(seen.area / (std::numbers::pi * 100), 1, 0.005);  // measured 0.0002
        EXPECT_NEAR(seen.x, 40, 0.05);                                // measured 1e-14
        EXPECT_NEAR(seen.y, 50, 0.05);
    }
}

TEST(Stroke, FadesAlongItself) {
    Stroke fading{.vertices = {{{10, 60}, 0}, {{150, 60}, 1}}, .width = 8, .color = white};
    const Picture picture = drawn(size, {fading});
    for (int x = 10; x < 150; ++x) {
        EXPECT_NEAR(picture.at(x, 60)[0], 255 * (x + 0.5 - 10) / 140, 1);  // measured 0.5
    }
}

TEST(Stroke, CoversWhatLiesWithinHalfItsWidth) {
    // many more vertices than bends
    std::vector<Point> points;
    for (int i = 0; i <= 5000; ++i) {  // 0.1 px apart at most
        const float x = 10 + 0.028f * static_cast<float>(i);
        points.push_back({x, 60 + 40 * std::sin(x / 7)});
    }
    const Picture picture = drawn(size, {stroke(points, 3)});
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            double nearest = 1e9;
            for (const Point& p : points) nearest = std::min(nearest, std::hypot(x + 0.5 - p.x, y + 0.5 - p.y));
            ASSERT_NEAR(picture.at(x, y)[0], 255 * std::clamp(0.5 - (nearest - 1.5), 0.0, 1.0), 2);  // measured 1.03
        }
    }
}

/// The path made of the ends of its pieces.
Stroke in_pieces(const Stroke& whole) {
    Stroke pieces = whole;
    pieces.vertices.clear();
    for (std::size_t i = 0; i + 1 < whole.vertices.size();) {
        const StrokePiece piece = next_piece(whole.vertices, i);
        pieces.vertices.push_back(whole.vertices[i]);
        pieces.vertices.back().bend = piece.bend;
        i = piece.last;
    }
    pieces.vertices.push_back(whole.vertices.back());
    return pieces;
}

TEST(Stroke, FollowsACircleInFewPieces) {
    for (const float turn : {1.0f, -1.0f}) {
        std::vector<Point> points;
        for (int i = 0; i <= 126; ++i) {
            const float angle = turn * static_cast<float>(2 * std::numbers::pi * i / 126);
            points.push_back({80 + 50 * std::cos(angle), 60 + 50 * std::sin(angle)});  // 2.5 px apart
        }
        const Stroke pieces = in_pieces(stroke(points, 4));
        EXPECT_LE(pieces.vertices.size(), 17u);  // measured 15; 64 with straight pieces
        const Picture bent = drawn(size, {pieces}), round = drawn(size, {Ring{{80, 60}, 50, 4, white}});
        int maximum = 0;
        for_each_pixel(
            bent, [&](int x, int y) { maximum = std::max(maximum, std::abs(bent.at(x, y)[0] - round.at(x, y)[0])); });
        EXPECT_LE(maximum, 20);  // measured 11: 0.04 px
    }
}

TEST(Stroke, BendsToTheRightAsFarAsItSays) {
    Stroke arc{.vertices = {{{20, 60}}, {{140, 60}}}, .width = 4, .color = white};
    arc.vertices[0].bend = 7;
    const Picture picture = drawn(size, {arc});
    for (int x = 24; x < 136; ++x) {
        const double share = (x + 0.5 - 20) / 120, middle = 60 + 4 * 7 * share * (1 - share);
        double sum = 0, state = 0;
        for (int y = 0; y < size.height; ++y) {
            sum += picture.at(x, y)[0];
            state += picture.at(x, y)[0] * (y + 0.5);
        }
        EXPECT_NEAR(state / sum, middle, 0.02) << x;  // measured 0.014
    }
}

TEST(Stroke, KeepsItsCornersAndJoints) {
    // any three points lie on a parabola, but the segments between them do not
    const auto corner = stroke({{20, 20}, {80, 30}, {140, 20}}, 4).vertices;
    EXPECT_EQ(next_piece(corner, 0).last, 1u);
    EXPECT_EQ(next_piece(corner, 0).bend, 0);
    auto line = stroke({{20, 20}, {80, 20}, {140, 20}}, 4).vertices;
    EXPECT_EQ(next_piece(line, 0).last, 2u);
    line[1].joint = true;
    EXPECT_EQ(next_piece(line, 0).last, 1u);
}

TEST(Stroke, ChangesItsStyleAtOnceAtTwoJoints) {
    Stroke step{.vertices = {{{20, 60}, 0.2f}, {{50, 60}, 0.2f}, {{80, 60}, 0.2f}}, .width = 20, .color = white};
    for (const float x : {80.f, 110.f, 140.f}) step.vertices.push_back({{x, 60}, 0.8f});
    for (auto& vertex : step.vertices) vertex.joint = true;
    const Picture picture = drawn(size, {step});
    EXPECT_EQ(picture.at(77, 60)[0], 51);  // without a disc of the brighter half
    EXPECT_EQ(picture.at(82, 60)[0], 204);
}

TEST(Stroke, TapersBetweenItsVertices) {
    const Picture picture =
        drawn(size, {Stroke{.vertices = {{{20, 60}, 1, 0.25f}, {{140, 60}, 1, 1}}, .width = 20, .color = white}});
    for (int x = 20; x < 140; ++x) {
        double covered = 0;
        for (int y = 0; y < size.height; ++y) covered += picture.at(x, y)[0] / 255.0;
        EXPECT_NEAR(covered, 5 + 15 * (x + 0.5 - 20) / 120, 0.02) << x;  // measured 0.0037
    }
}

TEST(Stroke, GlowsBeyondItsEdge) {
    const Stroke stroke{.vertices = {{{20, 60}, 0.8f}, {{140, 60}, 0.8f}}, .width = 6, .color = white, .glow = 12};
    const Capsule capsule{{20, 60}, {140, 60}, 3, white.with_alpha(0.8f), 12};
    for (const Picture& picture : {drawn(size, {stroke}), drawn(size, {capsule})}) {
        EXPECT_EQ(picture.at(80, 60)[0], 204);
        for (int y = 63; y < 80; ++y) {
            const double beyond = y + 0.5 - 63, dim = std::max(0.0, 1 - beyond / 12);
            const double edge = std::max(0.0, 0.5 - beyond);
            EXPECT_NEAR(picture.at(80, y)[0], 204 * (edge + (1 - edge) * dim * dim / 3), 1) << y;  // measured 0.5
        }
        EXPECT_EQ(picture.at(80, 75)[0], 0);
    }
}

TEST(Stroke, DoesNotChangeOthersOrTheBackdrop) {
    const Color color = rgb(0x4fb0ff);
    const Picture picture =
        drawn(size, {filled(size, color), stroke({{20, 20}, {60, 20}}, 6), stroke({{20, 40}, {60, 40}}, 6, black)});
    for (const float y : {10.f, 30.f, 50.f}) EXPECT_TRUE(is_color(picture, {40, y}, color, 0)) << y;
    EXPECT_TRUE(is_color(picture, {40, 20}, white, 0));
    EXPECT_TRUE(is_color(picture, {40, 40}, black, 0));
}

}  // namespace doppel::strokes_test
