#include "physics/physical_rods.hpp"

#include "allocations.hpp"
#include "base/error.hpp"
#include "numeric/quad.hpp"
#include "physics/pendulums.hpp"
#include "physics/physical_chain.hpp"
#include "physics/physical_pendulums.hpp"
#include "physics/rod_chain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace doppel {
namespace physical_rods_test {

template <class Vector>
double largest(const Vector& v) {
    return static_cast<double>(v.cwiseAbs().maxCoeff());
}

TEST(PhysicalRods, OfPointMassesAtTheEndsAreTheRodChain) {
    std::mt19937 random(1);
    for (std::size_t links = 1; links <= 8; ++links) {
        const auto p = random_pendulum(random, links);
        PhysicalRods<double> bodies(physical(p));
        RodChain<double, Eigen::Dynamic> points(p);
        const auto y = RodChain<double, Eigen::Dynamic>::start(p);
        EXPECT_EQ(PhysicalRods<double>::start(physical(p)), y);
        State<double, Eigen::Dynamic> a = y, b = y;
        bodies.rate(y, a);
        points.rate(y, b);
        EXPECT_LT(largest((a - b).eval()) / largest(b), 7e-15) << links;  // measured 7e-16
    }
}

/// dydt of the ends from that of the angles.
State<Quad, Eigen::Dynamic> ends_of_angles(const PhysicalPendulum<Quad>& p, const State<Quad, Eigen::Dynamic>& y,
                                           const State<Quad, Eigen::Dynamic>& dydt) {
    const PhysicalLayout in(p, static_cast<Eigen::Index>(p.chain.links())), out(p, 2 * in.coordinates);
    State<Quad, Eigen::Dynamic> made = State<Quad, Eigen::Dynamic>::Zero(2 * out.half);
    const PivotPlace<Quad> pivot(p.pivot, in.time_of(y));
    Planar<Quad> v = pivot.velocity, a = pivot.acceleration;
    for (Eigen::Index k = 0; k < in.coordinates; ++k) {
        const SinCos<Quad> turn(y[k]);
        const Planar<Quad> along{turn.sin, Quad(-turn.cos)}, across{turn.cos, turn.sin};
        const Quad l = p.chain.length[static_cast<std::size_t>(k)], omega = y[in.half + k];
        v = v + across * Quad(l * omega);
        a = a + across * Quad(l * dydt[in.half + k]) - along * Quad(l * omega * omega);
        made[2 * k] = v.x, made[2 * k + 1] = v.y;
        made[out.half + 2 * k] = a.x, made[out.half + 2 * k + 1] = a.y;
    }
    if (in.time >= 0) made[out.time] = Quad(1);
    if (in.work >= 0) made[out.work] = dydt[in.work], made[out.half + out.work] = dydt[in.half + in.work];
    return made;
}

TEST(PhysicalRods, MoveLikeTheChainInAngles) {
    for (std::size_t links = 1; links <= 6; ++links)
        for (const auto& p : {bodies<Quad>(links), driven_bodies<Quad>(links)}) {
            PhysicalChain<Quad> angles(p);
            PhysicalRods<Quad> rods(p);
            const auto in_angles = PhysicalChain<Quad>::start(p);
            const auto y = PhysicalRods<Quad>::start(p);
            State<Quad, Eigen::Dynamic> rate_of_angles = in_angles, rate = y;
            angles.rate(in_angles, rate_of_angles);
            rods.rate(y, rate);
            const auto expected = ends_of_angles(p, in_angles, rate_of_angles);
            EXPECT_LT(largest((rate - expected).eval()), 1e-31) << links;  // measured 1.1e-32
        }
}

TEST(PhysicalRods, WithLightEndsLoseNoDigits) {
    // a light mass between others, with bodies and without, beside the same in quad
    for (const double light : {1e-3, 1e-6, 1e-9})
        for (const std::size_t where : {0u, 1u, 2u})
            for (const bool points : {true, false}) {
                auto p = bodies<double>(4);
                if (points) p = physical(p.chain);
                p.chain.mass[where] *= light;
                p.inertia[where] *= light;
                PhysicalRods<double> model(p);
                PhysicalRods<Quad> truth(p.cast<Quad>());
                const auto y = PhysicalRods<double>::start(p);
                State<double, Eigen::Dynamic> rate = y;
                const State<Quad, Eigen::Dynamic> same = y.cast<Quad>();
                State<Quad, Eigen::Dynamic> expected = same;
                model.rate(y, rate);
                truth.rate(same, expected);
                EXPECT_LT(largest((rate.cast<Quad>() - expected).eval()) / largest(expected), 1e-14)
                    << light;  // measured 1.2e-15
            }
}

/// A state near the constraints, but not on them.
template <class Scalar>
State<Scalar, Eigen::Dynamic> near_start(const PhysicalPendulum<Scalar>& p, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> a_little(-0.05, 0.05);
    State<Scalar, Eigen::Dynamic> y = PhysicalRods<Scalar>::start(p);
    for (auto& value : y) value += Scalar(a_little(random));
    y[y.size() - 2] = Scalar(1);  // the rate of time
    return y;
}

TEST(PhysicalRods, SolveWhatPullingDoes) {
    // x = J(q1) M⁻¹ Jᵀ(q0) λ gives λ back, at two places
    const auto p = driven_bodies<Quad>(5);
    PhysicalRods<Quad> model(p);
    const auto half = model.layout.half;
    const State<Quad, Eigen::Dynamic> q0 = near_start(p, 2).head(half), q1 = near_start(p, 3).head(half);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> any(-3, 3);
    State<Quad, Eigen::Dynamic> lambda(5), x(5), v = State<Quad, Eigen::Dynamic>::Zero(half);
    for (auto& value : lambda) value = Quad(any(random));
    model.pull(q0, lambda, v);
    model.constraint_velocity(q1, v, x);
    model.solve(q1, q0, x);
    EXPECT_LT(largest((x - lambda).eval()), 1e-32);  // measured 1.2e-33
}

TEST(PhysicalRods, KnowTheSlopesOfTheirConstraints) {
    // C along a line through (q, t), by differences: C′ = J v, C″ = J̇ v
    const auto p = driven_bodies<Quad>(4);
    PhysicalRods<Quad> model(p);
    const auto y = near_start(p, 5);
    const auto half = model.layout.half;
    const State<Quad, Eigen::Dynamic> q = y.head(half), v = y.tail(half);
    const Quad h(1e-8);
    State<Quad, Eigen::Dynamic> less(4), here(4), more(4), expected(4);
    model.residual(q - h * v, less);
    model.residual(q, here);
    model.residual(q + h * v, more);
    model.constraint_velocity(q, v, expected);
    EXPECT_LT(largest(((more - less) / (Quad(2) * h) - expected).eval()), 5e-15);  // measured 4.5e-16
    model.jdot_v(q, v, expected);
    EXPECT_LT(largest(((more - Quad(2) * here + less) / (h * h) - expected).eval()), 2e-14);  // measured 2.0e-15
}

TEST(PhysicalRods, TellTheWorkOfThePivot) {
    // the power is the rate of the energy: on the constraints, along the motion, by differences
    for (std::size_t links = 1; links <= 3; ++links) {
        const auto p = driven_bodies<Quad>(links);
        PhysicalRods<Quad> model(p);
        const auto& layout = model.layout;
        const auto y = PhysicalRods<Quad>::start(p);
        State<Quad, Eigen::Dynamic> dydt = y;
        model.rate(y, dydt);
        const auto energy_at = [&](const Quad& h) {
            const State<Quad, Eigen::Dynamic> at = y + h * dydt;
            Bobs<Quad> bobs;
            for (std::size_t k = 0; k < links; ++k) {
                const auto q = 2 * static_cast<Eigen::Index>(k), v = layout.half + q;
                bobs.push_back({p.chain.mass[k], at[q], at[q + 1], at[v], at[v + 1]});
            }
            const PivotPlace<Quad> pivot(p.pivot, h);
            const auto parts =
                energies(p, bobs, {Quad(0), pivot.place.x, pivot.place.y, pivot.velocity.x, pivot.velocity.y});
            return Quad(parts.kinetic + parts.potential);
        };
        const Quad h(1e-11);
        const Quad power = (energy_at(h) - energy_at(-h)) / (Quad(2) * h);
        EXPECT_LT(static_cast<double>(abs(Quad(power - dydt[layout.half + layout.work]))), 5e-20)
            << links;  // measured 6e-21
    }
}

TEST(PhysicalRods, HangStillSideways) {
    auto p = bodies<double>(3);
    for (auto& angle : p.chain.angle) angle = 0;
    for (auto& rate : p.chain.rate) rate = 0;
    PhysicalRods<double> model(p);
    const auto y = PhysicalRods<double>::start(p);
    State<double, Eigen::Dynamic> dydt = y;
    model.rate(y, dydt);
    for (Eigen::Index x = 6; x < 12; x += 2) EXPECT_EQ(dydt[x], 0);
    EXPECT_LT(largest(dydt), 3e-14);  // measured 3.6e-15
}

std::string fault_of(const PhysicalPendulum<double>& p) {
    try {
        PhysicalRods<double> model(p);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::bad_input);
        return error.what();
    }
    return "no fault";
}

