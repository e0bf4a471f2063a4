#include "physics/mechanism.hpp"

#include "errors.hpp"
#include "numeric/quad.hpp"
#include "physics/mechanisms.hpp"
#include "physics/oracles.hpp"
#include "physics/pendulums.hpp"
#include "physics/rod_chain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace doppel::mechanism_test {

using namespace counted;

static_assert(Constrained<Mechanism<double>> && Constrained<Mechanism<Quad>>);

TEST(Mechanism, ConstraintsMakePendulumsAndSlopesOfClosedForm) {
    const auto expect_acceleration = [](const Assembly<double>& parts, const P& expected) {
        check(parts);
        const auto dydt = rate_at_start<Mechanism<double>>(parts);
        EXPECT_LT((dydt.tail<2>() - expected).norm(), 1e-14) << parts.particles.size();  // measured 1.6e-15
        if (parts.particles.size() == 2) {
            EXPECT_LT(dydt.segment<2>(4).norm(), 1e-15);  // the anchored particle does not move
        }
    };
    // θ″ = −(g/l) sinθ: at rest, a = l θ″ (cosθ, sinθ)
    expect_acceleration({.particles = {{3, P(1, 2)}, {2, P(1 + 1.2, 2 - 1.6)}},
                         .constraints = {Anchor<double>{one, P(1, 2)}, Rod<double>{two, one, 2}},
                         .forces = {Gravity<double>{}}},
                        P(-9.8 * 0.6 * 0.8, -9.8 * 0.6 * 0.6));
    // in a circular slot at v = 2 m/s there is also v²/r to the centre
    expect_acceleration({.particles = {{2, P(0.6, -0.8), P(1.6, 1.2)}},
                         .constraints = {SlotCircle<double>{one, P(0, 0), 1}},
                         .forces = {Gravity<double>{}}},
                        P(-9.8 * 0.6 * 0.8 - 4 * 0.6, -9.8 * 0.6 * 0.6 + 4 * 0.8));
    // down a slope of 3 : 4, sin α = 3/5
    expect_acceleration({.particles = {{2, P(1, 1)}},
                         .constraints = {SlotLine<double>{one, P(1, 1), P(4, -3)}},
                         .forces = {Gravity<double>{10}}},
                        P(6 * 0.8, -6 * 0.6));
}

TEST(Mechanism, DampedSpringDecaysAsItShould) {
    // r″ = −(k/μ) (r − l) − (c/μ) r′ of two masses, μ = m1 m2 / (m1 + m2):
    // r = l + A e^(−βt) (cos νt + (β/ν) sin νt) ,  β = c/2μ ,  ν² = k/μ − β²
    Assembly<double> parts{.particles = {{1, P(0, 0)}, {3, P(0.9, 1.2)}},
                           .constraints = {},
                           .forces = {Spring<double>{one, two, 8, 1.25, 0.6}}};
    check(parts);
    Mechanism<double> model(parts);
    const auto y = after(model, parts, 2000, 1e-3);
    const double mu = 0.75, beta = 0.6 / (2 * mu), nu = std::sqrt(8 / mu - beta * beta), t = 2;
    const double expected = 1.25 + 0.25 * std::exp(-beta * t) * (std::cos(nu * t) + beta / nu * std::sin(nu * t));
    EXPECT_NEAR((y.segment<2>(2) - y.segment<2>(0)).norm(), expected, 3e-12);  // measured 5e-13
    EXPECT_NEAR((y.segment<2>(4) + 3 * y.segment<2>(6)).norm(), 0, 3e-15);     // momentum; measured 4.2e-16
    EXPECT_FALSE(parts.conserves_energy());
    EXPECT_TRUE(model.depends_on_velocity());
    parts.forces = {Spring<double>{one, two, 8, 1.25}};
    EXPECT_TRUE(parts.conserves_energy());
    EXPECT_FALSE(Mechanism<double>(parts).depends_on_velocity());
}

