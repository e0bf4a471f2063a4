#include "integrate/dormand_prince.hpp"
#include "integrate/support.hpp"
#include "integrate/taylor.hpp"
#include "physics/physical_chain.hpp"

#include <Eigen/LU>

#include <cmath>

namespace doppel {
namespace {

template <class Scalar>
auto after(const PhysicalPendulum<Scalar>& p, double seconds, double tolerance) {
    using Model = PhysicalChain<Scalar>;
    Model model(p);
    TaylorStepper<Model> stepper(model, Model::start(p), Scalar(tolerance));
    stepper.advance(Scalar(seconds));
    return typename Model::State(stepper.state());
}

MotionSpec spec_of(const PhysicalPendulum<double>& p, std::string_view method, long rate) {
    auto spec = stepping(Model::angles, method, p.chain, rate);
    spec.physical = p.cast<Quad>();
    spec.tolerance = Quad(1) / 1'000'000'000'000 / 1000;
    return spec;
}

TEST(PhysicalTaylor, AnEvenRodSwingsWithItsPeriod) {
    // T = 4 √(J / (m g a)) K(sin θ0/2), J = m l²/3, a = l/2
    const double length = 1.3, amplitude = 2.5;
    auto p = physical(Pendulum<double>{{0.7}, {length}, {amplitude}, {0}});
    p.center = {length / 2};
    p.inertia = {0.7 * length * length / 12};
    const double period = 4 * std::sqrt(2 * length / (3 * 9.8)) * std::comp_ellint_1(std::sin(amplitude / 2));
    const auto y = after(p, period / 4, 1e-15);
    EXPECT_NEAR(y[0], 0, 1e-14);                                     // measured 1e-15
    EXPECT_NEAR(after(p, 10 * period, 1e-15)[0], amplitude, 1e-12);  // measured 4e-16
}

/// exp(A t) y by its series over 100 equal parts of t.
Eigen::Vector4d exponential(const Eigen::Matrix4d& a, double t, Eigen::Vector4d y) {
    const double h = t / 100;
    for (int part = 0; part < 100; ++part) {
        Eigen::Vector4d term = y;
        for (int k = 1; k <= 24; ++k) {
            term = a * term * (h / k);
            y += term;
        }
    }
    return y;
}

TEST(PhysicalTaylor, SmallSwingsDecayAsInTheLinearSystem) {
    // M θ″ + B θ′ + K θ = 0 of rods with friction at the joints and on the links: exact except for the cube of the
    // amplitude
    const double small = 1e-6;
    auto p = physical(Pendulum<double>{{1.2, 0.5}, {0.8, 1.1}, {small, -2 * small}, {0, 0}});
    p.center = {0.4, 0.55};
    p.inertia = {0.06, 0.05};
    p.friction.viscous = {0.1, 0.2};
    p.friction.link_linear = {0.03, 0.01};
    const double s1 = 1.2 * 0.4 + 0.8 * 0.5, s2 = 0.5 * 0.55;
    Eigen::Matrix2d mass, friction, spring;
    mass << 0.06 + 1.2 * 0.16 + 0.64 * 0.5, 0.8 * s2, 0.8 * s2, 0.05 + 0.5 * 0.55 * 0.55;
    friction << 0.1 + 0.2 + 0.03, -0.2, -0.2, 0.2 + 0.01;
    spring << 9.8 * s1, 0, 0, 9.8 * s2;
    Eigen::Matrix4d system = Eigen::Matrix4d::Zero();
    system.topRightCorner<2, 2>().setIdentity();
    system.bottomLeftCorner<2, 2>() = -mass.inverse() * spring;
    system.bottomRightCorner<2, 2>() = -mass.inverse() * friction;
    for (const double t : {0.5, 2.0, 5.0}) {
        const Eigen::Vector4d end = exponential(system, t, Eigen::Vector4d(small, -2 * small, 0, 0));
        const auto y = after(p, t, 1e-15);
        EXPECT_NEAR(y[0] / small, end[0] / small, 1e-10) << t;  // measured 6e-13
        EXPECT_NEAR(y[1] / small, end[1] / small, 1e-10) << t;
    }
}

/// The trace of the map of small deviations from the upright over one period of the pivot.
double trace_of_period(double amplitude, double frequency) {
    double trace = 0;
    for (int i = 0; i < 2; ++i) {
        const double small = 1e-8;
        auto p = physical(Pendulum<double>{{1}, {1}, {pi + (i == 0 ? small : 0)}, {i == 1 ? small : 0}});
        p.pivot = {0, amplitude, frequency, 0};
        const auto y = after(p, 2 * pi / frequency, 1e-15);
        trace += (i == 0 ? y[0] - pi : y[y.size() / 2]) / small;
    }
    return trace;
}

/// The smallest amplitude of the pivot that stabilises the upright.
double least_amplitude(double frequency) {
    double low = 0.5 * std::sqrt(2 * 9.8) / frequency, high = 4 * low;
    for (int i = 0; i < 30; ++i) {
        const double middle = 0.5 * (low + high);
        (trace_of_period(middle, frequency) > 2 ? low : high) = middle;
    }
    return high;
}

TEST(PhysicalTaylor, TheUprightIsStableWhereKapitzaAndMathieuPredict) {
    // Kapitza: a² ν² > 2 g l. Mathieu's limit: 4 g / (l ν²) = q²/2 − 7 q⁴/128 + 29 q⁶/2304 − 68687 q⁸/18874368, q = 2 a
    // / l
    // Source  Abramowitz & Stegun, 20.2.25
    const double fast = least_amplitude(80);
    EXPECT_NEAR(fast * 80 / std::sqrt(2 * 9.8), 1, 0.01);  // measured 1.0007
    for (const double frequency : {15.0, 25.0}) {
        const double q = 2 * least_amplitude(frequency), q2 = q * q;
        const double edge =
            q2 / 2 - 7 * q2 * q2 / 128 + 29 * std::pow(q2, 3) / 2304 - 68687 * std::pow(q2, 4) / 18874368;
        EXPECT_NEAR(edge / (4 * 9.8 / (frequency * frequency)), 1, 1e-3) << frequency;  // measured 4e-5, 6e-7
    }
}

TEST(PhysicalTaylor, SeesARateThatDipsBelowZeroAndBackWithinAStep) {
    // ω = 0.99 + sin t except for the drag |ω| ω, which changes its sign twice in 0.28 s, within steps of some seconds
    PhysicalPendulum<double> p = physical(Pendulum<double>{{1}, {1}, {0}, {0.99}, 0});
    p.friction.link_quadratic = {0.01};
    p.torques = {{0, 1, 1, 0}};
    const auto end = [&](auto which, double tolerance) {
        PhysicalChain<double> model(p);
        typename decltype(which)::template Stepper<PhysicalChain<double>> stepper(
            model, PhysicalChain<double>::start(p), tolerance);
        stepper.advance(6.0);
        return stepper.state()[0];
    };
    EXPECT_NEAR(end(Taylor(), 1e-12), end(Dop853(), 1e-14), 1e-11);
}

TEST(PhysicalTaylor, AStickingJointStaysExactly) {
    auto p = physical(Pendulum<double>{{1, 1}, {1, 1}, {pi / 3, pi / 3}, {0, 0}});
    p.friction.coulomb = {3, 1};
    for (const auto* method : {"taylor", "rk4", "euler", "dopri5", "dop853", "semi-implicit-euler"}) {
        auto spec = spec_of(p, method, 10);
        spec.steps_per_sample = 3000;
        Course course(spec);
        const auto stuck = course.advance(90), later = course.advance(50);
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_EQ(later.bobs[i].omega, 0) << method;
            EXPECT_EQ(later.bobs[i].theta, stuck.bobs[i].theta) << method;
            EXPECT_LT(std::abs(stuck.bobs[i].theta), 0.2) << method;
        }
        EXPECT_LT(later.energy - later.work, p.potential_range());
    }
}

}  // namespace
}  // namespace doppel
