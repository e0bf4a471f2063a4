#include "integrate/taylor.hpp"

#include "errors.hpp"
#include "integrate/flow.hpp"
#include "integrate/runge_kutta.hpp"
#include "integrate/support.hpp"
#include "numeric/quad.hpp"
#include "physics/bob.hpp"
#include "physics/mechanism.hpp"
#include "physics/mechanisms.hpp"
#include "physics/pendulums.hpp"
#include "physics/physical_chain.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <unsupported/Eigen/MatrixFunctions>

#include <cmath>
#include <map>
#include <tuple>

namespace doppel::taylor_test {

using namespace counted;

/// The largest difference of the angles.
template <class One, class Other>
double angle_error(const One& one, const Other& other) {
    double worst = 0;
    for (Eigen::Index i = 0; i < one.size() / 2; ++i)
        worst = greater(worst, std::abs(static_cast<double>(Quad(one[i]) - Quad(other[i]))));
    return worst;
}

/// A problem, the sensitivity of its end to its start, and its end to about 27 digits.
template <int N>
struct Problem {
    Pendulum<double> pendulum;
    double seconds, sensitivity;

    const State<Quad, 2 * N>& end() const {
        static std::map<std::vector<double>, State<Quad, 2 * N>> known;
        auto [found, is_new] = known.try_emplace(pendulum.angle);
        if (is_new) found->second = end_of<Taylor, AngleChain<Quad, N>>(pendulum.cast<Quad>(), seconds, 1e-30);
        return found->second;
    }
    template <class Which = Taylor, class Model = AngleChain<double, N>, class... More>
    double error(double tolerance, More... order) const {
        return angle_error(end_of<Which, Model>(pendulum, seconds, tolerance, order...), end());
    }
};
const Problem<2> p1{from_rest({90, 90}), 10, 80}, p2{from_rest({30, 0}), 60, 21}, p3{from_rest({150, 90}), 5, 320};
const Problem<3> p4{from_rest({120, 0, 0}), 5, 1040};

/// Errors of angles are at most factor · tolerance; of the Taylor method, three times the sensitivity.
template <class Model, int N>
void keeps_to_tolerance(const Problem<N>& problem, double of_dop853, double of_dopri5) {
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14})
        EXPECT_LT(problem.error(tolerance), 3 * problem.sensitivity * tolerance) << tolerance;  // measured ≤ 0.9
    for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13}) {
        EXPECT_LT((problem.template error<Dop853, Model>(tolerance)), of_dop853 * tolerance) << tolerance;
        EXPECT_LT((problem.template error<Dopri5, Model>(tolerance)), of_dopri5 * tolerance) << tolerance;
    }
    EXPECT_LT(problem.error(1e-15), 2e-15 * problem.sensitivity);  // measured 6e-14, 3e-15, 7e-15, 1e-13
}

TEST(Tolerance, IsMet) {
    // the factors follow the sensitivities, and the length of the second motion; measured 170, 1500, 210, 1200, 2600,
    // 3700, 1000, 3300
    keeps_to_tolerance<DoublePendulum<double>>(p1, 400, 3000);
    keeps_to_tolerance<DoublePendulum<double>>(p2, 500, 2500);
    keeps_to_tolerance<DoublePendulum<double>>(p3, 5000, 8000);
    keeps_to_tolerance<AngleChain<double, 3>>(p4, 2000, 7000);
}

TEST(Taylor, HandlesVanishingCoefficientsAtEveryOrder) {
    // from rest at 90/90, three of four coefficients are zero, whatever the order
    for (int order : {8, 9, 10, 11, 12, 13, 14, 15, 16, 20, 24})
        for (double tolerance : {1e-6, 1e-9})
            EXPECT_LT(p1.error(tolerance, order), 80 * tolerance) << order;  // measured ≤ 42 tolerance
}

TEST(Taylor, ReturnsAfterTheExactPeriod) {
    // after a quarter of it the pendulum is at the bottom
    using Model = AngleChain<Quad, Eigen::Dynamic>;
    struct Case {
        double amplitude, bottom, back;  // °; allowed errors of the angle there, rad
    };
    // measured 2.5e-32, 7.5e-31, 5.8e-31, 1.3e-30 and 1.2e-32, 7.2e-31, 1.2e-29, 2.4e-27
    for (const auto& [amplitude, at_bottom, at_end] :
         {Case{5.0, 2e-31, 1e-31}, Case{90.0, 5e-30, 5e-30}, Case{170.0, 5e-30, 1e-28}, Case{179.9, 7e-30, 2e-26}}) {
        const auto p = from_rest({amplitude}).cast<Quad>();
        const Quad period = exact_period(p);
        const Quad bottom = end_of<Taylor, Model>(p, Quad(period / Quad(4)), Quad(1e-28))[0];
        EXPECT_LT(std::abs(static_cast<double>(bottom)), at_bottom) << amplitude;
        const auto back = end_of<Taylor, Model>(p, period, Quad(1e-28));
        EXPECT_LT(std::abs(static_cast<double>(Quad(back[0] - p.angle[0]))), at_end) << amplitude;
    }
}

