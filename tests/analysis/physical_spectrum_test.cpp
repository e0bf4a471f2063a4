#include "analysis/exponent.hpp"
#include "analysis/physical_releases.hpp"
#include "analysis/spectrum.hpp"
#include "integrate/pendulums.hpp"
#include "integrate/taylor.hpp"
#include "physics/physical_chain.hpp"
#include "physics/physical_pendulums.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace doppel {
namespace physical_spectrum_test {

const std::atomic<bool> never = false;

double sum_of(const SpectrumSample& sample) {
    return std::accumulate(sample.exponents.begin(), sample.exponents.end(), 0.0);
}

/// Lagrange's equations, by hand: M_ij = K_ij cos(θ_i − θ_j), K_ij = l_i S_j (i < j), S_j = m_j a_j + l_j Σ_{k>j} m_k.
struct Lagrange {
    Eigen::MatrixXd k, stiffness;  // of M, and of gravity about hanging

    explicit Lagrange(const PhysicalPendulum<double>& p) : k(links(p), links(p)), stiffness(k) {
        stiffness.setZero();
        double below = 0;
        for (Eigen::Index i = links(p) - 1; i >= 0; --i) {
            const auto u = static_cast<std::size_t>(i);
            const double mass = p.chain.mass[u], length = p.chain.length[u], center = p.center[u];
            const double first = mass * center + length * below;
            k(i, i) = p.inertia[u] + mass * center * center + length * length * below;
            stiffness(i, i) = p.chain.gravity * first;
            for (Eigen::Index j = 0; j < i; ++j)
                k(i, j) = k(j, i) = p.chain.length[static_cast<std::size_t>(j)] * first;
            below += mass;
        }
    }
    Eigen::MatrixXd mass(const Eigen::VectorXd& theta) const {
        Eigen::MatrixXd m = k;
        for (Eigen::Index i = 0; i < k.rows(); ++i)
            for (Eigen::Index j = 0; j < k.rows(); ++j) m(i, j) *= std::cos(theta[i] - theta[j]);
        return m;
    }

private:
    static Eigen::Index links(const PhysicalPendulum<double>& p) { return static_cast<Eigen::Index>(p.chain.links()); }
};

/// C_jk = −∂Q_j/∂ω_k of viscous joints, of drag on arms, on ends and of the air met.
Eigen::MatrixXd damping(const PhysicalPendulum<double>& p, const Eigen::VectorXd& theta, const Eigen::VectorXd& omega,
                        double t) {
    const auto n = theta.size();
    const auto& f = p.friction;
    const auto of = [](const std::vector<double>& list, Eigen::Index i) {
        return list.empty() ? 0.0 : list[static_cast<std::size_t>(i)];
    };
    Eigen::MatrixXd c = Eigen::MatrixXd::Zero(n, n), way = Eigen::MatrixXd::Zero(2, n);  // ∂v/∂ω of a link's end
    const double nu = p.pivot.frequency;
    Eigen::Vector2d v = -nu * std::sin(nu * t + p.pivot.phase) * Eigen::Vector2d(p.pivot.x, p.pivot.y);
    for (Eigen::Index i = 0; i < n; ++i) {
        Eigen::VectorXd joint = Eigen::VectorXd::Unit(n, i);
        if (i > 0) joint[i - 1] = -1;
        c += of(f.viscous, i) * joint * joint.transpose();
        c(i, i) += of(f.arm_linear, i) + 2 * of(f.arm_quadratic, i) * std::abs(omega[i]);
        const auto u = static_cast<std::size_t>(i);
        const double first = p.chain.mass[u] * p.center[u], by_arm = first / (p.inertia[u] + first * p.center[u]);
        const Eigen::Vector2d across(std::cos(theta[i]), std::sin(theta[i]));
        Eigen::VectorXd met = by_arm * way.transpose() * across;  // ∂/∂ω of the rate that meets the air
        met[i] += 1;
        const double rate = omega[i] + by_arm * across.dot(v);
        c += 2 * of(f.air_quadratic, i) * std::abs(rate) * met * met.transpose();
        way.col(i) =
            p.chain.length[static_cast<std::size_t>(i)] * Eigen::Vector2d(std::cos(theta[i]), std::sin(theta[i]));
        v += way.col(i) * omega[i];
        Eigen::Matrix2d by_speed = of(f.drag_linear, i) * Eigen::Matrix2d::Identity();
        if (const double speed = v.norm(); speed > 0)
            by_speed += of(f.drag_quadratic, i) * (speed * Eigen::Matrix2d::Identity() + v * v.transpose() / speed);
        c += way.transpose() * by_speed * way;
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
        return -lagrange.mass(theta).ldlt().solve(damping(p, theta, omega, chain.layout.time_of(y))).trace();
    };
    double sum = now();
    for (int i = 1; i <= steps; ++i) {
        motion.advance(seconds / steps);
        sum += now() * (i == steps ? 1 : i % 2 == 1 ? 4 : 2);
    }
    return sum / (3 * steps);
}

TEST(PhysicalSpectrum, SumsToWhatFrictionDoesToTheVolume) {
    const auto apart = [](const PhysicalPendulum<double>& p, double seconds, int steps) {
        const auto end = lyapunov_spectrum(p, {.duration_s = seconds, .samples = 3, .tolerance = 1e-13}, never).back();
        EXPECT_EQ(end.exponents.size(), 2 * p.chain.links());  // neither the time nor the work has one
        const double expected = mean_contraction(p, seconds, steps);
        EXPECT_LT(expected, -0.05);
        return std::abs(sum_of(end) - expected);
    };
    auto two = rods({{1.2, 0.7}, {0.9, 1.1}, {2.2, -0.4}, {0, 1}});
    two.friction.viscous = {0.11, 0.05};
    EXPECT_LT(apart(two, 10, 20000), 1e-11);  // measured 5e-15
    auto three = rods({{1.2, 0.7, 0.9}, {0.9, 1.1, 0.6}, {2.2, -0.4, 1.0}, {0, 1, -0.5}});
    three.friction.viscous = {0.11, 0.05, 0.02};
    three.friction.arm_linear = {0.02, 0, 0.03};
    three.friction.drag_linear = {0, 0.02, 0.03};
    EXPECT_LT(apart(three, 10, 20000), 1e-11);  // measured 4e-13
    // driven, with drag; the squares of rates have corners at 0
    EXPECT_LT(apart(driven_bodies<double>(2), 5, 20000), 1e-11);  // measured 8e-14
    auto airy = two;
    airy.friction.air_quadratic = {0.05, 0.08};
    airy.pivot = {0.2, 0.1, 5.5, 0.5};
    EXPECT_LT(apart(airy, 5, 20000), 2e-7);  // measured 2.4e-8
    auto arms = two;
    arms.friction.arm_quadratic = {0.05, 0.08};
    EXPECT_LT(apart(arms, 5, 20000), 4e-7);  // measured 7e-8
}

TEST(PhysicalSpectrum, OfOneDrivenLinkSumsToFrictionOverInertia) {
    const auto p = driven(1.15);
    const double exact = -0.5 * std::sqrt(9.8 / 0.8);
    for (const auto& sample : lyapunov_spectrum(p, {.duration_s = 60, .samples = 6, .tolerance = 1e-12}, never))
        EXPECT_NEAR(sum_of(sample), exact, 2e-12);  // measured 2.4e-13
    auto shaken = rods({{1.2}, {0.9}, {2.2}, {0.3}});
    shaken.friction.viscous = {0.2};
    shaken.pivot = {0.1, 0.3, 11, 0.4};
    EXPECT_NEAR(sum_of(lyapunov_spectrum(shaken, {.duration_s = 20, .samples = 1, .tolerance = 1e-12}, never)[0]),
                -0.2 / (1.2 * 0.9 * 0.9 / 3), 1e-12);  // measured 1.4e-13
}

TEST(PhysicalSpectrum, WithoutFrictionIsThatOfAHamiltonianSystem) {
    const auto p = rods(from_rest({140, 0}));
    const auto end = lyapunov_spectrum(p, {.duration_s = 300, .samples = 1}, never)[0];
    EXPECT_LT(std::abs(sum_of(end)), 1e-11);  // measured 1.2e-12
    EXPECT_GT(end.exponents[0], 0.5);
    EXPECT_LT(std::abs(end.exponents[1]), 0.05);
    EXPECT_LT(pair_mismatch(end), 0.002);
    // a drive takes the energy's exponent away, but no volume
    auto pushed = bodies<double>(2);
    pushed.pivot = {0, 0.2, 6, 0};
    pushed.torques = {{1, 0.7, 3.5, 0.25}};
    EXPECT_LT(
        std::abs(sum_of(lyapunov_spectrum(pushed, {.duration_s = 20, .samples = 1, .tolerance = 1e-12}, never)[0])),
        1e-10);
}

TEST(PhysicalSpectrum, LargestExponentOfPointMassesIsThatOfTheirChain) {
    for (const std::size_t links : {1, 2, 3, 4}) {
        const auto p = uneven(links);
        const ExponentSpec of_one{.duration_s = 6, .transient_s = 1, .tolerance = 1e-12};
        const auto one = largest_exponent(p, of_one, never), other = largest_exponent(physical(p), of_one, never);
        EXPECT_NEAR(other.value, one.value, 3e-11) << links;              // measured 3e-12
        EXPECT_NEAR(other.uncertainty, one.uncertainty, 3e-11) << links;  // measured 4.2e-12
    }
}

/// Eigenvalues of M θ″ + C θ′ + K θ = 0 about hanging, the greatest real part first.
std::vector<double> real_parts(const PhysicalPendulum<double>& p) {
    const auto n = static_cast<Eigen::Index>(p.chain.links());
    const Lagrange lagrange(p);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(n);
    const auto mass = lagrange.mass(none).ldlt();
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    all.topRightCorner(n, n).setIdentity();
    all.bottomLeftCorner(n, n) = -mass.solve(lagrange.stiffness);
    all.bottomRightCorner(n, n) = -mass.solve(damping(p, none, none, 0));
    const Eigen::VectorXd real = all.eigenvalues().real();
    std::vector<double> parts(real.data(), real.data() + real.size());
    std::sort(parts.rbegin(), parts.rend());
    return parts;
}

TEST(PhysicalSpectrum, AtRestHasTheRealPartsOfTheEigenvalues) {
    // overdamped: four real ones; what the first frame makes of it decays like 1/t, so between two times
    auto p = rods({{1.2, 0.7}, {0.9, 1.1}, {0, 0}, {0, 0}});
    p.friction.arm_linear = {12, 2.5};
    const auto exact = real_parts(p);
    EXPECT_LT(exact[0] / exact[1], 0.5);  // −1.03, −2.11, −4.32 and −35.3 1/s
    const auto all = lyapunov_spectrum(p, {.duration_s = 60, .samples = 2, .tolerance = 1e-12}, never);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(2 * all[1].exponents[i] - all[0].exponents[i], exact[i], 4e-9) << i;  // measured 4e-10
    EXPECT_NEAR(largest_exponent(p, {}, never).value, exact[0], 3e-14);                   // measured 2.2e-15
    // one link swings: after a whole period of e^(−γt), all tangents are as they were but for that
    auto one = rods({{1.2}, {0.9}, {0}, {0}});
    one.friction.viscous = {0.2};
    const double inertia = 1.2 * 0.9 * 0.9 / 3, gamma = 0.2 / (2 * inertia);
    const double frequency = std::sqrt(9.8 * 1.2 * 0.45 / inertia - gamma * gamma);
    const auto period =
        lyapunov_spectrum(one, {.duration_s = 2 * pi / frequency, .samples = 1, .tolerance = 1e-13}, never);
    for (const double exponent : period[0].exponents) EXPECT_NEAR(exponent, -gamma, 1e-13);  // measured 1e-14
    EXPECT_NEAR(largest_exponent(one, {}, never).value, -gamma, 1e-15);                      // measured 6e-17
}

TEST(PhysicalSpectrum, ResolvesContractionBeyondAllDigits) {
    // e^(−2000) in a part of the time that an undamped one would take
    auto p = rods({{1.2}, {0.9}, {0}, {0}});
    p.friction.viscous = {600};
    const auto exact = real_parts(p);
    EXPECT_LT(exact[1], -1800);
    const auto all = lyapunov_spectrum(p, {.duration_s = 1, .samples = 2}, never);
    for (std::size_t i = 0; i < 2; ++i)
        EXPECT_NEAR((2 * all[1].exponents[i] - all[0].exponents[i]) / exact[i], 1, 1e-7) << i;  // measured 9e-9
}

}  // namespace physical_spectrum_test
}  // namespace doppel
