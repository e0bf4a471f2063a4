#include "analysis/work_precision.hpp"

#include <gtest/gtest.h>

#include <array>

namespace doppel::work_precision_test {

/// A step-size study with these costs, each with a tenth of the previous error, from 0.1 on.
StepStudy study(const std::string& method, Model model, const std::vector<double>& costs) {
    StepStudy made{{model, method}, {}};
    double error = 1;
    for (const double cost : costs) {
        error /= 10;
        made.outcomes.push_back({.setting = error, .error = error, .cpu_s = cost, .evaluations = 1 / cost});
    }
    return made;
}

/// Two problems. At 0.1 "slow" ranks last; at 0.001 only "slow" reaches the accuracy on the second.
const std::vector<std::vector<StepStudy>> problems{
    {study("slow", Model::angles, {7, 8, 9, 10}), study("fast", Model::angles, {9, 9, 9, 9}),
     study("fast", Model::constraints, {1, 2, 4, 8}), study("even", Model::angles, {2, 3, 4.5, 9})},
    {study("slow", Model::angles, {7, 8, 9, 10}), study("fast", Model::angles, {1, 2}),
     study("even", Model::angles, {2, 3})}};

/// Only the first repeat detects failures during the run.
TEST(Merged, LeavesOutTheTimesOfFailedRuns) {
    const StepResult good{.setting = 0.1, .error = 0.01, .cpu_s = 3}, bad{.setting = 0.2},
        unseen{.setting = 0.2, .error = 0, .cpu_s = 1};
    const auto study = merged({Model::angles, "slow"}, {{bad, good}, {unseen, good}});
    EXPECT_TRUE(study.outcomes[0].failed());
    EXPECT_TRUE(std::isnan(study.outcomes[0].cpu_s));
    EXPECT_FALSE(study.outcomes[1].failed());
    EXPECT_EQ(study.outcomes[1].cpu_s, 3);
}

TEST(BestModels, WinAtMostPowersOfTen) {
    const auto best = best_models(problems[0], Cost::time);
    ASSERT_EQ(best.size(), 3u);  // in the given order
    EXPECT_EQ(best[1], &problems[0][2]);
    EXPECT_EQ(best_models(problems[0], Cost::evaluations)[1], &problems[0][1]);
}

TEST(Ranked, IsByTheSumOfTheRanks) {
    using Names = std::vector<std::string>;
    // at 0.1: fast, even, slow on both problems
    EXPECT_EQ(ranked(problems, Cost::time, std::array{0.11}), (Names{"fast", "even", "slow"}));
    // at 0.001, fast and even share the last rank on the second problem: ranks 0 + 1, 1 + 1, 2 + 0
    EXPECT_EQ(ranked(problems, Cost::time, std::array{0.0011}), (Names{"fast", "slow", "even"}));
    // the lowest cost counts, for any model and any kind of cost
    EXPECT_EQ(ranked(problems, Cost::evaluations, std::array{0.11}), (Names{"slow", "even", "fast"}));
    const std::vector<std::vector<StepStudy>> on_one{
        {study("two", Model::angles, {1, 1, 1, 1}), study("one", Model::angles, {0.5, 0.5, 0.5, 0.5})}, {}};
    EXPECT_EQ(ranked(on_one, Cost::time, std::array{0.11}), (Names{"one", "two"}));
    EXPECT_TRUE(ranked({}, Cost::time, std::array{0.1}).empty());
}

}  // namespace doppel::work_precision_test
