#include "analysis/spectrum.hpp"

#include "analysis/exponent.hpp"
#include "base/error.hpp"
#include "integrate/pendulums.hpp"
#include "physics/physical_pendulum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace doppel {
namespace spectrum_test {

const std::atomic<bool> never = false;

double sum_of(const std::vector<double>& all) {
    return std::accumulate(all.begin(), all.end(), 0.0);
}

TEST(Spectrum, KeepsTheVolume) {
    // Liouville: the canonical volume stays, at every time, for any masses and lengths
    for (const std::size_t links : {1, 2, 3, 4})
        for (const auto& sample :
             lyapunov_spectrum(physical(uneven(links)), {.duration_s = 10, .samples = 10}, never)) {
            ASSERT_EQ(sample.exponents.size(), 2 * links);
            EXPECT_NEAR(sum_of(sample.exponents), 0, 3e-10) << links << " links";  // measured 7.4e-11
        }
}

TEST(Spectrum, OfTheUprightEquilibriumInClosedForm) {
    // λ² = g (2 ± √2), each with both signs; what the first frame makes of it decays like 1/t, so between two times
    const auto samples = lyapunov_spectrum(physical(from_rest({180, 180})), {.duration_s = 4.5, .samples = 3}, never);
    const double strong = std::sqrt(9.8 * (2 + std::sqrt(2.0))), weak = std::sqrt(9.8 * (2 - std::sqrt(2.0)));
    const double exact[] = {strong, weak, -weak, -strong};
    for (std::size_t i = 0; i < 4; ++i) {
        const double rise = 4.5 * samples[2].exponents[i] - 3 * samples[1].exponents[i];
        EXPECT_NEAR(rise / 1.5, exact[i], 2e-5) << i;  // measured 5e-6
    }
}

TEST(Spectrum, VanishesForRegularMotion) {
    // like ln(t)/t
    const auto greatest = [](const SpectrumSample& sample) {
        double most = 0;
        for (const double exponent : sample.exponents) most = std::max(most, std::abs(exponent));
        return most;
    };
    const auto samples = lyapunov_spectrum(physical(from_rest({10, 5})), {.duration_s = 400, .samples = 4}, never);
    EXPECT_LT(greatest(samples[3]), 0.015);                       // measured 0.006
    EXPECT_LT(greatest(samples[3]), 0.5 * greatest(samples[0]));  // measured 0.28
}

TEST(Spectrum, OfChaosComesInPairsAndTwoVanish) {
    const auto p = from_rest({140, 0});
    const SpectrumSample end = lyapunov_spectrum(physical(p), {.duration_s = 300, .samples = 1}, never)[0];
    const Exponent largest = largest_exponent(p, {.duration_s = 300, .transient_s = 20}, never);
    EXPECT_NEAR(end.exponents[0], largest.value, 4 * largest.uncertainty);  // measured 0.012
    EXPECT_LT(std::abs(end.exponents[1]), 0.05);                            // measured 0.016
    EXPECT_LT(std::abs(end.exponents[2]), 0.05);                            // measured 0.016
    EXPECT_LT(pair_mismatch(end), 0.002);                                   // measured 2e-4
    EXPECT_NEAR(pair_mismatch({1, {3, 2, -1.5, -2.75}}), 0.5, 1e-15);
    EXPECT_NEAR(pair_mismatch({1, {3, 2, -1.5, -2}}), 1, 1e-15);
}

TEST(Spectrum, DoesNotDependOnHowOftenTheFrameIsSetUpright) {
    // the factors R of a product of QRs multiply to the R of the whole
    const auto p = uneven(3);
    const auto rarely =
        lyapunov_spectrum(physical(p), {.duration_s = 4, .samples = 2, .tolerance = 1e-12}, never).back();
    const auto often =
        lyapunov_spectrum(physical(p), {.duration_s = 4, .samples = 64, .tolerance = 1e-12}, never).back();
    EXPECT_EQ(rarely.time_s, often.time_s);
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(rarely.exponents[i], often.exponents[i], 1e-11) << i;  // measured 1.4e-12
}

}  // namespace spectrum_test
}  // namespace doppel