TEST(Taylor, HoldsInsideEveryStep) {
    // about twenty samples per step, against quad
    const auto p = p1.pendulum;
    AngleChain<double, 2> model(p);
    AngleChain<Quad, 2> exact_model(p.cast<Quad>());
    TaylorStepper stepper(model, AngleChain<double, 2>::start(p), 1e-13);
    TaylorStepper exact(exact_model, AngleChain<Quad, 2>::start(p.cast<Quad>()), Quad(1e-25));
    for (int i = 0; i < 600; ++i) {
        stepper.advance(0x1p-8);
        exact.advance(Quad(0x1p-8));
        for (int k = 0; k < 4; ++k)
            ASSERT_NEAR(stepper.state()[k], static_cast<double>(exact.state()[k]), 1e-12);  // measured 2e-13
    }
    EXPECT_EQ(stepper.evaluations(), stepper.steps() * stepper.order());
}

TEST(Taylor, LongChainsFollowRungeKutta) {
    for (const auto& [links, steps, maximum] : {std::tuple{8, 4000L, 2e-14}, {64, 3000L, 3e-13}}) {
        auto p = uneven(static_cast<std::size_t>(links));
        for (auto& l : p.length) l /= links;
        for (auto& rate : p.rate) rate = 0;
        using Model = AngleChain<double, Eigen::Dynamic>;
        const double step = 5e-6;
        const auto expected = after<Rk4, Model>(p, Model::start(p), step, steps);
        const auto end = end_of<Taylor, Model>(p, step * static_cast<double>(steps), 1e-13);
        ASSERT_GT((expected - Model::start(p)).head(links).cwiseAbs().maxCoeff(), 0.01);
        EXPECT_LT(angle_error(expected, end), maximum) << links;  // measured 3e-15, 5e-14
    }
}

TEST(Taylor, KeepsRodsOfAProjectedModel) {
    using Model = Projected<RodChain<double, Eigen::Dynamic>>;
    const auto p = p1.pendulum;
    const auto bobs = bobs_of_particles(p, end_of<Taylor, Model>(p, 10.0, 1e-12));
    const auto expected = bobs_of_angles(p, p1.end().cast<double>().eval());
    EXPECT_LT(length_error(p, bobs), 4e-16);                                           // m; measured 0
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(bobs[i].x, expected[i].x, 5e-11);  // measured 8e-12
    static_assert(!HasSeries<Baumgarte<RodChain<double, 2>>>);
}

// Errors.

template <class Model = AngleChain<double, 2>>
std::string failure_of(const Pendulum<double>& p, double seconds = 1) {
    const auto [code, said] = test::thrown_by([&] { end_of<Taylor, Model>(p, seconds, 1e-12); });
    EXPECT_EQ(code, ExitCode::method_failed);
    return said;
}

TEST(Taylor, FailsIfTheMotionDiverges) {
    auto p = p1.pendulum;
    p.rate = {1e200, -1e200};
    EXPECT_TRUE(failure_of(p).starts_with("taylor: coefficient"));
    p.rate = {std::nan(""), 0};
    failure_of(p);
    failure_of<AngleChain<double, Eigen::Dynamic>>(p);
    p.rate = {1e9, -3e9};
    EXPECT_TRUE(failure_of(p, 1e9).starts_with("taylor: the large"));
}

TEST(Taylor, KeepsTheDigitsOfALightMass) {
    Pendulum<double> p{{1e-5, 1}, {1, 1}, {1, 1.001}, {0, 0}, 9.8};
    for (const std::size_t links : {2u, 3u}) {
        if (links == 3) p = {{1e-5, 1, 0.5}, {1, 1, 0.7}, {1, 1.001, 0.5}, {0, 0, 0}, 9.8};
        const auto end = [&](const char* tolerance, Precision precision) {
            auto spec = stepping(Model::angles, "taylor", p, 1);
            spec.sample_interval = {2, 1};
            spec.tolerance = parse_quad(tolerance);
            spec.precision = precision;
            return Course(spec).advance(1);
        };
        const auto found = end("1e-15", Precision::in_double), truth = end("1e-18", Precision::in_quad);
        for (std::size_t i = 0; i < links; ++i) EXPECT_NEAR(found.bobs[i].theta, truth.bobs[i].theta, 4e-12) << links;
    }
}

