#include "errors.hpp"
#include "integrate/flow.hpp"
#include "integrate/gauss.hpp"
#include "integrate/rattle.hpp"
#include "integrate/runge_kutta.hpp"
#include "physics/bob.hpp"
#include "physics/canonical.hpp"
#include "physics/mechanism.hpp"
#include "physics/mechanisms.hpp"
#include "physics/pendulums.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace doppel::symplectic_test {

using Rods = RodChain<double, 2>;

/// Drag on every particle, −k v per unit of mass: a force that depends on velocity.
template <class Scalar, int N>
struct Dragged : RodChain<Scalar, N> {
    using Half = typename RodChain<Scalar, N>::Half;
    using State = typename RodChain<Scalar, N>::State;
    Scalar k = Scalar(0.5);  // 1/s

    using RodChain<Scalar, N>::RodChain;
    bool depends_on_velocity() const { return true; }
    void free_acceleration(const Half& q, const Half& v, Half& a) const {
        RodChain<Scalar, N>::free_acceleration(q, v, a);
        a -= k * v;
    }
};

TEST(Rattle, HasItsOrder) {
    EXPECT_NEAR((measured_order<Rattle, RodChain<Quad, 2>>(unequal<Quad>(2), 128)), 2, 0.002);  // measured 0.00021
    EXPECT_NEAR((measured_order<Rattle6, RodChain<Quad, 2>>(unequal<Quad>(2), 128)), 6, 0.01);  // measured 5.999
    EXPECT_NEAR((measured_order<Rattle6, RodChain<Quad, Eigen::Dynamic>>(unequal<Quad>(3), 128)), 6,
                0.005);  // measured 0.00071
}

TEST(Rattle, KeepsItsOrderUnderFriction) {
    EXPECT_NEAR((measured_order<Rattle, Dragged<Quad, 2>>(unequal<Quad>(2), 128)), 2, 0.001);  // measured 0.00016
    EXPECT_NEAR((measured_order<Rattle6, Dragged<Quad, 2>>(unequal<Quad>(2), 128)), 6, 0.01);  // measured 5.999
}

TEST(Rattle6, MeetsTheConditionsOfOrderSix) {
    // Σγ = 1 by construction, Σγ³ = Σγ⁵ = Σγ³m² = 0
    std::vector<Quad> gammas;
    Quad middle(1), at(0), third(0), fifth(0), mixed(0);
    for (const auto text : Rattle6::fractions) gammas.push_back(parse_quad(text));
    for (const auto& gamma : gammas) middle -= Quad(2) * gamma;
    gammas.push_back(middle);
    for (std::size_t i = 4; i > 0; --i) gammas.push_back(gammas[i - 1]);
    for (const auto& gamma : gammas) {
        const Quad half_way = at + gamma / Quad(2), cube = gamma * gamma * gamma;
        third += cube;
        fifth += cube * gamma * gamma;
        mixed += cube * half_way * half_way;
        at += gamma;
    }
    EXPECT_LT(std::abs(static_cast<double>(third)), 1e-33);  // measured 2e-34
    EXPECT_LT(std::abs(static_cast<double>(fifth)), 1e-33);  // measured 1e-34
    EXPECT_LT(std::abs(static_cast<double>(mixed)), 3e-34);  // measured 4e-35
    // Kahan & Li print 0.39216144400731413927925056 … 0.79854399093482996339895035
    EXPECT_LT(std::abs(static_cast<double>(Quad(gammas[0] - parse_quad("0.39216144400731413927925056")))), 1e-20);
    EXPECT_LT(std::abs(static_cast<double>(Quad(middle - parse_quad("0.79854399093482996339895035")))),
              2e-26);  // measured 3e-27
}

/// The difference between SᵀJS and J for one step of the particles, seen in angles.
template <class Which>
double symplecticity_error_on_rods(const Quad& step) {
    using Model = RodChain<Quad, 2>;
    using State = DoublePendulum<Quad>::State;
    const auto p = unequal<Quad>();
    return symplecticity_error_in_angles<DoublePendulum<Quad>>(p, [&](const State& y) {
        auto moved = p;
        moved.angle.assign({y[0], y[1]});
        moved.rate.assign({y[2], y[3]});
        const auto bobs = bobs_of_particles<Quad>(p, after<Which, Model>(moved, Model::start(moved), step, 1));
        State end = y;
        end << bobs[0].theta, bobs[1].theta, bobs[0].omega, bobs[1].omega;
        return end;
    });
}

