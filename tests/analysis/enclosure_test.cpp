#include "analysis/enclosure.hpp"

#include "analysis/ball_series.hpp"
#include "integrate/motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

namespace doppel::enclosure_test {

const std::atomic<bool> never = false;
const auto unwatched = [](long) {};

/// Two links by their decimals; angles in degrees.
EnclosedSystem system_of(const std::array<const char*, 8>& links, const char* gravity) {
    const auto degree = pi_ball<Ball<Wide>>() / Ball<Wide>(180);
    std::array<Ball<Wide>, 8> x;
    for (std::size_t i = 0; i < 8; ++i) {
        x[i] = ball_of_decimal(links[i]);
        if (i >= 4 && x[i].radius > 0) x[i] *= degree;
    }
    return {{{x[0], x[1]}, {x[2], x[3]}, {x[4], x[5]}, {x[6], x[7]}, ball_of_decimal(gravity)}};
}
const auto right_angles = system_of({"1", "1", "1", "1", "90", "90", "0", "0"}, "9.8");
const auto uneven = system_of({"0.7", "1.3", "1.1", "0.6", "120", "-35", "40", "-90"}, "9.81");

/// The start: θ1, θ2, ω1, ω2.
std::array<Ball<Wide>*, 4> start_of(EnclosedSystem& p) {
    return {&p.chain.angle[0], &p.chain.angle[1], &p.chain.rate[0], &p.chain.rate[1]};
}

/// The motion from a start moved by `shift`.
MotionSpec motion_of(const EnclosedSystem& p, const std::array<double, 4>& shift = {}) {
    const auto quads = [](const std::vector<Ball<Wide>>& numbers) {
        std::vector<Quad> all;
        for (const auto& x : numbers) all.push_back(Quad(x.center));
        return all;
    };
    MotionSpec spec;
    spec.chain = Pendulum<Quad>{quads(p.chain.mass), quads(p.chain.length), quads(p.chain.angle), quads(p.chain.rate),
                                Quad(p.chain.gravity.center)};
    for (std::size_t i = 0; i < 2; ++i) {
        spec.chain->angle[i] += shift[i];
        spec.chain->rate[i] += shift[i + 2];
    }
    spec.method = "taylor";
    spec.precision = Precision::in_quad;
    spec.tolerance = parse_quad("1e-30");
    return spec;
}

/// θ1, θ2, ω1, ω2
using Numbers = std::array<Quad, 4>;

Numbers numbers_of(const Motion& motion) {
    const auto bobs = motion.observe().exact;
    return {bobs[0].theta, bobs[1].theta, bobs[0].omega, bobs[1].omega};
}

/// The states of a motion in quad at samples 0, 1 ….
std::vector<Numbers> states_of(const MotionSpec& spec, long samples) {
    const auto motion = make_motion(spec);
    std::vector<Numbers> all{numbers_of(*motion)};
    for (long n = 0; n < samples; ++n) {
        motion->advance(never);
        all.push_back(numbers_of(*motion));
    }
    return all;
}

/// The same by the reference's method.
std::vector<Numbers> reference(const EnclosedSystem& p, long samples, const std::array<double, 4>& shift = {}) {
    return states_of(motion_of(p, shift), samples);
}

/// Whether every state is in its set; the reference's own error is at most 1e-26.
template <class Scalar>
bool all_inside(const std::vector<EnclosedState<Scalar>>& sets, const std::vector<Numbers>& states) {
    if (sets.size() < states.size()) return false;
    for (std::size_t n = 0; n < states.size(); ++n)
        for (std::size_t i = 0; i < 4; ++i)
            if (abs(Wide(Wide(sets[n][i].center) - Wide(states[n][i]))) > Wide(sets[n][i].radius) + Wide(1e-26))
                return false;
    return true;
}

template <class Scalar>
std::vector<EnclosedState<Scalar>> enclosed(const EnclosedSystem& p, long samples, double radius = 0,
                                            const EnclosureSpec& other = {}) {
    auto spec = other;
    spec.samples = samples;
    auto wide = p;
    for (auto* x : start_of(wide)) x->radius += radius;
    return enclosures<Scalar>(wide, spec, unwatched);
}

template <class Scalar>
double radius_at_end(const std::vector<EnclosedState<Scalar>>& sets) {
    double worst = 0;
    for (const auto& x : sets.back()) worst = std::max(worst, x.radius);
    return worst;
}

std::array<double, 4> corner(unsigned index, double radius) {
    std::array<double, 4> shift;
    for (unsigned i = 0; i < 4; ++i) shift[i] = (index >> i & 1u) != 0 ? radius : -radius;
    return shift;
}

/// y = 1/(1 − t), expanded to t = 1/4.
template <class B>
auto hyperbola(BallSeries<B>& series) {
    const auto y = series.state(B(1));
    series.set_rate(y, y * y);
    series.expand(B(1) / B(4));
    return y;
}

TEST(BallSeries, ContainsAClosedFormAndRefusesWhatItCannotBound) {
    using B = Ball<Quad>;
    BallSeries<B> series(20);
    const auto y = hyperbola(series);
    ASSERT_TRUE(series.find_remainders());
    const auto error = [&](bool has_remainder) {
        const B end = series.value(y.node(), B(1), has_remainder);
        return abs(Quad(end.center - Quad(4) / 3)) / Quad(end.radius);
    };
    EXPECT_LE(error(true), 1);
    EXPECT_GT(error(false), 1e6);
    series.expand(B(2));  // beyond the singularity
    EXPECT_FALSE(series.find_remainders());
    series.clear();
    const auto root = series.state(B(1));
    series.set_rate(root, B(1) / root);
    series.expand(B(1) / B(4));
    EXPECT_THROW(series.find_remainders(), std::logic_error);
}

TEST(BallSeries, AtOrderOneEveryTermOfTheRemainderIsNeeded) {
    using B = Ball<double>;
    BallSeries<B> series(1);
    const auto y = hyperbola(series);
    ASSERT_TRUE(series.find_remainders());
    const B end = series.value(y.node(), B(1));
    EXPECT_LE(std::abs(end.center - 4.0 / 3), end.radius);  // 0.0833 and 0.097; 0.082 without a product
}

TEST(Enclosure, ContainsTheReferenceInQuad) {
    const auto known = reference(right_angles, 1200);
    const auto in_double = enclosed<double>(right_angles, 1200);
    EXPECT_TRUE(all_inside(in_double, known));
    EXPECT_LT(radius_at_end(in_double), 1e-9);  // measured 5.3e-10
    const auto in_quad = enclosed<Quad>(right_angles, 360);
    EXPECT_TRUE(all_inside(in_quad, reference(right_angles, 360)));
    EXPECT_LT(radius_at_end(in_quad), 1e-28);
    EXPECT_TRUE(all_inside(enclosed<double>(uneven, 600), reference(uneven, 600)));
}

TEST(Enclosure, WiderScalarsLieInsideNarrowerOnes) {
    const auto in_double = enclosed<double>(uneven, 60);
    const auto in_quad = enclosed<Quad>(uneven, 60);
    const auto in_wide = enclosed<Wide>(uneven, 60);
    ASSERT_EQ(in_wide.size(), 61u);
    EXPECT_LT(radius_at_end(in_wide), 1e-72);
    for (std::size_t n = 0; n <= 60; ++n)
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_LE(abs(Wide(Wide(in_double[n][i].center) - in_wide[n][i].center)), Wide(in_double[n][i].radius));
            EXPECT_LE(abs(Wide(Wide(in_quad[n][i].center) - in_wide[n][i].center)), Wide(in_quad[n][i].radius));
        }
}