// In the limit of a weightless upper mass, the lower one falls freely, and bounces elastically where the rods are in line.
TEST(Taylor, FollowsAFallingMassThroughABounceInQuad) {
    constexpr double g = 9.8, x = 0.3, y = -0.4;  // m: the place of the lower mass
    const double reach = std::hypot(x, y), bend = std::acos(reach / 2), middle = std::atan2(x, -y);
    const double fallen = std::sqrt((std::sqrt(4 - x * x) + y) * 2 / g), left = 1 - fallen;  // s
    const double down = y - g * fallen * fallen / 2, into = -g * fallen * down / 4;          // velocity · place / 4
    for (const double mass : {1e-9, 1e-14}) {
        auto spec = stepping(Model::angles, "taylor",
                             Pendulum<double>{{mass, 1}, {1, 1}, {middle + bend, middle - bend}, {0, 0}, g}, 1);
        spec.sample_interval = {1, 1};
        spec.tolerance = parse_quad("1e-24");
        spec.precision = Precision::in_quad;
        const auto end = Course(spec).advance(1).bobs[1];
        EXPECT_NEAR(end.x, x - 2 * into * x * left, 1e2 * std::sqrt(mass)) << mass;
        EXPECT_NEAR(end.y, down + (-g * fallen - 2 * into * down) * left - g * left * left / 2, 1e2 * std::sqrt(mass));
    }
}

using OnMechanism = Mechanism<Quad>;

template <class S>
auto end_by_series(const Assembly<S>& parts, const S& seconds, const S& tolerance) {
    return end_of<Taylor, Mechanism<S>>(parts, seconds, tolerance);
}

TEST(TaylorMechanism, FollowsDop853) {
    const auto parts = of_everything();
    check(parts);
    const auto truth = end_by_series(parts.cast<Quad>(), Quad(3), Quad(1e-22));
    const auto expected = end_of<Dop853, OnMechanism>(parts.cast<Quad>(), Quad(3), Quad(1e-18));
    EXPECT_GT(distance(truth, Mechanism<Quad>::start(parts.cast<Quad>())), 1);
    EXPECT_LT(distance(truth, expected), 7e-17);  // measured 1.3e-17
    for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
        const OnMechanism::State end = end_by_series(parts, 3.0, tolerance).cast<Quad>();
        EXPECT_LT(distance(end, truth), 300 * tolerance) << tolerance;  // measured at most 86
    }
}

TEST(TaylorMechanism, OrbitClosesAfterKeplersPeriod) {
    // released at the apocentre of an ellipse, semi-axis a, eccentricity e: T = 2π √(a³ / GM), v² = GM/a (1−e)/(1+e)
    for (const double e : {0.0, 0.5, 0.9}) {
        const Quad a(2), strength(3), eccentricity(e);
        const Quad far = a * (Quad(1) + eccentricity);
        const Quad speed = sqrt(Quad(strength / a * (Quad(1) - eccentricity) / (Quad(1) + eccentricity)));
        Assembly<Quad> about_a_place, about_each_other;
        about_a_place.particles.push_back({Quad(5), At<Quad>(far + Quad(1), Quad(1)), At<Quad>(Quad(0), speed)});
        about_a_place.forces.push_back(Droplet<Quad>{At<Quad>(Quad(1), Quad(1)), strength, Quad(1)});
        for (const double mass : {1.0, 2.0}) {
            const Quad share = Quad(mass == 1 ? -2 : 1) / Quad(3);
            about_each_other.particles.push_back(
                {Quad(mass), At<Quad>(share * far, Quad(0)), At<Quad>(Quad(0), share * speed)});
        }
        about_each_other.forces.push_back(Attraction<Quad>{one, two, Quad(1)});
        const Quad period = Quad(2) * pi_of<Quad>() * sqrt(Quad(a * a * a / strength));
        for (const auto& parts : {about_a_place, about_each_other}) {
            const auto end = end_by_series(parts, period, Quad(1e-31));
            EXPECT_LT(distance(end, Mechanism<Quad>::start(parts)), 2e-31) << e;  // measured 3e-32
        }
    }
}

TEST(TaylorMechanism, KeepsEnergyAndRods) {
    auto parts = of_everything();
    for (auto& force : parts.forces)
        if (auto* spring = std::get_if<Spring<double>>(&force)) spring->damping = 0;
    const auto exact = parts.cast<Quad>();
    Mechanism<Quad> model(exact);
    const auto start = model.start(exact), end = end_by_series(exact, Quad(1), Quad(1e-30));
    EXPECT_LT(std::abs(static_cast<double>(Quad(model.energy(end) - model.energy(start)))),
              1e-31);  // J; measured 1.2e-32
    const Quad moved = model.length_error(end) - model.length_error(start);
    EXPECT_LT(std::abs(static_cast<double>(moved)), 3e-33);  // m; measured 4e-34, of the initial 2e-16 of doubles
}

