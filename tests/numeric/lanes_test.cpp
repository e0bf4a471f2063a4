#include "numeric/lanes.hpp"

#include "integrate/euler.hpp"
#include "integrate/runge_kutta.hpp"
#include "numeric/support.hpp"
#include "physics/angle_chain.hpp"
#include "physics/rod_chain.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace doppel {
namespace lanes_test {

/// A different pendulum for every lane.
Pendulum<double> trial(int number, std::size_t links) {
    std::mt19937 random(static_cast<unsigned>(number));
    std::uniform_real_distribution<double> some(0.5, 2);
    Pendulum<double> p;
    p.mass.clear(), p.length.clear(), p.angle.clear(), p.rate.clear();
    for (std::size_t i = 0; i < links; ++i) {
        p.mass.push_back(some(random));
        p.length.push_back(some(random));
        p.angle.push_back(2 * some(random) - 2);
        p.rate.push_back(some(random) - 1);
    }
    return p;
}

template <class Side>
Pendulum<Side> side_by_side(std::size_t links) {
    auto sides = trial(0, links).template cast<Side>();
    for (int lane = 0; lane < Side::width; ++lane) {
        const auto p = trial(lane, links);
        for (std::size_t i = 0; i < links; ++i) {
            sides.mass[i].set(lane, p.mass[i]);
            sides.length[i].set(lane, p.length[i]);
            sides.angle[i].set(lane, p.angle[i]);
            sides.rate[i].set(lane, p.rate[i]);
        }
    }
    return sides;
}

/// Whether `steps` of the method give each lane the bits of a double.
template <class Which, template <class> class Model, int width>
void expect_the_bits_of_double(std::size_t links) {
    using Side = Lanes<width>;
    constexpr long steps = 3000;
    const double step = 1.0 / 3000;
    Model<Side> model(side_by_side<Side>(links));
    typename Which::template Stepper<Model<Side>> stepper(model, Model<Side>::start(side_by_side<Side>(links)),
                                                          Side(step));
    stepper.advance(steps);
    const auto y = stepper.state();
    for (int lane = 0; lane < width; ++lane) {
        Model<double> lone(trial(lane, links));
        typename Which::template Stepper<Model<double>> alone(lone, Model<double>::start(trial(lane, links)), step);
        alone.advance(steps);
        for (Eigen::Index i = 0; i < y.size(); ++i)
            EXPECT_EQ(bits(y[i][lane]), bits(alone.state()[i])) << "lane " << lane << ", entry " << i;
    }
}

template <class Scalar>
using AngleChain3 = AngleChain<Scalar, 3>;
template <class Scalar>
using RodChain2 = RodChain<Scalar, 2>;
template <class Scalar>
using RodChain3 = RodChain<Scalar, 3>;
template <class Scalar>
using LongRodChain = RodChain<Scalar, Eigen::Dynamic>;

TEST(Lanes, StepToTheBitsOfDouble) {
    expect_the_bits_of_double<Euler, DoublePendulum, 2>(2);
    expect_the_bits_of_double<Rk4, DoublePendulum, 8>(2);
    expect_the_bits_of_double<Rk4, AngleChain3, 4>(3);
    expect_the_bits_of_double<Rk4, RodChain2, 8>(2);
    expect_the_bits_of_double<Euler, RodChain3, 8>(3);
    expect_the_bits_of_double<Rk4, LongRodChain, 2>(6);
}

TEST(Lanes, RoundLikeDouble) {
    std::mt19937_64 random(1);
    using Side = Lanes<4>;
    const auto any = [&] {
        return std::ldexp(std::uniform_real_distribution<double>(-1, 1)(random), static_cast<int>(random() % 40) - 20);
    };
    for (int i = 0; i < 20'000; ++i) {
        Side a, b;
        for (int lane = 0; lane < 4; ++lane) a.set(lane, any()), b.set(lane, any());
        for (int lane = 0; lane < 4; ++lane) {
            const double x = a[lane], y = b[lane];
            ASSERT_EQ(bits((a + b)[lane]), bits(x + y));
            ASSERT_EQ(bits((a - b)[lane]), bits(x - y));
            ASSERT_EQ(bits((a * b + a)[lane]), bits(x * y + x));  // not fused
            ASSERT_EQ(bits((a / b)[lane]), bits(x / y));
            ASSERT_EQ(bits(sqrt(abs(a))[lane]), bits(std::sqrt(std::abs(x))));
            ASSERT_EQ(bits((-a)[lane]), bits(-x));
        }
    }
}

TEST(Lanes, ConstantsKeepTheirSign) {
    EXPECT_EQ(bits(Lanes<8>(-0.0)[5]), bits(-0.0));
    EXPECT_EQ(bits(Lanes<8>(0)[5]), bits(0.0));
    EXPECT_EQ(bits((-Lanes<4>(0.0))[1]), bits(-0.0));
}

TEST(Lanes, SelectDecidesLaneByLane) {
    Lanes<4> a(1);
    a.set(2, 3);
    a.set(3, std::numeric_limits<double>::quiet_NaN());
    const auto small = a <= Lanes<4>(2);
    EXPECT_FALSE(all_of(small));
    EXPECT_TRUE(all_of(Lanes<4>(1) < Lanes<4>(2)));
    const auto chosen = select(small, Lanes<4>(10), Lanes<4>(20));
    EXPECT_EQ(chosen[0], 10);
    EXPECT_EQ(chosen[1], 10);
    EXPECT_EQ(chosen[2], 20);
    EXPECT_EQ(chosen[3], 20);  // NaN is not small
}

TEST(Lanes, TheGreaterIsNoNumberWhereEitherIsNone) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto& [a, b, expected] :
         {std::array{1.0, 2.0, 2.0}, {2.0, 1.0, 2.0}, {nan, 1.0, nan}, {1.0, nan, nan}}) {
        EXPECT_EQ(bits(greater(a, b)), bits(expected));
        Lanes<4> wide(5);
        wide.set(2, a);
        const auto all = greater(wide, Lanes<4>(b));
        EXPECT_EQ(bits(all[2]), bits(expected));
        EXPECT_EQ(std::isnan(all[1]), std::isnan(b));
    }
}

}  // namespace lanes_test
}  // namespace doppel
