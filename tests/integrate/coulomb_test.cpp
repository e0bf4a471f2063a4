#include "errors.hpp"
#include "integrate/registry.hpp"
#include "integrate/support.hpp"

#include <cmath>
#include <string_view>

namespace doppel::coulomb_test {

/// `method` with this number of steps per second, or with the tolerance; one sample each 1/100 s.
MotionSpec spec_of(const PhysicalPendulum<double>& p, std::string_view method, long steps_per_s, double tolerance) {
    auto spec = stepping(Model::angles, method, p.chain, 100);
    spec.physical = p.cast<Quad>();
    spec.tolerance = Quad(tolerance);
    spec.steps_per_sample = steps_per_s / 100;
    return spec;
}

std::vector<double> angles_after(const MotionSpec& spec, long samples) {
    std::vector<double> angles;
    for (const auto& bob : Course(spec).advance(samples).bobs) angles.push_back(bob.theta);
    return angles;
}
double difference(const std::vector<double>& one, const std::vector<double>& other) {
    double maximum = 0;
    for (std::size_t i = 0; i < one.size(); ++i) maximum = std::max(maximum, std::abs(one[i] - other[i]));
    return maximum;
}

/// Two rods with a motor. Each joint changes its direction, sticks and slips about 20 times in 5 s.
PhysicalPendulum<double> sticking() {
    auto p = physical(Pendulum<double>{{1, 1}, {1, 0.8}, {-0.55, -0.82}, {0, 0}});
    p.center = {0.8, 0.7};
    p.inertia = {0.06, 0.02};
    p.friction.viscous = {0.095, 0.112};
    p.friction.coulomb = {1.287, 0.263};
    p.torques = {{0, 1.14, 6.1, 0}};
    return p;
}

TEST(Coulomb, APendulumTurnsAndStopsWhereEnergyAndWorkSay) {
    // from a turning point θ to the next, −θ′:  m g l (cos θ′ − cos θ) = c (θ + θ′); it sticks where m g l sin θ ≤ c
    const double c = 0.5, weight = 9.8;
    auto p = physical(Pendulum<double>{{1}, {1}, {pi / 3}, {0}});
    p.friction.coulomb = {c};
    double turn = pi / 3, side = 1;
    for (; weight * std::sin(turn) > c; side = -side) {
        double next = turn;
        for (int i = 0; i < 50; ++i)
            next += (weight * (std::cos(next) - std::cos(turn)) - c * (turn + next)) / (weight * std::sin(next) + c);
        turn = next;
    }
    struct Try {
        std::string_view method;
        long steps_per_s;
        double tolerance, maximum;
    };
    // measured 3e-15, 6e-16, 1e-13, 2e-11, 4e-10, 7e-15, 3e-5
    for (const auto& [method, steps, tolerance, maximum] :
         {Try{"taylor", 0, 1e-15, 1e-13}, Try{"taylor", 0, 1e-13, 1e-12}, Try{"dop853", 0, 1e-13, 1e-12},
          Try{"dopri5", 0, 1e-11, 1e-9}, Try{"rk4", 1000, 0, 1e-9}, Try{"adams", 1000, 0, 1e-12},
          Try{"midpoint", 1000, 0, 1e-4}}) {
        Course course(spec_of(p, method, steps, tolerance));
        const auto end = course.advance(1500).bobs[0];
        EXPECT_EQ(end.omega, 0) << method;
        EXPECT_NEAR(end.theta, side * turn, maximum) << method;
        EXPECT_EQ(course.advance(100).bobs[0].theta, end.theta) << method;
    }
}

TEST(Coulomb, ErrorsFallWithTheToleranceAndTheStep) {
    const auto p = sticking();
    const auto exact = angles_after(spec_of(p, "taylor", 0, 1e-15), 500);
    // measured 5e-12, 2e-15; 2e-9, 4e-13; 4e-9
    EXPECT_LE(difference(angles_after(spec_of(p, "taylor", 0, 1e-9), 500), exact), 1e-10);
    EXPECT_LE(difference(angles_after(spec_of(p, "taylor", 0, 1e-13), 500), exact), 1e-13);
    EXPECT_LE(difference(angles_after(spec_of(p, "dop853", 0, 1e-9), 500), exact), 1e-7);
    EXPECT_LE(difference(angles_after(spec_of(p, "dop853", 0, 1e-13), 500), exact), 1e-11);
    EXPECT_LE(difference(angles_after(spec_of(p, "dopri5", 0, 1e-11), 500), exact), 1e-9);
    const double coarse = difference(angles_after(spec_of(p, "rk4", 500, 0), 500), exact);
    const double fine = difference(angles_after(spec_of(p, "rk4", 2000, 0), 500), exact);
    EXPECT_LE(fine, 1e-9);                                                                 // measured 2e-11
    EXPECT_GE(coarse / fine, 100);                                                         // measured 270; 4^4 = 256
    EXPECT_LE(difference(angles_after(spec_of(p, "adams", 2000, 0), 500), exact), 1e-10);  // measured 2e-12
}

TEST(Coulomb, InQuadToo) {
    auto spec = spec_of(sticking(), "taylor", 0, 1e-26);
    spec.precision = Precision::in_quad;
    const auto fine = angles_after(spec, 100);
    EXPECT_LE(difference(angles_after(spec_of(sticking(), "taylor", 0, 1e-15), 100), fine), 1e-13);
}

TEST(Coulomb, AHeldJointIsReleasedByThePeakOfADrive) {
    // two motors that beat: after seconds of rest, their sum exceeds the static friction briefly, by at most 0.5 %
    auto p = physical(Pendulum<double>{{1}, {1}, {0}, {0}});
    p.friction.coulomb = {1.99};
    p.torques = {{0, 1, 2 * pi * 3, 0.8}, {0, 1, 2 * pi * 3.3, 2.9}};
    const auto exact = angles_after(spec_of(p, "rk4", 100'000, 0), 1000);
    EXPECT_GT(std::abs(exact[0]), 1e-7);
    for (const auto* method : {"taylor", "dop853", "dopri5"})
        EXPECT_NEAR(angles_after(spec_of(p, method, 0, 1e-12), 1000)[0], exact[0], 1e-10) << method;
}

TEST(Coulomb, AStickingJointStaysExactly) {
    auto p = physical(Pendulum<double>{{1, 1}, {1, 1}, {pi / 3, pi / 3}, {0, 0}});
    p.friction.coulomb = {3, 1};
    for (const auto* method : {"taylor", "rk4", "euler", "dopri5", "dop853", "semi-implicit-euler"}) {
        Course course(spec_of(p, method, 30'000, 1e-15));
        const auto stuck = course.advance(900), later = course.advance(500);
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_EQ(later.bobs[i].omega, 0) << method;
            EXPECT_EQ(later.bobs[i].theta, stuck.bobs[i].theta) << method;
            EXPECT_LT(std::abs(stuck.bobs[i].theta), 0.2) << method;
        }
        EXPECT_LT(later.energy - later.work, p.potential_range());
    }
}

/// A state that changes its direction again and again at one time.
struct Restless {
    using State = doppel::State<double, Eigen::Dynamic>;
    using Scalar = double;
    void rate(const State& y, State& dydt) { dydt = (1000 * y).array().cos(); }
    bool switches() const { return true; }
    void take_modes(State&) {}
    void settle(State& y) { y.setZero(); }
    double margin(const State& y) { return y[0] > 0 ? -1 : 1; }
    double longest_step() const { return 1; }
};

TEST(Coulomb, EventsThatDoNotEndAreAFailureOfTheMethod) {
    for (const auto* method : {"rk4", "semi-implicit-euler", "adams", "dop853"}) {
        const auto adaptive = std::string_view(method) == "dop853";
        const auto [code, said] = test::thrown_by([&] {
            auto stepper = make_stepper(method, Restless(), Restless::State::Zero(2), adaptive ? 1e-9 : 0.1);
            adaptive ? stepper->advance_by(1) : stepper->advance(10);
        });
        EXPECT_EQ(code, ExitCode::method_failed) << method;
        EXPECT_NE(said.find("at one time"), std::string::npos) << said;
    }
}

}  // namespace doppel::coulomb_test