TEST(Rattle, IsSymplectic) {
    const Quad step(0.05);
    EXPECT_LT(symplecticity_error_on_rods<Rattle>(step), 2e-22);   // measured 3e-23
    EXPECT_LT(symplecticity_error_on_rods<Rattle6>(step), 2e-22);  // measured 2e-23
    EXPECT_GT(symplecticity_error_on_rods<Rk4>(step), 1e-7);       // measured 5e-6
}

TEST(Rattle, ReturnsWhenTimeIsReversed) {
    EXPECT_LT((way_back<Rattle, Rods>(0.005, 400)), 5e-14);  // measured 6e-15
    EXPECT_LT((way_back<Rattle6, Rods>(0.02, 100)), 1e-13);  // measured 2e-14
    EXPECT_GT((way_back<Rk4, Rods>(0.02, 100)), 1e-5);       // measured 9e-5
}

TEST(Rattle, KeepsEnergyAndRodsOverAHundredThousandPeriods) {
    // the slow mode of 30/0 has a period of 1.9 s: a run of 1.9e5 s in steps of 1/20 s
    const auto errors = errors_of<Rattle, Rods>(released(30, 0), 0.05, 3'800'000);
    EXPECT_LT(errors.late, 1.3 * errors.early);  // measured 1.14
    EXPECT_LT(errors.late, 0.1);                 // measured 0.040 J
    EXPECT_LT(errors.rod, 1e-15);                // measured 2.2e-16 m
}

/// A pendulum of one link with an amplitude of 1e-5 rad, with steps of z / √(g/l).
Quad least_energy(double z, long steps, Quad& largest) {
    const Pendulum<Quad> p{{Quad(1)}, {Quad(1)}, {Quad(1e-5)}, {Quad(0)}, Quad(9.8)};
    using Model = RodChain<Quad, 1>;
    Model model(p);
    const Quad step = Quad(z) / sqrt(p.gravity);
    Rattle::Stepper<Model> stepper(model, Model::start(p), step);
    const Quad zero = -p.gravity;
    const auto above = [&] { return Quad(energy(bobs_of_particles<Quad>(p, stepper.state()), p.gravity) - zero); };
    const Quad first = above();
    Quad minimum = first;
    largest = first;
    for (long i = 0; i < steps; ++i) {
        stepper.advance(1);
        const Quad now = above();
        if (now < minimum) minimum = now;
        if (now > largest) largest = now;
    }
    largest /= first;
    return minimum / first;
}

TEST(Rattle, KeepsEnergyWithinAQuarterOfZSquared) {
    // leapfrog on the linear oscillator conserves v² + (1 − z²/4) ω² q²: the energy is lower by z²/4 at the bottom, and
    // never higher
    for (const double z : {0.1, 0.5, 1.5}) {
        Quad largest;
        const Quad minimum = least_energy(z, 2000, largest);
        EXPECT_NEAR(static_cast<double>(minimum), 1 - z * z / 4, 2e-6 * z * z);  // measured 2.1e-7 of it
        EXPECT_NEAR(static_cast<double>(largest), 1, 1e-15);                     // measured 0
    }
}

TEST(Rattle, IsStableUpToZOfTwo) {
    Quad largest;
    least_energy(2 * 0.999, 300, largest);
    EXPECT_LT(static_cast<double>(largest), 1.001);
    least_energy(2 * 1.001, 80, largest);
    EXPECT_GT(static_cast<double>(largest), 1e4);  // measured 4e5
}

