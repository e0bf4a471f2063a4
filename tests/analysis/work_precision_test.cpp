#include "analysis/work_precision.hpp"

#include <gtest/gtest.h>

#include <array>

namespace doppel {
namespace work_precision_test {

/// A ladder of rungs of these costs, each with a tenth of the error before, from 0.1 on.
Ladder ladder(std::size_t problem, const std::string& method, Model model, const std::vector<double>& costs,
              const ExternalMethod* external = nullptr) {
    Ladder made{problem, {model, method, external}, {}, {}};
    double error = 1;
    for (const double cost : costs) {
        error /= 10;
        made.rungs.push_back({.setting = error, .error = error, .cpu_s = cost, .evaluations = 1 / cost});
        made.spread.push_back(0);
    }
    return made;
}

const ExternalMethod one{"one", true, 0, 1, {}}, two{"two", true, 0, 1, {}};

/// Two problems. At 0.1 "slow" is the last, at 0.001 nobody else comes so far on the second.
const std::vector<Ladder> ladders{ladder(0, "slow", Model::angles, {7, 8, 9, 10}),
                                  ladder(0, "fast", Model::angles, {9, 9, 9, 9}),
                                  ladder(0, "fast", Model::constraints, {1, 2, 4, 8}),
                                  ladder(0, "even", Model::angles, {2, 3, 4.5, 9}),
                                  ladder(1, "slow", Model::angles, {7, 8, 9, 10}),
                                  ladder(1, "fast", Model::angles, {1, 2}),
                                  ladder(1, "even", Model::angles, {2, 3}),
                                  ladder(0, "", Model::angles, {1, 1, 1, 1}, &two),
                                  ladder(0, "", Model::angles, {0.5, 0.5, 0.5, 0.5}, &one)};

/// The first repeat alone looks for break-downs on the way.
TEST(Merged, LeavesOutTheTimesOfFailedRuns) {
    const Rung good{.setting = 0.1, .error = 0.01, .cpu_s = 3}, bad{.setting = 0.2, .error = NAN, .cpu_s = NAN},
        unseen{.setting = 0.2, .error = 0, .cpu_s = 1};
    const auto ladder = merged(0, {Model::angles, "slow"}, {{bad, good}, {unseen, good}});
    EXPECT_TRUE(ladder.rungs[0].failed());
    EXPECT_TRUE(std::isnan(ladder.rungs[0].cpu_s));
    EXPECT_FALSE(ladder.rungs[1].failed());
    EXPECT_EQ(ladder.rungs[1].cpu_s, 3);
}

TEST(Ranked, IsByTheSumOfTheRanks) {
    using Names = std::vector<std::string>;
    // at 0.1: fast, even, slow on both
    EXPECT_EQ(ranked(ladders, Cost::time, std::array{0.11}, false), (Names{"fast", "even", "slow"}));
    // at 0.001 fast and even share the last rank of the second problem: ranks 0 + 1, 1 + 1, 2 + 0
    EXPECT_EQ(ranked(ladders, Cost::time, std::array{0.0011}, false), (Names{"fast", "slow", "even"}));
    // the least cost counts, in whatever model, and whatever costs are
    EXPECT_EQ(ranked(ladders, Cost::evaluations, std::array{0.11}, false), (Names{"slow", "even", "fast"}));
    EXPECT_EQ(ranked(ladders, Cost::time, std::array{0.11}, true), (Names{"peer:one", "peer:two"}));
    EXPECT_TRUE(ranked({}, Cost::time, std::array{0.1}, false).empty());
}

}  // namespace work_precision_test
}  // namespace doppel