TEST(Mechanism, AttractionKeepsACircularOrbit) {
    // two bodies at distance d: ω² = G (m1 + m2) / d³, so a = −ω² r
    const double G = 2, m1 = 3, m2 = 1, d = 2, omega2 = G * (m1 + m2) / (d * d * d);
    const Assembly<double> parts{.particles = {{m1, P(-0.5, 0)}, {m2, P(1.5, 0)}},
                                 .constraints = {},
                                 .forces = {Attraction<double>{one, two, G}}};
    check(parts);
    const auto dydt = rate_at_start<Mechanism<double>>(parts);
    EXPECT_LT((dydt.tail<4>() - omega2 * State<double, 4>(0.5, 0, -1.5, 0)).norm(), 1e-15);  // measured 0
    EXPECT_NEAR(Mechanism<double>(parts).energy(Mechanism<double>::start(parts)), -G * m1 * m2 / d, 1e-15);
}

/// A falling mass, and 0.034 g one mile to its right, as in the study.
template <class S>
Assembly<S> beside_a_droplet() {
    return {.particles = {{S(1), At<S>(S(0), S(0))}},
            .constraints = {},
            .forces = {Gravity<S>{}, Droplet<S>{At<S>(S(1609), S(0)), S(34) / S(1000000)}}};
}

TEST(Mechanism, DropletHasAnEffectOnlyInQuad) {
    // G M / r² = 6.674e-11 · 3.4e-5 / 1609²
    const auto dydt = rate_at_start<Mechanism<Quad>>(beside_a_droplet<Quad>());
    const Quad expected = parse_quad("6.674e-11") * parse_quad("3.4e-5") / (Quad(1609) * Quad(1609));
    EXPECT_NEAR(static_cast<double>(expected), 8.8e-22, 0.05e-22);
    EXPECT_LT(static_cast<double>(abs(Quad(dydt[2] / expected - 1))), 2e-33);  // measured 0

    // exactly above, it reduces the weight, but not in double
    auto above = beside_a_droplet<Quad>();
    std::get<Droplet<Quad>>(above.forces[1]).place = At<Quad>(Quad(0), Quad(1609));
    EXPECT_NE(rate_at_start<Mechanism<Quad>>(above)[3], Quad(-98) / Quad(10));
    EXPECT_EQ(rate_at_start<Mechanism<double>>(above.cast<double>())[3], -9.8);
}

TEST(Mechanism, ForceIsTheSlopeOfTheEnergy) {
    using S = Quad;
    Assembly<S> parts{
        .particles = {{S(2), At<S>(S(0.3), S(0.1))}, {S(3), At<S>(S(1.5), S(-0.7))}},
        .constraints = {},
        .forces = {Gravity<S>{}, Spring<S>{two, one, S(5), S(1)}, Spring<S>{one, At<S>(S(2), S(2)), S(3), S(4)},
                   Attraction<S>{one, two, S(2)}, Droplet<S>{At<S>(S(-1), S(1)), S(4), S(1)}}};
    Mechanism<S> model(parts);
    const auto y = model.start(parts), dydt = rate_at_start<Mechanism<S>>(parts);
    const S h(1e-10);
    for (Eigen::Index i = 0; i < 4; ++i) {
        auto up = y, down = y;
        up[i] += h;
        down[i] -= h;
        const S slope = (model.energy(up) - model.energy(down)) / (S(2) * h);
        const S mass = parts.particles[static_cast<std::size_t>(i / 2)].mass;
        EXPECT_LT(static_cast<double>(abs(S(mass * dydt[4 + i] + slope))), 5e-20);  // measured 1e-20
    }
}