TEST(Enclosure, ContainsAThousandRandomStartsOfAnInterval) {
    constexpr double radius = 1e-4;
    constexpr long samples = 12;
    const auto sets = enclosed<double>(uneven, samples, radius);
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> within(-radius, radius);
    int outside = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        auto shift = trial < 16 ? corner(static_cast<unsigned>(trial), radius) : std::array<double, 4>{};
        if (trial >= 16) std::generate(shift.begin(), shift.end(), [&] { return within(random); });
        auto p = motion_of(uneven, shift);
        p.sample_interval = {samples, 120};
        const auto end = states_of(p, 1).back();
        for (std::size_t i = 0; i < 4; ++i)
            if (std::abs(static_cast<double>(Quad(Quad(sets.back()[i].center) - end[i]))) > sets.back()[i].radius)
                ++outside;
    }
    EXPECT_EQ(outside, 0);
}

TEST(Enclosure, ContainsClosedForms) {
    // without gravity and at the same angle and rate, both links turn as one rod
    const auto rod = system_of({"1", "2", "1", "0.5", "30", "30", "120", "120"}, "0");
    const auto turning = enclosed<Quad>(rod, 120);
    ASSERT_EQ(turning.size(), 121u);
    const Quad degree = pi_of<Quad>() / 180;
    for (const std::size_t n : {1UL, 60UL, 120UL}) {
        const Quad angle = (30 + Quad(n)) * degree;  // 120 °/s, 120 Hz
        for (const std::size_t i : {0u, 1u})
            EXPECT_LE(abs(Quad(turning[n][i].center - angle)), Quad(turning[n][i].radius) + Quad(1e-32));
    }
    // a normal mode of 1e-12 degrees: the terms of third order are below 1e-40
    const auto mode =
        system_of({"1", "1", "1", "1", "1e-12", "1.41421356237309504880168872420969808e-12", "0", "0"}, "9.8");
    const auto swinging = enclosed<Quad>(mode, 120);
    ASSERT_EQ(swinging.size(), 121u);
    const Quad rate = sqrt(Quad(parse_quad("9.8") * (2 - sqrt(Quad(2)))));
    for (const std::size_t n : {1u, 60u, 120u}) {
        const Quad angle = parse_quad("1e-12") * degree * cos(Quad(rate * Quad(n) / 120));
        EXPECT_LE(abs(Quad(swinging[n][0].center - angle)), Quad(swinging[n][0].radius) + Quad(1e-46));
        EXPECT_LT(swinging[n][0].radius, 1e-40);
    }
}

