#include "analysis/breakdown.hpp"
#include "analysis/difference.hpp"
#include "integrate/support.hpp"
#include "numeric/state.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace doppel {
namespace check_values_test {

// Values of the study's own procedure: explicit Euler, 30 kHz, a sample each 250 steps, twins 0.003° apart (Kao 2022,
// re-run independently). They hold to the digits given where the motion is regular.
MotionSpec studied(Model model, const Pendulum<double>& p) {
    auto spec = stepping(model, "euler", p, 120);
    spec.steps_per_sample = 250;
    return spec;
}

Pendulum<double> triple(double theta1_deg) {
    return {{1, 1, 1}, {1, 1, 1}, {radians(theta1_deg), 0, 0}, {0, 0, 0}, 9.8};
}

/// The distances of a pair at samples 0 … count.
std::vector<double> distances(Model model_a, const Pendulum<double>& a, Model model_b, const Pendulum<double>& b,
                              int count) {
    Course one(studied(model_a, a)), two(studied(model_b, b));
    std::vector<double> all{state_space_distance(one.observe().bobs, two.observe().bobs)};
    for (int n = 1; n <= count; ++n) all.push_back(state_space_distance(one.advance(1).bobs, two.advance(1).bobs));
    return all;
}

/// Mean of ln(d/d0) over samples 1 … 3000 (25 s).
double average_log_ratio(Model model, const Pendulum<double>& a, const Pendulum<double>& b) {
    const auto d = distances(model, a, model, b, 3000);
    double sum = 0;
    for (std::size_t n = 1; n < d.size(); ++n) sum += log_ratio(d[n], d[0]).value();
    return sum / static_cast<double>(d.size() - 1);
}

TEST(CheckValues, AverageOverTheAngle) {
    for (const auto& [angle, expected] :
         {std::pair{0.0, 0.7923}, {10.0, 1.2624}, {20.0, 2.2050}, {30.0, 2.7880}, {40.0, 2.9647}})
        EXPECT_NEAR(average_log_ratio(Model::angles, released(angle, 0), released(angle + 0.003, 0)), expected, 6e-5)
            << angle;
    for (const auto& [angle, expected] : {std::pair{10.0, 1.2635}, {20.0, 2.2062}, {30.0, 2.7888}})
        EXPECT_NEAR(average_log_ratio(Model::constraints, released(angle, 0), released(angle + 0.003, 0)), expected,
                    6e-5)
            << angle;
}

TEST(CheckValues, AverageOverTheMassRatio) {
    for (const auto& [angle, expected] : {std::pair{4.0, 1.0294}, {20.0, 2.4862}, {32.0, 2.8891}}) {
        auto heavier = released(angle, 0);
        heavier.mass = {1.01, 1};
        EXPECT_NEAR(average_log_ratio(Model::angles, released(angle, 0), heavier), expected, 6e-5) << angle;
    }
}

TEST(CheckValues, AverageOverTheAngleOfTheTriple) {
    for (const auto& [angle, expected] : {std::pair{0.0, 0.8160}, {8.0, 1.3063}, {20.0, 2.6548}, {32.0, 3.0262}})
        EXPECT_NEAR(average_log_ratio(Model::constraints, triple(angle), triple(angle + 0.003)), expected, 6e-5)
            << angle;
}

TEST(CheckValues, LogRatioOverTime) {
    // figure 2 left; its list begins with sample 1, so that entry n, counted from 0, is sample n + 1
    const auto d = distances(Model::angles, released(90, 90), Model::angles, released(90.003, 90), 1001);
    for (const auto& [entry, expected, slack] :
         {std::tuple{100u, 0.941, 6e-4}, {500u, 1.884, 2e-3}, {1000u, 3.38, 6e-3}})
        EXPECT_NEAR(log_ratio(d[entry + 1], d[0]).value(), expected, slack) << entry;  // measured 0.941, 1.885, 3.384
}

TEST(CheckValues, TheTwoFormulationsPart) {
    for (const auto& [angle, greatest, at] : {std::tuple{45.0, 0.633, 4370L}, {50.0, 1.044, 4350L}}) {
        const auto d = distances(Model::angles, released(angle, 0), Model::constraints, released(angle, 0), 4500);
        const auto most = std::max_element(d.begin(), d.end());
        EXPECT_NEAR(*most, greatest, 6e-4) << angle;
        EXPECT_NEAR(static_cast<double>(most - d.begin()), static_cast<double>(at), 5) << angle;
    }
}

TEST(Distance, CountsMassesPlacesAndVelocities) {
    Bobs<double> a(2), b(2);
    EXPECT_EQ(state_space_distance(a, b), 0);
    b[0].mass = 2;
    b[1].x = 3;
    b[0].vy = 6;
    EXPECT_DOUBLE_EQ(state_space_distance(a, b), 7);
    b[0].theta = b[1].omega = 100;  // not part of it: x, y and their rates say the same
    EXPECT_DOUBLE_EQ(state_space_distance(a, b), 7);
}

TEST(Distance, LogRatioIsEmptyWhereThereIsNone) {
    EXPECT_FALSE(log_ratio(1, 0));
    EXPECT_FALSE(log_ratio(0, 1));
    EXPECT_DOUBLE_EQ(log_ratio(std::exp(2.0), 1).value(), 2);
}

TEST(Proportion, IsOfTheRangeWhereTheStartHasNoEnergy) {
    const auto scale = [](const Pendulum<double>& p) {
        return Proportion(Course(studied(Model::angles, p)).observe(), p.potential_range(), p.reach()).energy;
    };
    EXPECT_DOUBLE_EQ(scale(released(90, 90)), 2 * 9.8 * (1 * 1 + 1 * 2));                 // cos 90° is 6e-17, not 0
    EXPECT_NEAR(scale(released(90.003, 90)), 2 * 9.8 * std::sin(radians(0.003)), 7e-16);  // measured 1.2e-16
    EXPECT_DOUBLE_EQ(scale(released(0, 0)), 29.4);
}

}  // namespace check_values_test
}  // namespace doppel