TEST(Mechanism, GradientsAreThoseOfTheValues) {
    using S = Quad;
    const std::vector<Constraint<S>> all{
        Anchor<S>{two, At<S>(S(3), S(4))}, Rod<S>{one, two, S(2)}, Rod<S>{two, At<S>(S(-1), S(5)), S(3)},
        SlotLine<S>{one, At<S>(S(1), S(1)), At<S>(S(2), S(-3))}, SlotCircle<S>{two, At<S>(S(0), S(1)), S(1)}};
    std::mt19937 random(2);
    std::uniform_real_distribution<double> number(-2, 2);
    Assembly<S> parts{
        .particles = {{S(1), At<S>(S(0), S(0))}, {S(1), At<S>(S(0), S(0))}}, .constraints = {}, .forces = {}};
    for (const auto& constraint : all) {
        parts.constraints = {constraint};
        Mechanism<S> model(parts);
        State<S, Eigen::Dynamic> q(4), v(4), up(model.constraints()), here(up), down(up), slip(up), bend(up);
        for (auto* vector : {&q, &v})
            for (auto& x : *vector) x = S(number(random));
        const S h(1e-8);
        model.residual(q + h * v, up);
        model.residual(q, here);
        model.residual(q - h * v, down);
        model.constraint_velocity(q, v, slip);
        model.jdot_v(q, v, bend);
        for (Eigen::Index row = 0; row < model.constraints(); ++row) {
            const S first = (up[row] - down[row]) / (S(2) * h);
            const S second = (up[row] - S(2) * here[row] + down[row]) / (h * h);
            EXPECT_LT(static_cast<double>(abs(S(slip[row] - first))), 3e-25);   // measured 5e-26
            EXPECT_LT(static_cast<double>(abs(S(bend[row] - second))), 3e-17);  // measured 4e-18
        }
    }
}

TEST(Mechanism, ErrorsOfASlotAreDistancesFromIt) {
    // the distance of (0.6, 0.8) from the line along (4, 3) is 0.8 · 0.8 − 0.6 · 0.6, for any length of (4, 3)
    State<double, 2> q(0.6, 0.8);
    for (const double size : {1.0, 0.01}) {
        const Constraint<double> slot = SlotLine<double>{one, P(0, 0), size * P(4, 3)};
        EXPECT_NEAR(error_of(slot, q), 0.28, 2e-16);  // measured 0
    }
}

/// A zigzag chain of rods from the origin. `shuffled`: its rods are listed in random order; `looped`: two more rods
/// hold its end.
Assembly<double> zigzag(std::size_t links, bool shuffled, bool looped) {
    Assembly<double> made{.particles = {}, .constraints = {}, .forces = {Gravity<double>{}}};
    std::vector<std::size_t> order(links);
    std::iota(order.begin(), order.end(), std::size_t(0));
    for (const auto i : order)
        made.particles.push_back(
            {1 + 0.1 * static_cast<double>(i % 7), P(0.8 * static_cast<double>(i + 1), i % 2 ? 0 : 0.6)});
    if (shuffled) std::shuffle(order.begin(), order.end(), std::mt19937(3));
    for (const auto i : order) {
        const End<double> above = i == 0 ? End<double>(P(0, 0)) : End<double>(i - 1);
        made.constraints.push_back(Rod<double>{i, above, 1});
    }
    if (looped && links > 3) {
        const auto& last = made.particles.back().place;
        made.constraints.push_back(Rod<double>{links - 1, last + P(3, 4), 5});
        made.constraints.push_back(
            Rod<double>{links / 2, std::size_t{1}, (made.particles[links / 2].place - made.particles[1].place).norm()});
    }
    return made;
}

State<double, Eigen::Dynamic> inverse_masses(const Assembly<double>& parts) {
    State<double, Eigen::Dynamic> w(static_cast<Eigen::Index>(parts.particles.size()));
    for (Eigen::Index i = 0; i < w.size(); ++i) w[i] = 1 / parts.particles[static_cast<std::size_t>(i)].mass;
    return w;
}

TEST(ConstraintOrder, KeepsAFewNumbersForEachOfTenThousandLinks) {
    for (const bool looped : {false, true}) {
        const auto parts = zigzag(10000, false, looped);
        const ConstraintSet<double> set(parts.constraints, inverse_masses(parts));
        // the diagonal and its neighbours on both sides; a loop adds the distance of its ends
        EXPECT_LE(set.blank_matrix().entries(), (looped ? 8 : 4) * set.constraints()) << looped;
    }
}

TEST(ConstraintOrder, StillNamesWhatDependsOnOthers) {
    auto parts = zigzag(60, true, false);
    parts.constraints.insert(parts.constraints.begin() + 7, Anchor<double>{30, parts.particles[30].place});
    parts.constraints.push_back(Anchor<double>{30, parts.particles[30].place});
    const auto message = test::thrown_by([&] { check(parts); }).second;
    EXPECT_NE(message.find("anchor of particle 31"), std::string::npos) << message;
}