TEST(Enclosure, AnEquilibriumStaysWhereItIs) {
    auto hanging = right_angles;
    hanging.chain.angle = {0, 0};
    for (const auto& state : enclosed<double>(hanging, 120))
        for (const auto& x : state) EXPECT_LT(std::abs(x.center) + x.radius, 1e-200);
}

TEST(Enclosure, ReversedTimeReturnsToASetThatContainsTheStart) {
    auto system = uneven;
    const auto sets = enclosed<Quad>(system, 240);
    auto back = uneven;
    const auto there = start_of(back), start = start_of(system);
    for (std::size_t i = 0; i < 4; ++i) *there[i] = Ball<Wide>(i < 2 ? sets.back()[i] : -sets.back()[i]);
    const auto end = enclosed<Quad>(back, 240).back();
    for (std::size_t i = 0; i < 4; ++i) {
        const Wide sign = i < 2 ? 1 : -1;
        EXPECT_LE(abs(Wide(sign * Wide(end[i].center) - start[i]->center)), Wide(end[i].radius));
        EXPECT_LT(end[i].radius, 1e-26);
    }
}

TEST(Enclosure, TheWidthGrowsLikeTheTangents) {
    // the sum of the differences by each coordinate of the start, after 6 s
    constexpr double radius = 1e-12;
    constexpr long samples = 720;
    const auto sets = enclosed<Quad>(right_angles, samples, radius);
    ASSERT_EQ(sets.size(), 721u);
    const auto middle = reference(right_angles, samples).back();
    std::array<double, 4> sum{};
    for (std::size_t j = 0; j < 4; ++j) {
        std::array<double, 4> shift{};
        shift[j] = radius;
        const auto moved = reference(right_angles, samples, shift).back();
        for (std::size_t i = 0; i < 4; ++i) sum[i] += std::abs(static_cast<double>(Quad(moved[i] - middle[i])));
    }
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(sets.back()[i].radius / sum[i], 1, 1e-3);
}

TEST(Enclosure, FewEdgesContainTheMotionToo) {
    EnclosureSpec spec;
    spec.most_edges = 60;
    const auto few = enclosed<double>(right_angles, 1200, 0, spec);
    EXPECT_TRUE(all_inside(few, reference(right_angles, 1200)));
    EXPECT_LT(radius_at_end(few), 20 * radius_at_end(enclosed<double>(right_angles, 1200)));  // measured 8.7 times
}

TEST(Enclosure, EndsWhereTheProofEnds) {
    EnclosureSpec spec;
    spec.largest_radius = 1e-8;
    const auto sets = enclosed<double>(right_angles, 3600, 0, spec);
    EXPECT_GT(sets.size(), 1200u);
    EXPECT_LT(sets.size(), 2400u);
    for (const auto& state : sets)
        for (const auto& x : state) EXPECT_LE(x.radius, 1e-8);
    EnclosureSpec short_of_steps;
    short_of_steps.most_steps = 100;
    const auto beginning = enclosed<double>(right_angles, 3600, 0, short_of_steps);
    EXPECT_GT(beginning.size(), 100u);
    EXPECT_LT(beginning.size(), 500u);
    // a set too wide for any step
    EXPECT_LT(enclosed<double>(right_angles, 120, 0.4).size(), 60u);
    // so fast that no step is short enough; it can be stopped while it tries
    auto fast = right_angles;
    fast.chain.rate[0] = Ball<Wide>(Wide(1e10));
    int calls = 0;
    EXPECT_EQ(enclosures<Wide>(fast, {.samples = 9}, [&](long) { ++calls; }).size(), 1u);
    EXPECT_GT(calls, 3);
}

