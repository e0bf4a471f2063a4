#include "analysis/reference.hpp"
#include "base/error.hpp"
#include "integrate/pendulums.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel {
namespace reference_trajectory_test {

const std::atomic<bool> never = false;
constexpr double enough = 0.5;

MotionSpec in_double(const std::vector<double>& angle_deg) {
    MotionSpec spec;
    spec.chain = from_rest(angle_deg).cast<Quad>();
    spec.method = "taylor";
    spec.tolerance = parse_quad("1e-10");
    spec.sample_interval = {1, 10};
    return spec;
}

TEST(ReferenceTrajectory, OfAMotionInDoubleIsInQuadWhereThatCostsLittle) {
    const auto spec = in_double({90, 90});
    const auto wide = reference_trajectory(spec, 50, 2, enough, never);
    EXPECT_TRUE(wide.is_wider);
    ASSERT_EQ(wide.seen.size(), 51u);
    EXPECT_LT(wide.uncertainty.back(), 2e-14);  // the error of numbers rounded once
    EXPECT_GT(wide.uncertainty.back(), 1e-16);
    // compared with quad at another tolerance
    auto finer = spec;
    finer.precision = Precision::in_quad;
    finer.tolerance = parse_quad("1e-28");
    const auto motion = make_motion(finer);
    for (std::size_t sample = 1; sample <= 50; ++sample) {
        motion->advance(never);
        EXPECT_LT(wide.error_at(sample, motion->observe()), 1e-20);  // measured 3.4e-21
    }
    EXPECT_FALSE(reference_trajectory(spec, 50, 2, enough, never, 0).is_wider);
}

TEST(ReferenceTrajectory, EstimatesItsErrorInItsOwnPrecision) {
    struct Released {
        std::vector<double> degrees, mass;
    };
    for (const auto& [degrees, mass] : {Released{{90, 90}, {1, 1}},
                                        {{150, 90}, {1, 1}},
                                        {{30, 0}, {1, 1}},
                                        {{120, 0, 0}, {1, 1, 1}},
                                        {{170}, {1}},
                                        {{100, -40}, {0.001, 1}},
                                        {{60, 100, -20}, {1, 0.0001, 1}}}) {
        auto spec = in_double(degrees);
        spec.chain->mass.assign(mass.begin(), mass.end());
        const auto own = reference_trajectory(spec, 150, 3, enough, never, 0),
                   wide = reference_trajectory(spec, 150, 3, enough, never);
        EXPECT_TRUE(wide.is_wider && !own.is_wider);
        for (std::size_t sample = 10; sample < own.seen.size(); ++sample) {
            double off = 0;
            for (std::size_t i = 0; i < own.seen[sample].size(); ++i)
                off = std::max(off, std::abs(static_cast<double>(Quad(own.seen[sample][i] - wide.seen[sample][i]))));
            EXPECT_LE(off, own.uncertainty[sample]) << degrees[0] << ' ' << sample;  // measured 0.62 of it at most
        }
    }
}

TEST(ReferenceTrajectory, EndsShortlyAfterThePredictabilityLimit) {
    const auto wide = reference_trajectory(in_double({150, 90}), 1000, 2, enough, never);
    EXPECT_LT(wide.seen.size(), 600u);
    const auto history = error_history(in_double({150, 90}), wide, enough, never);
    EXPECT_LT(history.error.size(), wide.seen.size());
    EXPECT_GT(history.error.back(), enough);
    EXPECT_EQ(history.last_within(enough), static_cast<long>(history.error.size()) - 2);
    EXPECT_EQ(history.last_within(-1), -1);
    EXPECT_TRUE(std::isinf(history.at(history.error.size())));
    EXPECT_TRUE(history.failure.empty());
}

TEST(ErrorHistory, GivesTheReasonOfAFailure) {
    const auto reference = reference_trajectory(in_double({150, 90}), 20, 2, enough, never);
    auto spec = in_double({150, 90});
    spec.method = "gauss4";
    spec.steps_per_sample = 1;
    spec.sample_interval = {1, 10};
    spec.chain->rate = {Quad(60), Quad(-80)};  // too fast for steps of 0.1 s
    const auto history = error_history(spec, reference, 1e9, never);
    EXPECT_LT(history.error.size(), 3u);
    EXPECT_NE(history.failure.find("the stages still change"), std::string::npos) << history.failure;
}

TEST(ReferenceTrajectory, StopsWhenAsked) {
    const std::atomic<bool> stop = true;
    EXPECT_THROW(reference_trajectory(in_double({90, 90}), 10, 2, enough, stop), Error);
}

}  // namespace reference_trajectory_test
}  // namespace doppel