/// J(q1) M⁻¹ Jᵀ(q0) x by the model's gradients, for random x and q1 near its start q0: solve() must return x. Its
/// errors.
template <class Model, class Description>
Eigen::VectorXd errors_of_solving(Model& model, const Description& description, std::mt19937& random) {
    std::uniform_real_distribution<double> number(-0.1, 0.1);
    const auto start = Model::start(description);
    const typename Model::Half q0 = start.head(start.size() / 2);
    typename Model::Half q1 = q0, v = q0;
    typename Model::Multipliers x(model.constraints()), image(model.constraints());
    for (auto& c : q1) c += number(random);
    for (auto& c : x) c = number(random);
    v.setZero();
    model.apply_multipliers(q0, x, v);
    model.constraint_velocity(q1, v, image);
    model.solve(q1, q0, image);
    return image - x;
}

TEST(Mechanism, SolvesForMultipliersBetweenTwoPositions) {
    auto braced = four_bars();
    braced.particles.push_back({1, P(1.5, 2)});  // the factorisation adds entries to the matrix
    for (const std::size_t corner : {two, three}) braced.constraints.push_back(Rod<double>{5 - 1, corner, 1});
    std::mt19937 random(3);
    for (const auto& [parts, maximum] :
         {std::pair{braced, 2e-15}, {zigzag(40, true, false), 2e-15}, {zigzag(40, true, true), 5e-15}}) {
        Mechanism<double> model(parts);
        for (int i = 0; i < 50; ++i)
            EXPECT_LT(errors_of_solving(model, parts, random).norm(), maximum);  // measured 4e-16, 1e-16, 9e-16
    }
}

template <int N>
void expect_rods_solved(std::size_t links) {
    std::mt19937 random(5);
    for (int i = 0; i < 100; ++i) {
        const auto p = random_pendulum(random, links);
        RodChain<double, N> model(p);
        RodChain<double, Eigen::Dynamic> any(p);
        auto same = random;
        const auto errors = errors_of_solving(model, p, random);
        EXPECT_LT(errors.norm(), 5e-15) << links;  // measured 9.1e-16
        // bit-identical for a number of rods known at compile time or at run time
        if constexpr (N != Eigen::Dynamic) {
            EXPECT_EQ(errors_of_solving(any, p, same), errors) << links;
        }
    }
}

TEST(RodChain, SolvesForMultipliersBetweenTwoPositions) {
    expect_rods_solved<2>(2);
    expect_rods_solved<3>(3);
    for (const std::size_t links : {1u, 4u, 5u, 8u, 33u}) expect_rods_solved<Eigen::Dynamic>(links);
}

TEST(Mechanism, SizeIsThatOfWhatItIsMadeOf) {
    const auto size = [](const std::vector<Constraint<double>>& constraints, const std::vector<Force<double>>& forces,
                         const P& start = P(0, 0)) {
        return size_of({.particles = {{1, start}}, .constraints = constraints, .forces = forces});
    };
    EXPECT_DOUBLE_EQ(size_of(four_bars()), std::hypot(2.9, 1.2));
    EXPECT_DOUBLE_EQ(size({Rod<double>{one, P(1, 0), 1}}, {}), 1);
    EXPECT_DOUBLE_EQ(size({SlotCircle<double>{one, P(0, 3), 3}}, {}), 3);
    EXPECT_DOUBLE_EQ(size({SlotLine<double>{one, P(-3, -4), P(3, 4)}}, {}), 5);
    EXPECT_DOUBLE_EQ(size({}, {Spring<double>{one, P(0, 2), 1, 0.5}}), 2);
    EXPECT_DOUBLE_EQ(size({}, {Spring<double>{one, P(0, 2), 1, 2.5}}), 2.5);
    EXPECT_DOUBLE_EQ(size({}, {Droplet<double>{P(0, 4), 1}, Droplet<double>{P(0, 3), 1}}), 3);
    EXPECT_DOUBLE_EQ(size({Rod<double>{one, P(1, 0), 1}}, {Droplet<double>{P(0, 4), 1}}), 1);
    EXPECT_DOUBLE_EQ(size({Anchor<double>{one, P(0, 0)}}, {Gravity<double>{}}), 1);
}

}  // namespace doppel::mechanism_test
