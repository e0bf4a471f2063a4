#include "integrate/taylor_batch.hpp"

#include "base/error.hpp"
#include "integrate/taylor.hpp"
#include "integrate/widths.hpp"
#include "numeric/quad.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace doppel {
namespace taylor_batch_test {

using AnyState = State<double, Eigen::Dynamic>;
constexpr double interval = 1.0 / 120;

/// With everything unequal.
std::vector<Pendulum<double>> released(std::size_t links, std::size_t count) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> size(0.5, 2), angle(-2.5, 2.5), rate(-3, 3);
    std::vector<Pendulum<double>> all(count);
    for (auto& p : all) {
        for (auto* numbers : {&p.mass, &p.length, &p.angle, &p.rate}) numbers->clear();
        for (std::size_t j = 0; j < links; ++j) {
            p.mass.push_back(size(random));
            p.length.push_back(size(random));
            p.angle.push_back(angle(random));
            p.rate.push_back(rate(random));
        }
        p.gravity = 9.8 * size(random);
    }
    return all;
}

AnyState state(const TaylorBatch& batch, std::size_t member) {
    AnyState y;
    batch.read(member, y);
    return y;
}

template <int N>
void expect_the_motion(double most) {
    const auto all = released(N, 11);
    TaylorBatch batch(all, 1e-13, interval);
    for (int n = 0; n < 200; ++n) batch.advance();  // beyond the first window
    for (std::size_t i = 0; i < all.size(); ++i) {
        using Model = AngleChain<Quad, N>;
        Model model(all[i].template cast<Quad>());
        TaylorStepper<Model> exact(model, Model::start(all[i].template cast<Quad>()), Quad(1e-22));
        exact.advance(Quad(200) / Quad(120));
        EXPECT_LT((state(batch, i) - exact.state().template cast<double>()).norm(), most) << i;
    }
}

TEST(TaylorBatch, FollowsTheMotionInQuad) {
    expect_the_motion<2>(1e-11);  // measured 3.1e-12
    expect_the_motion<3>(2e-11);  // measured below 2e-11
}

TEST(TaylorBatch, EveryPendulumIsTheSameAtEveryWidthAndInAnyCompany) {
    for (const std::size_t links : {2u, 3u}) {
        const auto all = released(links, 21);
        TaylorBatch narrow(all, 1e-10, interval, 2);
        for (int n = 0; n < 300; ++n) narrow.advance();
        for (const int width : register_widths()) {
            TaylorBatch batch(all, 1e-10, interval, width);
            const std::span one(&all[7], 1);
            TaylorBatch alone(one, 1e-10, interval, width);
            for (int n = 0; n < 300; ++n) {
                batch.advance();
                alone.advance();
            }
            for (std::size_t i = 0; i < all.size(); ++i) ASSERT_EQ(state(batch, i), state(narrow, i)) << width;
            ASSERT_EQ(state(alone, 0), state(narrow, 7)) << width;
        }
    }
}

TEST(TaylorBatch, StartsAtTheRelease) {
    const auto all = released(3, 5);
    const TaylorBatch batch(all, 1e-9, interval);
    for (std::size_t i = 0; i < all.size(); ++i)
        EXPECT_EQ(state(batch, i), (released_in_angles<double, Eigen::Dynamic>(all[i])));
}

TEST(TaylorBatch, TakesFewerDigitsWhereAsked) {
    const auto all = released(2, 8);
    TaylorBatch rough(all, 1e-5, interval), fine(all, 1e-14, interval);
    for (int n = 0; n < 120; ++n) {
        rough.advance();
        fine.advance();
    }
    double worst = 0;
    for (std::size_t i = 0; i < all.size(); ++i) worst = std::max(worst, (state(rough, i) - state(fine, i)).norm());
    EXPECT_LT(worst, 1e-3);
    EXPECT_GT(worst, 1e-9);
}

TEST(TaylorBatch, HangsStillAndMovesOnWithoutGravity) {
    std::vector<Pendulum<double>> all(2);
    all[1].gravity = 0;
    all[1].angle = {0.3, 0.3};
    all[1].rate = {2, 2};
    TaylorBatch batch(all, 1e-14, interval);
    for (int n = 0; n < 240; ++n) batch.advance();
    EXPECT_EQ(state(batch, 0), (State<double, 4>::Zero()));
    EXPECT_NEAR(state(batch, 1)[0], 0.3 + 2 * 2, 1e-13);  // stretched out, it turns evenly
}

TEST(TaylorBatch, WhatIsNoNumberStaysNoneAndHarmsNoneBesides) {
    auto all = released(2, 4);
    const auto sound = all;
    all[1].rate[0] = std::nan("");
    all[2].rate[0] = 1e200;
    TaylorBatch batch(all, 1e-10, interval), expected(sound, 1e-10, interval);
    for (int n = 0; n < 200; ++n) {
        batch.advance();
        expected.advance();
    }
    EXPECT_TRUE(std::isnan(state(batch, 1)[0]));
    EXPECT_FALSE(std::isfinite(state(batch, 2)[1]));
    EXPECT_EQ(state(batch, 3), state(expected, 3));
}

TEST(TaylorBatch, RefusesWhatItCannotStep) {
    const auto four = released(4, 1), two = released(2, 1);
    EXPECT_THROW(TaylorBatch(four, 1e-9, interval), Error);
    EXPECT_THROW(TaylorBatch(two, 1e-17, interval), Error);
    EXPECT_THROW(TaylorBatch({}, 1e-9, interval), Error);
    EXPECT_FALSE(TaylorBatch::serves(Model::constraints, 2));
}

}  // namespace taylor_batch_test
}  // namespace doppel
