#include "analysis/stability.hpp"
#include "integrate/widths.hpp"
#include "physics/bob.hpp"

#include <gtest/gtest.h>

namespace doppel {
namespace energy_stability_test {

TEST(EnergyStability, IsTheSameAtEveryWidthAndAlone) {
    std::vector<Pendulum<Quad>> releases;
    for (int i = 1; i <= 11; ++i) releases.push_back({.angle = {Quad(i) / 4, 0}});
    const std::atomic<bool> never = false;
    for (const auto model : {Model::angles, Model::constraints})
        for (const char* method : {"euler", "rk4"})
            for (const long steps : {20L, 200L}) {
                StabilityRun run{.method = method, .model = model, .duration = {10, 1}, .samples = steps, .width = 2};
                const auto expected = greatest_energy_errors(run, releases, never);
                ASSERT_EQ(expected.size(), releases.size());
                for (const int width : register_widths()) {
                    run.width = width;
                    const auto errors = greatest_energy_errors(run, releases, never);
                    for (std::size_t i = 0; i < releases.size(); ++i) {
                        const auto lone = greatest_energy_errors(run, std::span(releases).subspan(i, 1), never);
                        for (const double error : {errors[i], lone[0]})
                            EXPECT_TRUE(error == expected[i] || (std::isnan(error) && std::isnan(expected[i])))
                                << method << " " << width << " " << i;
                    }
                }
            }
}

TEST(ReleasedEnergy, IsThatAboveHanging) {
    const Pendulum<double> p{.mass = {2, 3}, .length = {0.5, 0.7}, .angle = {0.4, 2.0}, .rate = {1.5, -0.3}};
    const double bottom = -p.potential_range() / 2;
    EXPECT_NEAR(released_energy(p),
                energy(bobs_of_angles(p, released_in_angles<double, Eigen::Dynamic>(p)), p.gravity) - bottom,
                5e-14);  // measured 7.1e-15
    // with θ = 10⁻⁷ the level alone would leave two digits
    EXPECT_NEAR(released_energy({.angle = {1e-7, 0}}) / (0.5 * 9.8 * 2e-14), 1, 5e-15);  // measured 1e-15
}

}  // namespace energy_stability_test
}  // namespace doppel
