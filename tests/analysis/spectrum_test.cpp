#include "analysis/exponent.hpp"
#include "integrate/taylor.hpp"
#include "physics/oracles.hpp"
#include "physics/pendulums.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace doppel::spectrum_test {

const std::atomic<bool> never = false;

double sum_of(const SpectrumSample& sample) {
    return std::accumulate(sample.exponents.begin(), sample.exponents.end(), 0.0);
}

TEST(Spectrum, KeepsTheVolume) {
    // Liouville: the canonical volume is constant in time, for any masses and lengths
    for (const std::size_t links : {1, 2, 3, 4})
        for (const auto& sample :
             lyapunov_spectrum(physical(uneven(links)), {.duration_s = 10, .samples = 10}, never)) {
            ASSERT_EQ(sample.exponents.size(), 2 * links);
            EXPECT_NEAR(sum_of(sample), 0, 3e-10) << links << " links";  // measured 7.4e-11
        }
}

TEST(Spectrum, OfTheUprightEquilibriumInClosedForm) {
    // λ² = g (2 ± √2), each with both signs; the effect of the initial frame decays as 1/t, so compare two times
    const auto samples = lyapunov_spectrum(physical(from_rest({180, 180})), {.duration_s = 4.5, .samples = 3}, never);
    const double strong = std::sqrt(9.8 * (2 + std::sqrt(2.0))), weak = std::sqrt(9.8 * (2 - std::sqrt(2.0)));
    const double exact[] = {strong, weak, -weak, -strong};
    for (std::size_t i = 0; i < 4; ++i) {
        const double rise = 4.5 * samples[2].exponents[i] - 3 * samples[1].exponents[i];
        EXPECT_NEAR(rise / 1.5, exact[i], 2e-5) << i;  // measured 5e-6
    }
}

