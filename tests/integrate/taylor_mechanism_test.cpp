#include "errors.hpp"
#include "integrate/dormand_prince.hpp"
#include "integrate/pendulums.hpp"
#include "integrate/taylor.hpp"
#include "numeric/quad.hpp"
#include "physics/mechanism.hpp"
#include "physics/mechanisms.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel {
namespace taylor_mechanism_test {

using namespace counted;

template <class S>
using Vector = State<S, Eigen::Dynamic>;

/// The state of a mechanism after `seconds`.
template <class Which, class S>
Vector<S> end_of(const Assembly<S>& parts, const S& seconds, const S& tolerance) {
    Mechanism<S> model(parts);
    typename Which::template Stepper<Mechanism<S>> stepper(model, Mechanism<S>::start(parts), tolerance);
    stepper.advance(seconds);
    return stepper.state();
}

template <class S>
double apart(const Vector<S>& a, const Vector<S>& b) {
    return static_cast<double>(S((a - b).cwiseAbs().maxCoeff()));
}

/// Springs with damping, attraction, a near droplet, straight and circular slots, and a loop.
Assembly<double> of_everything() {
    auto parts = four_bars();
    parts.particles.push_back({0.7, P(3.5, 2)});
    parts.particles.push_back({0.4, P(-1, 2), P(-1, 0.5)});
    parts.constraints.push_back(SlotCircle<double>{5 - 1, P(3.5, 1), 1});
    parts.constraints.push_back(SlotLine<double>{6 - 1, P(-1, 2), P(2, -1)});
    parts.forces.push_back(Spring<double>{two, P(0, 2), 15, 0.5, 0.4});
    parts.forces.push_back(Spring<double>{5 - 1, three, 9, 1});
    parts.forces.push_back(Spring<double>{6 - 1, two, 4, 1.5, 0.1});
    parts.forces.push_back(Attraction<double>{6 - 1, two, 1.5});
    parts.forces.push_back(Droplet<double>{P(1, 3), 2, 3});
    return parts;
}

TEST(TaylorMechanism, FollowsDop853) {
    const auto parts = of_everything();
    check(parts);
    const auto truth = end_of<Taylor>(parts.cast<Quad>(), Quad(3), Quad(1e-22));
    const auto expected = end_of<Dop853>(parts.cast<Quad>(), Quad(3), Quad(1e-18));
    EXPECT_GT(apart(truth, Mechanism<Quad>::start(parts.cast<Quad>())), 1);
    EXPECT_LT(apart(truth, expected), 7e-17);  // measured 1.3e-17
    for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
        const Vector<Quad> end = end_of<Taylor>(parts, 3.0, tolerance).cast<Quad>();
        EXPECT_LT(apart(end, truth), 300 * tolerance) << tolerance;  // measured at most 86
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
            const auto end = end_of<Taylor>(parts, period, Quad(1e-31));
            EXPECT_LT(apart(end, Mechanism<Quad>::start(parts)), 2e-31) << e;  // measured 3e-32
        }
    }
}

TEST(TaylorMechanism, KeepsEnergyAndRods) {
    auto parts = of_everything();
    for (auto& force : parts.forces)
        if (auto* spring = std::get_if<Spring<double>>(&force)) spring->damping = 0;
    const auto exact = parts.cast<Quad>();
    Mechanism<Quad> model(exact);
    const auto start = model.start(exact), end = end_of<Taylor>(exact, Quad(1), Quad(1e-30));
    EXPECT_LT(std::abs(static_cast<double>(Quad(model.energy(end) - model.energy(start)))),
              1e-31);  // J; measured 1.2e-32
    const Quad moved = model.length_error(end) - model.length_error(start);
    EXPECT_LT(std::abs(static_cast<double>(moved)), 3e-33);  // m; measured 4e-34, of the initial 2e-16 of doubles
}

/// Two links of 1 m and 1 kg at rest, and the study's droplet one mile to their right.
Assembly<Quad> hanging(double degrees, bool beside_a_droplet) {
    Pendulum<Quad> p = from_rest({degrees, degrees}).cast<Quad>();
    for (auto& angle : p.angle) angle = Quad(degrees) * pi_of<Quad>() / Quad(180);
    p.gravity = parse_quad("9.8");
    auto parts = parts_of(p);
    if (beside_a_droplet) parts.forces.push_back(Droplet<Quad>{At<Quad>(Quad(1609), Quad(0)), parse_quad("3.4e-5")});
    return parts;
}