TEST(Rattle, IncludesFriction) {
    // the same equations by Runge–Kutta: Baumgarte's method with α = 0 does not change them
    const auto p = unequal<double>();
    using Model = Dragged<double, 2>;
    const auto start = Model::start(p), end = after<Rattle6, Model>(p, start, 1e-3, 1000);
    Baumgarte<Model> model(p, 0);
    Rk4::Stepper<Baumgarte<Model>> other(model, start, 1e-4);
    other.advance(10'000);
    EXPECT_LT(distance(end, other.state()), 2e-13);  // measured 3e-14
    const auto lost =
        energy(bobs_of_particles<double>(p, start), p.gravity) - energy(bobs_of_particles<double>(p, end), p.gravity);
    EXPECT_GT(lost, 1);  // measured 4.6 J
}

/// The state after this number of steps of 1/rate s.
Mechanism<double>::State on_mechanism(const Assembly<double>& parts, double rate, long steps) {
    using Model = Mechanism<double>;
    return after<Rattle, Model>(parts, Model::start(parts), 1 / rate, steps);
}

TEST(Rattle, ContinuesWhereFrictionNearlyBalancesASpring) {
    // two large forces on a bead in a slot, with a bob on it: round-off is far larger than their sum
    for (const auto& [damping, bound] : {std::pair{1e3, 5e-4}, {1e4, 4e-5}}) {
        const Assembly<double> parts{
            .particles = {{1, P(3, 0)}, {0.7, P(3.3, -1)}},
            .constraints = {SlotLine<double>{0, P(3, 0), P(1, 0)}, Rod<double>{1, std::size_t(0), std::hypot(0.3, 1)}},
            .forces = {Gravity<double>{}, Spring<double>{0, P(-1.6, 0), 1e4, 1.6, damping}}};
        check(parts);
        const auto fast = on_mechanism(parts, 60'000, 60'000), finer = on_mechanism(parts, 240'000, 240'000);
        EXPECT_LT(distance(fast, finer), bound) << damping;  // measured 4.9e-5, 3.4e-6
    }
}

TEST(Rattle, FailsIfFrictionIsTooStrong) {
    const auto p = unequal<double>();
    using Model = Dragged<double, 2>;
    Model model(p);
    model.k = 1e4;
    Rattle::Stepper<Model> stepper(model, Model::start(p), 0.001);
    EXPECT_THROW(stepper.advance(1), Error);
}

TEST(Rattle, ContinuesWhereOnlyRoundingIsLeft) {
    // three links whose run failed after 206 701 steps, at 1.3e-15 m²
    const auto rad = [](std::vector<double> degrees) {
        for (auto& value : degrees) value = radians(value);
        return degrees;
    };
    const Pendulum<double> p{{0.359, 1.644, 2.049},
                             {1.829, 2.225, 1.094},
                             rad({101.181, -93.94, 74.502}),
                             rad({-99.631, 102.2, -181.826}),
                             9.8};
    using Chain = RodChain<double, 3>;
    EXPECT_LT((errors_of<Rattle, Chain>(p, 1.0 / 12000, 360'000).rod), 1e-14);  // measured 6.7e-16 m
    EXPECT_LT((errors_of<Rattle6, Chain>(p, 1.0 / 12000, 12'000).rod), 1e-14);  // measured 6.7e-16 m
}

TEST(Rattle, ContinuesInRandomScenes) {
    std::mt19937 random(20);
    const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    for (int i = 0; i < 60; ++i) {
        Pendulum<double> p{{}, {}, {}, {}, 9.8};
        const int links = std::uniform_int_distribution(1, 4)(random);
        for (int k = 0; k < links; ++k) {
            p.mass.push_back(std::exp(between(-4, 1)));
            p.length.push_back(between(0.2, 2.5));
            p.angle.push_back(between(-pi, pi));
            p.rate.push_back(between(-4, 4));
        }
        using Chain = RodChain<double, Eigen::Dynamic>;
        EXPECT_LT((errors_of<Rattle, Chain>(p, 1.0 / 6000, 12'000).rod), 1e-14) << i;  // measured 1.0e-15 m
        EXPECT_LT((errors_of<Rattle6, Chain>(p, 1.0 / 1200, 2'000).rod), 1e-14) << i;  // measured 1.2e-15 m
    }
}

/// The same chain with its pivot elsewhere.
Assembly<double> hung_at(const Pendulum<double>& p, const Place<double>& pivot) {
    auto parts = parts_of(p);
    for (auto& particle : parts.particles) particle.place += pivot;
    std::get<Rod<double>>(parts.constraints[0]).b = pivot;
    for (std::size_t k = 0; k < parts.constraints.size(); ++k) {
        auto& rod = std::get<Rod<double>>(parts.constraints[k]);
        const auto above = k == 0 ? pivot : parts.particles[k - 1].place;
        rod.length = (parts.particles[k].place - above).norm();
    }
    return parts;
}

TEST(Rattle, ContinuesFarFromTheOrigin) {
    const auto p = unequal<double>(3);
    for (const double far : {0.0, 20.0, 1e3, 1e6}) {
        const auto parts = hung_at(p, Place<double>(far, -0.75 * far));
        EXPECT_LT(Mechanism<double>(parts).length_error(on_mechanism(parts, 6000, 12'000)), 4e-16 * (2.5 + far))
            << far;  // measured 4e-16, 4e-15, 1e-13, 1e-10 m
    }
    // a bead released at the origin, on a rod with its other end elsewhere
    const Assembly<double> bead{
        .particles = {{1, P(0, 0)}}, .constraints = {Rod<double>{0, P(1, 0), 1}}, .forces = {Gravity<double>{}}};
    EXPECT_LT(Mechanism<double>(bead).length_error(on_mechanism(bead, 6000, 12'000)), 1e-15);  // measured 1.1e-16 m
}

TEST(Rattle, KeepsTheRodsOfALightFirstMass) {
    // aligned links: the condition number of J M⁻¹ Jᵀ is 4 m2 / m1, and m1 oscillates like a bead on a string under the
    // weight of m2, at ω = √(2 m2 g / (l m1)): steps are stable below 2 / ω
    for (const auto& [light, maximum] : {std::pair{1e-3, 1e-5}, {1e-6, 3e-9}, {1e-9, 5e-13}, {1e-12, 2e-13}}) {
        auto p = released(30, 30);
        p.mass[0] = light;
        const double fastest = std::sqrt(2 * p.gravity / light);
        const auto errors = errors_of<Rattle, Rods>(p, 0.1 / fastest, 10'000);
        EXPECT_LT(errors.rod, 1e-15) << light;     // measured 2.2e-16 m
        EXPECT_LT(errors.late, maximum) << light;  // measured 1.8e-6, 3.2e-10, 9e-14, 3e-14 J
    }
    auto p = released(30, 31);
    p.mass[0] = 1e-9;
    EXPECT_THROW((errors_of<Rattle, Rods>(p, 1e-4, 10'000)), Error);
}

using Angles = DoublePendulum<double>;

TEST(Gauss, IsSymplectic) {
    const auto p = unequal<Quad>();
    const Quad step(0.1);
    EXPECT_LT((symplecticity_error<Gauss4, DoublePendulum<Quad>>(p, step)), 2e-22);  // measured 2e-23
    EXPECT_LT((symplecticity_error<Gauss6, DoublePendulum<Quad>>(p, step)), 2e-22);  // measured 2e-23
    EXPECT_LT((symplecticity_error<Gauss6, AngleChain<Quad, 2>>(p, step)), 2e-22);   // measured 2.7e-23
    EXPECT_GT((symplecticity_error<Rk4, DoublePendulum<Quad>>(p, step)), 1e-6);      // measured 3e-4
}

TEST(Gauss, ReturnsWhenTimeIsReversed) {
    EXPECT_LT((way_back<Gauss4, Angles>(0.02, 100)), 5e-15);  // measured 9.4e-16
    EXPECT_LT((way_back<Gauss6, Angles>(0.02, 100)), 1e-15);  // measured 1.9e-16
    EXPECT_GT((way_back<Rk4, Angles>(0.02, 100)), 1e-6);      // measured 5e-5
}

TEST(Gauss, KeepsEnergyOverAHundredThousandPeriods) {
    // the slow mode of 30/0 has a period of 1.9 s: a run of 1.9e5 s in steps of 0.1 s
    const auto gauss = errors_of<Gauss4, Angles>(released(30, 0), 0.1, 1'900'000);
    EXPECT_LT(gauss.late, 1.5 * gauss.early);  // measured 1.25
    EXPECT_LT(gauss.late, 2e-3);               // measured 9e-4 J
}

TEST(Gauss, HasNoEnergyDriftFromRounding) {
    // with steps so short that truncation is negligible, the rest is round-off, which must grow as a random walk
    const auto errors = errors_of<Gauss6, Angles>(released(30, 0), 1.0 / 512, 1'000'000);
    EXPECT_LT(errors.late, 4e-14);  // measured 7e-15 J of 30; 3e-13 without compensation, 2e-13 with a loose iteration
}

TEST(Symplectic, MethodsFailIfTheStepIsTooLong) {
    const auto expect_failure = [](const char* method, const char* step, const auto& run) {
        const auto [code, text] = test::thrown_by(run);
        EXPECT_EQ(code, ExitCode::method_failed);
        EXPECT_TRUE(text.starts_with(fmt::format("{}: step ", method))) << text;
        EXPECT_NE(text.find(fmt::format("choose a smaller step_s than {}", step)), std::string::npos) << text;
    };
    expect_failure("rattle", "1", [] { errors_of<Rattle, Rods>(released(150, 90), 1.0, 1000); });
    const auto p = unequal<double>();
    expect_failure("gauss6", "3", [&] { after<Gauss6, Angles>(p, Angles::start(p), 3.0, 10); });
}

}  // namespace doppel::symplectic_test