std::string error_of_mechanism(const Assembly<double>& parts, double seconds, double tolerance) {
    const auto [code, said] = test::thrown_by([&] { end_by_series(parts, seconds, tolerance); });
    EXPECT_TRUE(code == ExitCode::method_failed || code == ExitCode::done);
    return said;
}

TEST(TaylorMechanism, FailsIfBodiesCollide) {
    const Assembly<double> parts{
        .particles = {{1, P(0, 0)}, {1, P(1, 0)}}, .constraints = {}, .forces = {Attraction<double>{one, two, 1}}};
    EXPECT_EQ(error_of_mechanism(parts, 2, 1e-12).substr(0, 8), "taylor: ");
}

TEST(TaylorMechanism, PassesThroughTheMiddleOfASpring) {
    // straight through the centre, where the force jumps: x = 1 − 9 sin t, then x = cos τ + v sin τ − 1
    const Assembly<double> parts{
        .particles = {{1, P(1, 0), P(-9, 0)}}, .constraints = {}, .forces = {Spring<double>{one, P(0, 0), 1, 1}}};
    const double tau = 2 - std::asin(1 / 9.0), v = -9 * std::sqrt(1 - 1 / 81.0);
    EXPECT_NEAR(end_by_series(parts, 2.0, 1e-12)[0], std::cos(tau) + v * std::sin(tau) - 1,
                3e-11);  // measured 5e-12
}

TEST(TaylorMechanism, FailsIfTheMotionDiverges) {
    auto parts = four_bars();
    for (const double speed : {1e200, std::nan("")}) {
        parts.forces = {Gravity<double>{speed}};
        EXPECT_NE(error_of_mechanism(parts, 1, 1e-12), "no error");
    }
}

TEST(TaylorMechanism, StaysInEquilibrium) {
    const Assembly<double> loose{
        .particles = {{1, P(2, 0)}}, .constraints = {}, .forces = {Spring<double>{one, P(1, 0), 1, 1}}};
    EXPECT_EQ(end_by_series(loose, 1000.0, 1e-12), Mechanism<double>::start(loose));
}

TEST(TaylorMechanism, FallsAndHangsFromRest) {
    // gravity only; a spring released at its rest length, or with zero length
    Assembly<double> parts{.particles = {{1, P(0, 0)}}, .constraints = {}, .forces = {Gravity<double>{}}};
    EXPECT_NEAR(end_by_series(parts, 2.0, 1e-12)[1], -0.5 * 9.8 * 4, 1e-14);  // measured 0
    for (const double length : {0.0, 1.0}) {
        parts.forces = {Gravity<double>{}, Spring<double>{one, P(0, length), 4, length}};
        EXPECT_NEAR(end_by_series(parts, 2.0, 1e-12)[1], 9.8 / 4 * (std::cos(2 * 2.0) - 1), 2e-12)
            << length;  // measured 3.5e-13
    }
}

/// The state after `seconds`.
auto state_after(const PhysicalPendulum<double>& p, double seconds) {
    return end_of<Taylor, PhysicalChain<double>>(p, seconds, 1e-15);
}

TEST(PhysicalTaylor, AnEvenRodSwingsWithItsPeriod) {
    // T = 4 √(J / (m g a)) K(sin θ0/2), J = m l²/3, a = l/2
    const double length = 1.3, amplitude = 2.5;
    const auto p = rods({{0.7}, {length}, {amplitude}, {0}, 9.8});
    const double period = 4 * std::sqrt(2 * length / (3 * 9.8)) * std::comp_ellint_1(std::sin(amplitude / 2));
    const auto y = state_after(p, period / 4);
    EXPECT_NEAR(y[0], 0, 1e-14);                                    // measured 1e-15
    EXPECT_NEAR(state_after(p, 10 * period)[0], amplitude, 1e-12);  // measured 4e-16
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
        const Eigen::Vector4d end = (system * t).exp() * Eigen::Vector4d(small, -2 * small, 0, 0);
        const auto y = state_after(p, t);
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
        const auto y = state_after(p, 2 * pi / frequency);
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
    using Model = PhysicalChain<double>;
    EXPECT_NEAR((end_of<Taylor, Model>(p, 6, 1e-12)[0]), (end_of<Dop853, Model>(p, 6, 1e-14)[0]), 1e-11);
}

}  // namespace doppel::taylor_test
