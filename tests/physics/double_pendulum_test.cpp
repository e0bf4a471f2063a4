#include "numeric/quad.hpp"
#include "physics/angle_chain.hpp"
#include "physics/force.hpp"
#include "physics/mechanism.hpp"
#include "physics/oracles.hpp"
#include "physics/pendulums.hpp"
#include "physics/physical_chain.hpp"
#include "physics/rod_chain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace doppel::double_pendulum_test {

template <class Model>
void expect_solves_the_mass_matrix(std::size_t links, double tolerance) {
    std::mt19937 random(6);
    for (int i = 0; i < 100; ++i) {
        const auto p = random_pendulum(random, links);
        const auto expected = by_elimination(physical(p));
        const Eigen::VectorXd rate = rate_at_start<Model>(p);
        const auto n = static_cast<long>(links);
        EXPECT_LT((rate.tail(n) - expected).norm(), tolerance * (1 + expected.norm())) << links;
        EXPECT_EQ(rate.head(n), Eigen::Map<const Eigen::VectorXd>(p.rate.data(), n));
    }
}

TEST(Models, InAnglesSolveTheMassMatrix) {
    expect_solves_the_mass_matrix<DoublePendulum<double>>(2, 3e-14);  // measured 5.2e-15 of it
    for (const std::size_t links : {1u, 2u, 3u, 4u, 7u, 32u})
        expect_solves_the_mass_matrix<AngleChain<double, Eigen::Dynamic>>(links, 7e-13);  // measured 1.6e-13 of it
}

template <int N>
void expect_falls_as_the_angles_do(std::size_t links) {
    std::mt19937 random(3);
    for (int i = 0; i < 100; ++i) {
        const auto p = random_pendulum(random, links);
        const auto expected = accelerations_of_bobs(p);
        const Eigen::VectorXd rate = rate_at_start<RodChain<double, N>>(p);
        for (std::size_t link = 0; link < links; ++link) {
            const Eigen::Vector2d found = rate.segment<2>(2 * static_cast<long>(links + link));
            EXPECT_LT((found - expected[link]).norm(), 1e-12 * (1 + expected[link].norm())) << links;  // measured 7e-14
        }
    }
}

TEST(Models, OnRodsFallAsTheAnglesDo) {
    expect_falls_as_the_angles_do<2>(2);
    expect_falls_as_the_angles_do<3>(3);
    expect_falls_as_the_angles_do<Eigen::Dynamic>(12);
}

/// The rates at a stage, near the last state or far from it, equal those computed anew.
template <class Model>
void expect_stages_reuse_angles(std::size_t links) {
    std::mt19937 random(11);
    for (int i = 0; i < 50; ++i) {
        Model model(random_pendulum(random, links));
        const auto start = Model::start(random_pendulum(random, links));
        auto stage = start;
        for (Eigen::Index k = 0; k < stage.size() / 2; ++k) stage[k] += k == 1 ? 0.2 : 7e-4;
        auto rate = start, expected = start;
        typename Model::Angles angles;
        model.rate(start, rate, angles.start());
        model.rate(start, expected);
        EXPECT_EQ(rate, expected);
        model.rate(stage, rate, angles.stage());
        model.rate(stage, expected);
        EXPECT_LT((rate - expected).norm(), 1e-13 * (1 + expected.norm())) << links;  // measured 1.5e-14 of it
    }
}

TEST(Models, StagesReuseTheAnglesOfTheStep) {
    expect_stages_reuse_angles<DoublePendulum<double>>(2);
    expect_stages_reuse_angles<AngleChain<double, 9>>(9);
}

TEST(Models, StayExactlyInEquilibrium) {
    const Pendulum<double> p{{1, 2, 3}, {1, 2, 0.5}, {0, 0, 0}, {0, 0, 0}, 9.8},
        two{{1, 2}, {1, 3}, {0, 0}, {0, 0}, 9.8};
    EXPECT_EQ(rate_at_start<DoublePendulum<double>>(two), (State<double, 4>::Zero()));
    EXPECT_EQ((rate_at_start<AngleChain<double, 3>>(p)), (State<double, 6>::Zero()));
    EXPECT_EQ((rate_at_start<RodChain<double, 2>>(two)), (State<double, 8>::Zero()));
}

TEST(RodChain, BothModelsReportTheSameBobs) {
    std::mt19937 random(4);
    for (int i = 0; i < 50; ++i) {
        const auto p = random_pendulum(random);
        const auto rods = bobs_of_particles(p, RodChain<double, 2>::start(p));
        EXPECT_LT(length_error(p, rods), 1e-15);
        for (std::size_t link = 0; link < 2; ++link) {
            EXPECT_NEAR(rods[link].theta, p.angle[link], 3e-15);  // measured 4.4e-16
            EXPECT_NEAR(rods[link].omega, p.rate[link], 7e-15);   // measured 1.3e-15
        }
    }
}

TEST(Pendulum, EnergyIsThatOfTheLagrangian) {
    std::mt19937 random(5);
    for (int i = 0; i < 50; ++i) {
        const auto p = random_pendulum(random);
        const double m1 = p.mass[0], m2 = p.mass[1], l1 = p.length[0], l2 = p.length[1];
        const double t1 = p.angle[0], t2 = p.angle[1], w1 = p.rate[0], w2 = p.rate[1];
        const double kinetic = 0.5 * (m1 + m2) * l1 * l1 * w1 * w1 + 0.5 * m2 * l2 * l2 * w2 * w2 +
                               m2 * l1 * l2 * w1 * w2 * std::cos(t1 - t2);
        const double potential = -(m1 + m2) * p.gravity * l1 * std::cos(t1) - m2 * p.gravity * l2 * std::cos(t2);
        EXPECT_NEAR(energy(bobs_of_angles(p, DoublePendulum<double>::start(p)), p.gravity), kinetic + potential,
                    1e-12);  // measured 1.7e-13
    }
}