TEST(TaylorMechanism, ADropletHasItsTheoreticalEffect) {
    // both links aligned at rest, so M = ((2, 1), (1, 1)) for the angles: each bob has the acceleration by the droplet
    // across the line
    const auto at = hanging(79, false).particles;
    const double t = 1e-4, sine = static_cast<double>(at[0].place[0]), cosine = -static_cast<double>(at[0].place[1]);
    const auto with = end_of<Taylor>(hanging(79, true), Quad(t), Quad(1e-32));
    const auto without = end_of<Taylor>(hanging(79, false), Quad(t), Quad(1e-32));
    for (const Eigen::Index bob : {0, 1}) {
        const P r = P(1609, 0) - static_cast<double>(bob + 1) * P(sine, -cosine);
        const double across = 6.674e-11 * 3.4e-5 / std::pow(r.norm(), 3) * (r[0] * cosine + r[1] * sine);
        const double vx = static_cast<double>(Quad(with[4 + 2 * bob] - without[4 + 2 * bob]));
        EXPECT_NEAR(vx / (across * cosine * t), 1, 5e-6);  // measured 7e-7: t²
    }
}

// Errors.

std::string error_of(const Assembly<double>& parts, double seconds, double tolerance) {
    const auto [code, said] = test::thrown_by([&] { end_of<Taylor>(parts, seconds, tolerance); });
    EXPECT_TRUE(code == ExitCode::method_failed || code == ExitCode::done);
    return said;
}

TEST(TaylorMechanism, FailsIfBodiesCollide) {
    const Assembly<double> parts{
        .particles = {{1, P(0, 0)}, {1, P(1, 0)}}, .constraints = {}, .forces = {Attraction<double>{one, two, 1}}};
    EXPECT_EQ(error_of(parts, 2, 1e-12).substr(0, 8), "taylor: ");
}

TEST(TaylorMechanism, PassesThroughTheMiddleOfASpring) {
    // straight through the centre, where the force jumps: x = 1 − 9 sin t, then x = cos τ + v sin τ − 1
    const Assembly<double> parts{
        .particles = {{1, P(1, 0), P(-9, 0)}}, .constraints = {}, .forces = {Spring<double>{one, P(0, 0), 1, 1}}};
    const double tau = 2 - std::asin(1 / 9.0), v = -9 * std::sqrt(1 - 1 / 81.0);
    EXPECT_NEAR(end_of<Taylor>(parts, 2.0, 1e-12)[0], std::cos(tau) + v * std::sin(tau) - 1, 3e-11);  // measured 5e-12
}

TEST(TaylorMechanism, FailsIfTheMotionDiverges) {
    auto parts = four_bars();
    for (const double speed : {1e200, std::nan("")}) {
        parts.forces = {Gravity<double>{speed}};
        EXPECT_NE(error_of(parts, 1, 1e-12), "no error");
    }
}

TEST(TaylorMechanism, StaysInEquilibrium) {
    const Assembly<double> loose{
        .particles = {{1, P(2, 0)}}, .constraints = {}, .forces = {Spring<double>{one, P(1, 0), 1, 1}}};
    EXPECT_EQ(end_of<Taylor>(loose, 1000.0, 1e-12), Mechanism<double>::start(loose));
}

TEST(TaylorMechanism, FallsAndHangsFromRest) {
    // gravity only; a spring released at its rest length, or with zero length
    Assembly<double> parts{.particles = {{1, P(0, 0)}}, .constraints = {}, .forces = {Gravity<double>{}}};
    EXPECT_NEAR(end_of<Taylor>(parts, 2.0, 1e-12)[1], -0.5 * 9.8 * 4, 1e-14);  // measured 0
    for (const double length : {0.0, 1.0}) {
        parts.forces = {Gravity<double>{}, Spring<double>{one, P(0, length), 4, length}};
        EXPECT_NEAR(end_of<Taylor>(parts, 2.0, 1e-12)[1], 9.8 / 4 * (std::cos(2 * 2.0) - 1), 2e-12)
            << length;  // measured 3.5e-13
    }
}

}  // namespace taylor_mechanism_test
}  // namespace doppel
