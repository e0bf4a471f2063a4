#include "analysis/twins.hpp"

#include "analysis/difference.hpp"
#include "base/error.hpp"
#include "integrate/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <thread>

namespace doppel {
namespace twins_test {

constexpr long samples = 40;

TwinRun both(Model model, const std::string& method = "euler") {
    const TwinSide side{model, method, 250};
    return {.a = side, .b = side, .samples = samples};
}

std::vector<double> averages_of(const std::vector<Twins>& twins, const TwinRun& run) {
    std::vector<double> averages(twins.size(), -1);
    const std::atomic<bool> never = false;
    average_log_ratios(twins, run, averages, never);
    return averages;
}

Course course_of(const Pendulum<double>& p, const TwinSide& side) {
    auto spec = stepping(side.model == Model::angles ? Model::angles : Model::constraints, side.method, p, 120);
    spec.steps_per_sample = side.steps_per_sample;
    return Course(spec);
}

/// The same mean from two motions of the films, each stepped alone.
double average_of_films(const Twins& twins, const TwinRun& run) {
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

/// Twins apart in an angle, in a mass, in everything; as many as fill no register evenly.
std::vector<Twins> some_twins(std::size_t count = 13) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> some(0.5, 2), angle(-3, 3);
    std::vector<Twins> all;
    for (std::size_t i = 0; i < count; ++i) {
        Pendulum<double> p;
        p.mass = {some(random), some(random)};
        p.length = {some(random), some(random)};
        p.angle = {angle(random), angle(random)};
        p.rate = {angle(random), angle(random)};
        p.gravity = 5 * some(random);
        Twins twins{p, p};
        if (i % 3 != 1) twins.b.angle[0] += 1e-4;
        if (i % 3 != 0) twins.b.mass[0] *= 1.01;
        all.push_back(twins);
    }
    return all;
}

void expect_as_films(const TwinRun& run) {
    const auto twins = some_twins();
    const auto averages = averages_of(twins, run);
    for (std::size_t i = 0; i < twins.size(); ++i)
        EXPECT_EQ(averages[i], average_of_films(twins[i], run)) << run.a.method << ", twins " << i;
}

TEST(Twins, AverageAsTheFilmsToTheLastBit) {
    for (const auto model : {Model::angles, Model::constraints})
        for (const char* method : {"euler", "rk4"}) expect_as_films(both(model, method));
}

TEST(Twins, MayDifferInTheirEquationsMethodsAndSteps) {
    auto run = both(Model::angles);
    run.b = {Model::constraints, "euler", 250};
    expect_as_films(run);
    run.b = {Model::angles, "rk4", 20};
    expect_as_films(run);

    // one pendulum in two formulations starts as one: there is no ratio
    const Twins one{released(50, 0), released(50, 0)};
    run.b = {Model::constraints, "euler", 250};
    const auto start =
        state_space_distance(course_of(one.a, run.a).observe().bobs, course_of(one.b, run.b).observe().bobs);
    const double average = averages_of({one}, run).front();
    if (start == 0)
        EXPECT_TRUE(std::isnan(average)) << average;
    else
        EXPECT_EQ(average, average_of_films(one, run));
}

TEST(Twins, HaveTheSameBitsInAnyCompanyAndOrder) {
    for (const auto model : {Model::angles, Model::constraints}) {
        const auto run = both(model);
        auto twins = some_twins();
        const auto expected = averages_of(twins, run);
        std::reverse(twins.begin(), twins.end());
        auto backwards = averages_of(twins, run);
        std::reverse(backwards.begin(), backwards.end());
        EXPECT_EQ(backwards, expected);
        std::reverse(twins.begin(), twins.end());

        for (const std::size_t together : {1u, 2u, 5u}) {
            std::vector<double> pieces;
            for (std::size_t first = 0; first < twins.size(); first += together) {
                const auto last = std::min(first + together, twins.size());
                for (const double average : averages_of(
                         {twins.begin() + static_cast<long>(first), twins.begin() + static_cast<long>(last)}, run))
                    pieces.push_back(average);
            }
            EXPECT_EQ(pieces, expected) << together << " at once";
        }
    }
}

TEST(Twins, ShareThePendulumsTheyHaveInCommon) {
    const auto run = both(Model::angles);
    std::vector<Twins> chain;  // each one's twin is the next one's sibling
    for (int i = 0; i < 9; ++i) chain.push_back({released(10 * i, 0), released(10 * (i + 1), 0)});
    chain.push_back(chain[4]);
    chain.push_back({chain[2].b, chain[2].a});
    const auto averages = averages_of(chain, run);
    for (std::size_t i = 0; i < chain.size(); ++i) EXPECT_EQ(averages[i], average_of_films(chain[i], run)) << i;
    EXPECT_EQ(averages[9], averages[4]);
    EXPECT_EQ(averages[10], averages[2]);
}

TEST(Twins, ApartInGravityAloneAreTwo) {
    Twins twins{released(90, 90), released(90, 90)};
    twins.b.gravity = 9.9;
    twins.b.angle[0] += 1e-6;  // a start apart, to measure by
    Twins heavier = twins;
    heavier.a.gravity = 9.9;
    const auto run = both(Model::angles);
    const auto averages = averages_of({twins, heavier}, run);
    EXPECT_EQ(averages[0], average_of_films(twins, run));
    EXPECT_EQ(averages[1], average_of_films(heavier, run));
    EXPECT_GT(averages[0], averages[1] + 1);  // measured 9.5 and 0.56
}

TEST(Twins, ThatAreOneHaveNoAverage) {
    const auto run = both(Model::constraints);
    const Twins one{released(90, 90), released(90, 90)}, two{released(90, 90), released(91, 90)};
    const auto averages = averages_of({one, two, one}, run);
    EXPECT_TRUE(std::isnan(averages[0]));
    EXPECT_EQ(averages[1], average_of_films(two, run));
    EXPECT_TRUE(std::isnan(averages[2]));
}

TEST(Twins, ThatBreakDownHaveNoAverageAndSpoilNoOther) {
    // steps that tear the wild ones apart and suit the calm ones, which swing once in an hour
    auto calm = released(20, -10);
    calm.gravity = 1e-6;
    const Twins wild{released(170, 10), released(171, 10)};
    Twins one{calm, calm}, other{calm, calm};
    one.b.angle[0] += 1e-4;
    other.b.mass[0] *= 1.01;
    for (const auto model : {Model::angles, Model::constraints}) {
        auto run = both(model);
        run.a.steps_per_sample = run.b.steps_per_sample = 1;
        run.sample_interval = 0.5;  // as the step
        run.samples = 3000;
        const auto averages = averages_of({one, wild, other, wild}, run);
        EXPECT_TRUE(std::isnan(averages[1])) << averages[1];
        EXPECT_TRUE(std::isnan(averages[3])) << averages[3];
        EXPECT_TRUE(std::isfinite(averages[0]) && std::isfinite(averages[2])) << averages[0] << ' ' << averages[2];
        EXPECT_EQ(averages[0], averages_of({one}, run)[0]);
        EXPECT_EQ(averages[2], averages_of({other}, run)[0]);
    }
}

TEST(Twins, StopSoon) {
    auto run = both(Model::angles);
    run.samples = 10'000'000;
    std::vector<double> averages(1);
    std::atomic<bool> stop = false;
    const std::jthread later([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        stop = true;
    });
    const auto start = std::chrono::steady_clock::now();
    try {
        average_log_ratios(std::vector<Twins>{{released(90, 0), released(91, 0)}}, run, averages, stop);
        FAIL() << "it went on";
    } catch (const Error& fault) {
        EXPECT_EQ(fault.code(), ExitCode::interrupted);
    }
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));  // measured 0.05 s
}

}  // namespace twins_test
}  // namespace doppel