TEST(PhysicalRods, RefuseJointsThatStick) {
    auto p = bodies<double>(2);
    EXPECT_EQ(fault_of(p), "no fault");
    p.friction.coulomb = {0, 0.1};
    EXPECT_NE(fault_of(p).find("Coulomb"), std::string::npos);
}

TEST(PhysicalRods, RefuseEndsWithoutMass) {
    auto p = bodies<double>(3);  // the mass of link 2 at its joint, that of link 3 at its end
    p.center = {0.5, 0, p.chain.length[2]};
    p.inertia = {0.1, 0, 0};
    EXPECT_EQ(fault_of(p).rfind("the end of link 2 moves no mass", 0), 0u) << fault_of(p);
    p.inertia[1] = 1e-3;
    EXPECT_EQ(fault_of(p), "no fault");
}

TEST(PhysicalRods, AskForNoMemory) {
    const auto p = driven_bodies<double>(5);
    PhysicalRods<double> model(p);
    const auto y = PhysicalRods<double>::start(p);
    State<double, Eigen::Dynamic> dydt = y;
    const long before = allocations();
    for (int i = 0; i < 10; ++i) model.rate(y, dydt);
    EXPECT_EQ(allocations() - before, 0);
}

}  // namespace physical_rods_test
}  // namespace doppel