TEST(Enclosure, SamplesFarApartAndCloseTogetherAreTheSameMotion) {
    EnclosureSpec coarse, fine;
    coarse.interval = {1, 2};
    fine.interval = {1, 7001};
    const auto known = reference(uneven, 60).back();
    const auto one = enclosed<double>(uneven, 1, 0, coarse).back();
    const auto many = enclosed<double>(uneven, 7001 / 2, 0, fine);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_LE(std::abs(static_cast<double>(Quad(Quad(one[i].center) - known[i]))), one[i].radius);
        EXPECT_NEAR(many.back()[i].center, one[i].center, 3e-3);
    }
}

TEST(Enclosure, FollowsMotionMuchFasterThanItsPeriod) {
    auto fast = right_angles;
    fast.chain.rate[0] = Ball<Wide>(Wide(5000));  // 42 rad from sample to sample
    const auto sets = enclosed<double>(fast, 2);
    EXPECT_TRUE(all_inside(sets, reference(fast, 2)));
    EXPECT_LT(radius_at_end(sets), 1e-6);  // measured 2.1e-7
}

TEST(Enclosure, ADropletAttracts) {
    // near and heavy, against the same as a mechanism in quad
    auto p = uneven;
    p.droplets = {{{ball_of_decimal("2.5"), ball_of_decimal("0.5")}, 3, 1},
                  {{1609, 0}, ball_of_decimal("0.000034"), ball_of_decimal("6.674e-11")}};
    auto spec = motion_of(p);
    spec.model = Model::mechanism;
    spec.parts = parts_of(*spec.chain);
    spec.parts->forces.push_back(Droplet<Quad>{{parse_quad("2.5"), parse_quad("0.5")}, 3, 1});
    spec.parts->forces.push_back(Droplet<Quad>{{1609, 0}, parse_quad("0.000034"), parse_quad("6.674e-11")});
    const auto known = states_of(spec, 120);
    EXPECT_TRUE(all_inside(enclosed<double>(p, 120), known));
    EXPECT_FALSE(all_inside(enclosed<double>(uneven, 120), known));
    const auto quad = enclosed<Quad>(p, 120);
    EXPECT_LT(radius_at_end(quad), 1e-28);
    EXPECT_TRUE(all_inside(quad, known));
}

/// Whether all 16 corners of a start's box of that radius stay inside. The enclosure counts the part `start` of it.
bool corners_inside(const EnclosureCount& counted, double radius, double start = 1) {
    constexpr long samples = 60;
    EnclosureSpec spec;
    spec.counted = counted;
    const auto sets = enclosed<double>(uneven, samples, start * radius, spec);
    for (unsigned i = 0; i < 16; ++i)
        if (!all_inside(sets, reference(uneven, samples, corner(i, radius)))) return false;
    return true;
}

/// Whether the motion from doubles, which are no interval, stays inside. The enclosure takes `coefficient` times
/// gravity.
bool exact_start_inside(const EnclosureCount& counted, double tolerance, double coefficient = 1) {
    EnclosureSpec spec;
    spec.counted = counted;
    spec.tolerance = tolerance;
    auto system = uneven;
    for (auto* x : start_of(system)) *x = Ball<Wide>(Wide(static_cast<double>(x->center)));
    const auto known = reference(system, 240);
    system.chain.gravity *= Ball<Wide>(Wide(coefficient));
    return all_inside(enclosed<double>(system, 240, 0, spec), known);
}

TEST(Enclosure, EveryPartThatIsCountedIsNeeded) {
    constexpr double usual = 0.25, coarse = 1e6, wide = 1e-3;
    EXPECT_TRUE(exact_start_inside({}, usual));
    EXPECT_TRUE(exact_start_inside({}, coarse));
    EXPECT_TRUE(corners_inside({}, wide));
    EXPECT_FALSE(corners_inside({}, wide, 0));
    EXPECT_FALSE(exact_start_inside({.truncation = 0}, coarse));
    EXPECT_FALSE(exact_start_inside({.rounding = 0}, usual));
    EXPECT_FALSE(corners_inside({.nonlinearity = 0}, wide));
    EXPECT_FALSE(corners_inside({.earlier_boxes = 0}, wide));
    EXPECT_FALSE(exact_start_inside({}, usual, 1 + 1e-9));
}

}  // namespace doppel::enclosure_test
