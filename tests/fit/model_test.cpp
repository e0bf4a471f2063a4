#include "fit/support.hpp"

#include <gtest/gtest.h>

namespace doppel::model_test {

using namespace test;

const LinkState somewhere{0.7, -1.1, 2.3, -3.1};

/// The angles, rad, at the samples of a motion from `start`.
std::vector<std::array<double, 2>> angles_of(const Parameters& p, Drag drag, const LinkState& start, double step,
                                             std::size_t samples, double interval) {
    Flow<> flow({.drag = drag}, p, start, step);
    std::vector<std::array<double, 2>> angles;
    for (std::size_t i = 0; i < samples; ++i) {
        const double t = static_cast<double>(i) * interval;
        EXPECT_TRUE(flow.reach(t));
        angles.push_back({flow.angle(0, t)[0], flow.angle(1, t)[0]});
    }
    return angles;
}

double worst_of(const std::vector<std::array<double, 2>>& one, const std::vector<std::array<double, 2>>& other) {
    double worst = 0;
    for (std::size_t i = 0; i < one.size(); ++i)
        for (std::size_t arm = 0; arm < 2; ++arm) worst = std::max(worst, std::abs(one[i][arm] - other[i][arm]));
    return worst;
}

/// Points, bodies, drag of either law; and joints that change direction, stick and slip, with strong Coulomb friction
/// until the pendulum rests.
TEST(FitFlow, AgreesWithThePhysicsModule) {
    auto dry = lab_arms();
    dry[coulomb_1] = 4, dry[coulomb_2] = 3;
    const auto points = ratios_of(point_masses(1.3, 0.7, 0.4, 0.6));
    for (const auto& [p, drag] : {std::pair(points, Drag::own), std::pair(lab_arms(), Drag::own),
                                  std::pair(lab_arms(), Drag::carried), std::pair(dry, Drag::own)}) {
        const auto body = pendulum_of(fitted_pendulum(p, {.drag = drag}, {}));
        for (const auto& start : {LinkState(1.5, -0.8, 1, -2), somewhere})
            EXPECT_LT(worst_of(angles_of(p, drag, start, 1.0 / 512, 251, 0.02), simulated_angles(body, start, 50, 251)),
                      1e-8);  // measured 1.3e-9
    }
    Flow<> flow({}, dry, {1.5, -0.8, 1, -2}, 1.0 / 512);
    EXPECT_TRUE(flow.reach(5));
    EXPECT_EQ(flow.rate(0, 5), 0);  // it has come to rest
    EXPECT_EQ(flow.rate(1, 5), 0);
}

TEST(FitFlow, IsOfOrderFive) {
    const auto end = [&](double step) { return angles_of(lab_arms(false), Drag::own, somewhere, step, 2, 1)[1][1]; };
    const double truth = end(1.0 / 8192), coarse = end(1.0 / 256) - truth, fine = end(1.0 / 512) - truth;
    EXPECT_NEAR(std::log2(std::abs(coarse / fine)), 5, 0.4);  // measured 5.0
}

TEST(FitFlow, InterpolatesAsWellAsItSteps) {
    const auto at = [](double step) { return angles_of(lab_arms(false), Drag::own, somewhere, step, 200, 0.00137); };
    EXPECT_LT(worst_of(at(1.0 / 128), at(1.0 / 4096)), 2e-6);  // measured 3e-7
}

void expect_there_and_back(const Parameters& p, const PhysicalPendulum<double>& pendulum) {
    for (const auto& parts : {pendulum.chain.mass, pendulum.inertia}) EXPECT_GT(parts[0], 0);
    const auto back = ratios_of(pendulum);
    for (std::size_t k = 0; k < dynamic_count; ++k) EXPECT_NEAR(back[k], p[k], 1e-12 * std::abs(p[k]));
}

TEST(FitPhysical, RatiosRoundTrip) {
    for (const double mass : {1.0, 0.138})
        for (const double gravity : {9.8, 1.62}) {
            const auto pendulum = pendulum_of(fitted_pendulum(lab_arms(), {}, {gravity, mass}));
            expect_there_and_back(lab_arms(), pendulum);
            EXPECT_EQ(pendulum.chain.mass[1], mass);
            EXPECT_NEAR(pendulum.chain.length[0], gravity * 0.88 / 50, 1e-15);  // g C/D2
            EXPECT_NEAR(pendulum.inertia[1], mass * std::pow(pendulum.center[1], 2) / 3, 1e-15);
        }
    // if most of the first link's inertia comes from the second link's mass, the second link is more compact
    auto p = lab_arms(false);
    p[inertia] = 1.2 * 0.88 * 0.88;
    expect_there_and_back(p, pendulum_of(fitted_pendulum(p, {}, {})));
}

TEST(FitPhysical, PointMassesStayPoints) {
    const auto points = point_masses(1.3, 1, 0.4, 0.6);
    const auto back = pendulum_of(fitted_pendulum(ratios_of(points), {.point_masses = true}, {}));
    for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_NEAR(back.chain.mass[k], points.chain.mass[k], 1e-12);
        EXPECT_NEAR(back.chain.length[k], points.chain.length[k], 1e-12);
        EXPECT_EQ(back.inertia[k], 0);
    }
}

}  // namespace doppel::model_test
