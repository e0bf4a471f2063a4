#include "analysis/pair_batch.hpp"

#include "analysis/difference.hpp"
#include "analysis/watched_motion.hpp"
#include "base/error.hpp"
#include "integrate/support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace doppel::twins_test {

TEST(Distance, CountsMassesPlacesAndVelocities) {
    Bobs<double> a(2), b(2);
    EXPECT_EQ(state_space_distance(a, b), 0);
    b[0].mass = 2;
    b[1].x = 3;
    b[0].vy = 6;
    EXPECT_DOUBLE_EQ(state_space_distance(a, b), 7);
    b[0].theta = b[1].omega = 100;  // not part of the distance: x, y and their rates contain the same information
    EXPECT_DOUBLE_EQ(state_space_distance(a, b), 7);
}

TEST(Distance, LogRatioIsEmptyWhereThereIsNone) {
    EXPECT_FALSE(log_ratio(1, 0));
    EXPECT_FALSE(log_ratio(0, 1));
    EXPECT_DOUBLE_EQ(log_ratio(std::exp(2.0), 1).value(), 2);
}

TEST(ErrorScale, IsOfTheRangeWhereTheStartHasNoEnergy) {
    const auto scale = [](const Pendulum<double>& p) {
        return ErrorScale(Course(stepping(Model::angles, "euler", p, 120)).observe(), p.potential_range(), p.reach())
            .energy;
    };
    EXPECT_DOUBLE_EQ(scale(released(90, 90)), 2 * 9.8 * (1 * 1 + 1 * 2));                 // cos 90° is 6e-17, not 0
    EXPECT_NEAR(scale(released(90.003, 90)), 2 * 9.8 * std::sin(radians(0.003)), 7e-16);  // measured 1.2e-16
    EXPECT_DOUBLE_EQ(scale(released(0, 0)), 29.4);
}

constexpr long samples = 40;

PairBatchSpec both(Model model, const std::string& method = "euler") {
    const MotionSpec side{.model = model, .method = method};
    return {.a = side, .b = side, .samples = samples};
}

std::vector<double> averages_of(const std::vector<PendulumPair>& twins, const PairBatchSpec& run,
                                const std::atomic<bool>& stop = false) {
    std::vector<AverageLogRatio> means(twins.size());
    const auto watch = [&](std::size_t i, long, const Bobs<double>& a, const Bobs<double>& b) {
        means[i].add(state_space_distance(a, b));
    };
    step_pairs(twins, run, watch, stop);
    std::vector<double> averages;
    for (const auto& mean : means) averages.push_back(mean.value());
    return averages;
}

Course course_of(const Pendulum<double>& p, MotionSpec side) {
    side.chain = p.cast<Quad>();
    return Course(side);
}

/// The same mean from two motions, each computed alone as for a film.
double average_of_films(const PendulumPair& twins, const PairBatchSpec& run) {
    auto a = course_of(twins.a, run.a), b = course_of(twins.b, run.b);
    const double start = state_space_distance(a.observe().bobs, b.observe().bobs);
    double sum = 0;
    long counted = 0;
    for (long n = 1; n <= run.samples; ++n)
        if (const auto ratio = log_ratio(state_space_distance(a.advance(1).bobs, b.advance(1).bobs), start)) {
            sum += *ratio;
            ++counted;
        }
    return sum / static_cast<double>(counted);
}

/// Pairs that differ in an angle, in a mass, or in everything; their number is not a multiple of any register width.
std::vector<PendulumPair> some_twins(std::size_t count = 13) {
    std::mt19937 random(3);
    std::vector<PendulumPair> all;
    for (std::size_t i = 0; i < count; ++i) {
        const auto p = random_pendulum(random);
        PendulumPair twins{p, p};
        if (i % 3 != 1) twins.b.angle[0] += 1e-4;
        if (i % 3 != 0) twins.b.mass[0] *= 1.01;
        all.push_back(twins);
    }
    return all;
}

void expect_as_films(const PairBatchSpec& run) {
    const auto twins = some_twins();
    const auto averages = averages_of(twins, run);
    for (std::size_t i = 0; i < twins.size(); ++i)
        EXPECT_EQ(averages[i], average_of_films(twins[i], run)) << run.a.method << ", twins " << i;
}

TEST(PendulumPair, AverageAsTheFilmsToTheLastBit) {
    for (const auto model : {Model::angles, Model::constraints})
        for (const char* method : {"euler", "rk4"}) expect_as_films(both(model, method));
}

TEST(PendulumPair, MayDifferInTheirEquationsMethodsAndSteps) {
    auto run = both(Model::angles);
    run.b.model = Model::constraints;
    expect_as_films(run);
    run.b = {.model = Model::angles, .method = "rk4", .steps_per_sample = 20};
    expect_as_films(run);
}

TEST(PendulumPair, ShareThePendulumsTheyHaveInCommon) {
    const auto run = both(Model::angles);
    std::vector<PendulumPair> chain;  // the second pendulum of each pair is the first one of the next pair
    for (int i = 0; i < 9; ++i) chain.push_back({released(10 * i, 0), released(10 * (i + 1), 0)});
    chain.push_back(chain[4]);
    chain.push_back({chain[2].b, chain[2].a});
    chain.push_back(chain[4]);
    chain.back().b.gravity = 9.9;  // differs in gravity only
    const auto averages = averages_of(chain, run);
    for (std::size_t i = 0; i < chain.size(); ++i) EXPECT_EQ(averages[i], average_of_films(chain[i], run)) << i;
    EXPECT_EQ(averages[9], averages[4]);
    EXPECT_EQ(averages[10], averages[2]);
    EXPECT_GT(std::abs(averages[11] - averages[4]), 1e-3);
}

TEST(PendulumPair, OfEqualPendulumsHasNoAverage) {
    const auto run = both(Model::constraints);
    const PendulumPair one{released(90, 90), released(90, 90)}, two{released(90, 90), released(91, 90)};
    const auto averages = averages_of({one, two, one}, run);
    EXPECT_TRUE(std::isnan(averages[0]));
    EXPECT_EQ(averages[1], average_of_films(two, run));
    EXPECT_TRUE(std::isnan(averages[2]));
}

TEST(PendulumPair, ThatFailsHasNoAverageAndDoesNotAffectOthers) {
    // steps too long for the fast pairs but not for the slow ones, whose period is about an hour
    auto calm = released(20, -10);
    calm.gravity = 1e-6;
    const PendulumPair wild{released(170, 10), released(171, 10)};
    PendulumPair one{calm, calm}, other{calm, calm};
    one.b.angle[0] += 1e-4;
    other.b.mass[0] *= 1.01;
    for (const auto model : {Model::angles, Model::constraints}) {
        auto run = both(model);
        run.a.steps_per_sample = run.b.steps_per_sample = 1;
        run.a.sample_interval = run.b.sample_interval = {1, 2};  // equal to the step
        run.samples = 3000;
        const auto averages = averages_of({one, wild, other, wild}, run);
        EXPECT_TRUE(std::isnan(averages[1])) << averages[1];
        EXPECT_TRUE(std::isnan(averages[3])) << averages[3];
        EXPECT_TRUE(std::isfinite(averages[0]) && std::isfinite(averages[2])) << averages[0] << ' ' << averages[2];
        EXPECT_EQ(averages[0], averages_of({one}, run)[0]);
        EXPECT_EQ(averages[2], averages_of({other}, run)[0]);
    }
}

TEST(PendulumPair, StopWhenAsked) {
    EXPECT_THROW(averages_of({{released(90, 0), released(91, 0)}}, both(Model::angles), true), Error);
}

}  // namespace doppel::twins_test