TEST(Pendulum, DefaultsMeanTheirDecimalsInEveryScalar) {
    EXPECT_EQ(Pendulum<double>{}.gravity, 9.8);
    EXPECT_EQ(Pendulum<Quad>{}.gravity, parse_quad("9.8"));
    EXPECT_EQ(Gravity<Quad>{}.g, parse_quad("9.8"));
    EXPECT_EQ(newton_constant<double>(), 6.674e-11);
    EXPECT_EQ(newton_constant<Quad>(), parse_quad("6.674e-11"));
}

TEST(Bobs, OfAChainAreFoundWhereFurtherParticlesFollow) {
    const Pendulum<double> p{{1, 2}, {1, 0.5}, {0.4, -0.7}, {3, -2}, 9.8};
    const auto alone = released_as_particles<double, Eigen::Dynamic>(p);
    State<double, Eigen::Dynamic> y(12);
    y << alone.head(4), 7, 8, alone.tail(4), 9, 10;
    const auto seen = bobs_of_particles(p, y);
    ASSERT_EQ(seen.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(seen[i].vx, alone[4 + 2 * static_cast<Eigen::Index>(i)]);
        EXPECT_EQ(seen[i].vy, alone[5 + 2 * static_cast<Eigen::Index>(i)]);
        EXPECT_NEAR(seen[i].omega, p.rate[i], 1e-14);  // measured 9e-16
    }
}

/// Every pattern of light and unit masses, with links 1e-3 rad from aligned that rotate at different rates.
template <class Check>
void for_each_pattern(std::size_t links, double light, const Check& check) {
    for (unsigned pattern = 0; pattern < 1u << links; ++pattern) {
        Pendulum<double> p{{}, {}, {}, {}, 9.8};
        for (std::size_t i = 0; i < links; ++i) {
            p.mass.push_back((pattern >> i & 1u) == 1 ? light : 1);
            p.length.push_back(1 - 0.1 * static_cast<double>(i));
            p.angle.push_back(0.7 + (i % 2 == 0 ? 0 : 1e-3));
            p.rate.push_back(1 + 0.5 * static_cast<double>(i));
        }
        check(p);
    }
}

/// The error of the accelerations of `model` against quad at the same state, relative to the largest one.
template <template <class> class Model, class Description>
double error_of(const Description& description) {
    Model<double> model(description);
    const auto exactly = description.template cast<Quad>();
    Model<Quad> truth(exactly);
    const auto y = Model<double>::start(description);
    typename Model<double>::State found = y;
    typename Model<Quad>::State exact_y = y.template cast<Quad>(), expected = exact_y;
    model.rate(y, found);
    truth.rate(exact_y, expected);
    double worst = 0, size = 0;
    for (Eigen::Index i = y.size() / 2; i < y.size(); ++i) {
        worst = std::max(worst, std::abs(static_cast<double>(Quad(Quad(found[i]) - expected[i]))));
        size = std::max(size, std::abs(static_cast<double>(expected[i])));
    }
    return worst / size;
}

template <class S>
using Double = DoublePendulum<S>;
template <class S>
using Angles = AngleChain<S, Eigen::Dynamic>;
template <class S>
using Rods2 = RodChain<S, 2>;
template <class S>
using Rods3 = RodChain<S, 3>;
template <class S>
using Rods = RodChain<S, Eigen::Dynamic>;

TEST(LightMasses, KeepTheirAccelerations) {
    for (const double light : {1e-2, 1e-4, 1e-6, 1e-8}) {
        double angles = 0, rods = 0, mechanism = 0;
        const auto note = [](double& worst, double error) { worst = std::max(worst, error); };
        for (const std::size_t links : {2u, 3u, 5u})
            for_each_pattern(links, light, [&](const auto& p) {
                note(angles, error_of<Angles>(p)), note(rods, error_of<Rods>(p));
                note(mechanism, error_of<Mechanism>(parts_of(p)));
                if (links == 2) note(angles, error_of<Double>(p)), note(rods, error_of<Rods2>(p));
                if (links == 3) note(rods, error_of<Rods3>(p));
            });
        EXPECT_LT(angles, 5e-15) << light;  // measured 7e-16
        EXPECT_LT(rods, 5e-15) << light;    // measured 1.1e-15
        EXPECT_LT(mechanism, 5e-13)
            << light;  // measured 1.6e-13; positions have 1e-16 m, rods are 1e-3 rad from aligned
    }
}

TEST(LightMasses, KeepTheirAccelerationsAsBodies) {
    for (const double light : {1e-2, 1e-4, 1e-6, 1e-8})
        for (const bool are_rods : {false, true})
            for (const std::size_t links : {2u, 3u, 5u}) {
                double worst = 0;
                for_each_pattern(links, light, [&](const auto& chain) {
                    worst = std::max(worst, error_of<PhysicalChain>(are_rods ? rods(chain) : physical(chain)));
                });
                EXPECT_LT(worst, links == 5 ? 5e-14 : 1e-14) << light << ' ' << are_rods;  // measured 1.7e-14 and 4e-15
            }
}

}  // namespace doppel::double_pendulum_test