TEST(Spectrum, DoesNotDependOnTheIntervalOfOrthonormalisation) {
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

/// C_jk = −∂Q_j/∂ω_k of viscous joints, and of drag on links and ends due to their velocity.
Eigen::MatrixXd damping(const PhysicalPendulum<double>& p, const Eigen::VectorXd& theta, const Eigen::VectorXd& omega) {
    const auto n = theta.size();
    const auto& f = p.friction;
    const auto of = [](const std::vector<double>& list, Eigen::Index i) {
        return list.empty() ? 0.0 : list[static_cast<std::size_t>(i)];
    };
    Eigen::MatrixXd c = Eigen::MatrixXd::Zero(n, n), way = Eigen::MatrixXd::Zero(2, n);  // ∂v/∂ω of a link's end
    for (Eigen::Index i = 0; i < n; ++i) {
        Eigen::VectorXd joint = Eigen::VectorXd::Unit(n, i);
        if (i > 0) joint[i - 1] = -1;
        c += of(f.viscous, i) * joint * joint.transpose();
        c(i, i) += of(f.link_linear, i) + 2 * of(f.link_quadratic, i) * std::abs(omega[i]);
        way.col(i) =
            p.chain.length[static_cast<std::size_t>(i)] * Eigen::Vector2d(std::cos(theta[i]), std::sin(theta[i]));
        c += of(f.drag_linear, i) * way.transpose() * way;
    }
    return c;
}

/// The mean of −tr(C M⁻¹) over the motion, by Simpson's rule.
double mean_contraction(const PhysicalPendulum<double>& p, double seconds, int steps) {
    PhysicalChain<double> chain(p);
    Taylor::Stepper<PhysicalChain<double>> motion(chain, PhysicalChain<double>::start(p), 1e-15);
    const Lagrange lagrange(p);
    const auto now = [&] {
        const auto& y = motion.state();
        const Eigen::VectorXd state = chain.layout.of_links(y);
        const auto n = state.size() / 2;
        const Eigen::VectorXd theta = state.head(n), omega = state.tail(n);
        return -lagrange.mass(theta).ldlt().solve(damping(p, theta, omega)).trace();
    };
    double sum = now();
    for (int i = 1; i <= steps; ++i) {
        motion.advance(seconds / steps);
        sum += now() * (i == steps ? 1 : i % 2 == 1 ? 4 : 2);
    }
    return sum / (3 * steps);
}

TEST(Spectrum, SumsToWhatFrictionDoesToTheVolume) {
    const auto apart = [](const PhysicalPendulum<double>& p, double seconds, int steps) {
        const auto end = lyapunov_spectrum(p, {.duration_s = seconds, .samples = 3, .tolerance = 1e-13}, never).back();
        EXPECT_EQ(end.exponents.size(), 2 * p.chain.links());  // no exponent of the time or the work
        const double expected = mean_contraction(p, seconds, steps);
        EXPECT_LT(expected, -0.05);
        return std::abs(sum_of(end) - expected);
    };
    auto two = rods({{1.2, 0.7}, {0.9, 1.1}, {2.2, -0.4}, {0, 1}});
    two.friction.viscous = {0.11, 0.05};
    EXPECT_LT(apart(two, 10, 20000), 1e-11);  // measured 5e-15
    auto three = rods({{1.2, 0.7, 0.9}, {0.9, 1.1, 0.6}, {2.2, -0.4, 1.0}, {0, 1, -0.5}});
    three.friction.viscous = {0.11, 0.05, 0.02};
    three.friction.link_linear = {0.02, 0, 0.03};
    three.friction.drag_linear = {0, 0.02, 0.03};
    EXPECT_LT(apart(three, 10, 20000), 1e-11);  // measured 4e-13
    // driven; the squares of rates have kinks at 0
    auto arms = two;
    arms.friction.link_quadratic = {0.05, 0.08};
    arms.pivot = {0.2, 0.1, 5.5, 0.5};
    EXPECT_LT(apart(arms, 5, 20000), 4e-7);  // measured 7e-8
}

TEST(Spectrum, WithoutFrictionComesInPairsOfWhichTwoVanish) {
    for (const auto& p : {physical(from_rest({140, 0})), rods(from_rest({140, 0}))}) {
        const auto end = lyapunov_spectrum(p, {.duration_s = 300, .samples = 1}, never)[0];
        const auto largest = largest_exponent(p, {.duration_s = 300, .transient_s = 20}, never);
        EXPECT_NEAR(end.exponents[0], largest.value, 4 * largest.uncertainty);
        EXPECT_LT(std::abs(end.exponents[1]), 0.05);  // measured 0.016
        EXPECT_LT(std::abs(end.exponents[2]), 0.05);
        EXPECT_LT(pair_mismatch(end), 0.002);  // measured 2e-4
    }
    EXPECT_NEAR(pair_mismatch({1, {3, 2, -1.5, -2.75}}), 0.5, 1e-15);
    EXPECT_NEAR(pair_mismatch({1, {3, 2, -1.5, -2}}), 1, 1e-15);
    // a drive removes the zero exponent of the energy, but conserves the volume
    auto pushed = bodies<double>(2);
    pushed.pivot = {0, 0.2, 6, 0};
    pushed.torques = {{1, 0.7, 3.5, 0.25}};
    EXPECT_LT(
        std::abs(sum_of(lyapunov_spectrum(pushed, {.duration_s = 20, .samples = 1, .tolerance = 1e-12}, never)[0])),
        1e-10);
}

/// Real parts of the eigenvalues of M θ″ + C θ′ + K θ = 0 about hanging at rest, the largest first.
std::vector<double> real_parts(const PhysicalPendulum<double>& p) {
    const auto n = static_cast<Eigen::Index>(p.chain.links());
    const Lagrange lagrange(p);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(n);
    const auto mass = lagrange.mass(none).ldlt();
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    all.topRightCorner(n, n).setIdentity();
    all.bottomLeftCorner(n, n) = -mass.solve(Eigen::MatrixXd((p.chain.gravity * lagrange.s).asDiagonal()));
    all.bottomRightCorner(n, n) = -mass.solve(damping(p, none, none));
    const Eigen::VectorXd real = all.eigenvalues().real();
    std::vector<double> parts(real.data(), real.data() + real.size());
    std::sort(parts.rbegin(), parts.rend());
    return parts;
}

TEST(Spectrum, AtRestHasTheRealPartsOfTheEigenvalues) {
    // overdamped: four real ones; the effect of the initial frame decays as 1/t, so compare two times
    auto p = rods({{1.2, 0.7}, {0.9, 1.1}, {0, 0}, {0, 0}});
    p.friction.link_linear = {12, 2.5};
    const auto exact = real_parts(p);
    EXPECT_LT(exact[0] / exact[1], 0.5);  // −1.03, −2.11, −4.32 and −35.3 1/s
    const auto all = lyapunov_spectrum(p, {.duration_s = 60, .samples = 2, .tolerance = 1e-12}, never);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(2 * all[1].exponents[i] - all[0].exponents[i], exact[i], 4e-9) << i;  // measured 4e-10
    EXPECT_NEAR(largest_exponent(p, {}, never).value, exact[0], 3e-14);                   // measured 2.2e-15
    // one link oscillates: after a whole period, all tangents return, multiplied by e^(−γt)
    auto one = rods({{1.2}, {0.9}, {0}, {0}});
    one.friction.viscous = {0.2};
    const double inertia = 1.2 * 0.9 * 0.9 / 3, gamma = 0.2 / (2 * inertia);
    const double frequency = std::sqrt(9.8 * 1.2 * 0.45 / inertia - gamma * gamma);
    const auto period =
        lyapunov_spectrum(one, {.duration_s = 2 * pi / frequency, .samples = 1, .tolerance = 1e-13}, never);
    for (const double exponent : period[0].exponents) EXPECT_NEAR(exponent, -gamma, 1e-13);  // measured 1e-14
    EXPECT_NEAR(largest_exponent(one, {}, never).value, -gamma, 1e-15);                      // measured 6e-17
}

TEST(Spectrum, ResolvesContractionBeyondAllDigits) {
    // a contraction of e^(−2000) in less time than an undamped swing takes
    auto p = rods({{1.2}, {0.9}, {0}, {0}});
    p.friction.viscous = {600};
    const auto exact = real_parts(p);
    EXPECT_LT(exact[1], -1800);
    const auto all = lyapunov_spectrum(p, {.duration_s = 1, .samples = 2}, never);
    for (std::size_t i = 0; i < 2; ++i)
        EXPECT_NEAR((2 * all[1].exponents[i] - all[0].exponents[i]) / exact[i], 1, 1e-7) << i;  // measured 9e-9
}

}  // namespace doppel::spectrum_test
