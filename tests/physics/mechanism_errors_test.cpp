#include "errors.hpp"
#include "physics/mechanism.hpp"
#include "physics/mechanisms.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <variant>

namespace doppel::mechanism_errors_test {

using namespace counted;

// Error messages of impossible mechanisms.

const std::string no_fault = "no error";

std::string error_of(const Assembly<double>& parts) {
    const auto [code, message] = test::thrown_by([&] { check(parts); });
    EXPECT_TRUE(code == ExitCode::bad_input || message == no_fault) << message;
    return message;
}

struct BadPart {
    std::variant<Constraint<double>, Force<double>> part;
    const char* error;
};

/// Each bad part is added to a four-bar loop, as the sixth constraint or the only force.
void expect_faults(const std::vector<BadPart>& bad_parts) {
    for (const auto& [part, error] : bad_parts) {
        auto parts = four_bars();
        if (const auto* constraint = std::get_if<Constraint<double>>(&part)) parts.constraints.push_back(*constraint);
        if (const auto* force = std::get_if<Force<double>>(&part)) parts.forces = {*force};
        EXPECT_EQ(error_of(parts), error);
    }
}

TEST(MechanismErrors, OfParticles) {
    EXPECT_EQ(error_of({}), "the mechanism has no particles; it needs at least one");
    const auto changed = [](auto change) {
        auto parts = four_bars();
        change(parts.particles);
        return error_of(parts);
    };
    EXPECT_EQ(changed([](auto& p) { p[1].mass = 0; }), "particle 2: its mass is 0 kg; it must be greater than 0");
    EXPECT_EQ(changed([](auto& p) { p[2].place[1] = std::nan(""); }),
              "particle 3: its place is (2.9, nan) m; both must be finite numbers");
    EXPECT_EQ(changed([](auto& p) { p[2].velocity[0] = INFINITY; }),
              "particle 3: its velocity is (inf, 0) m/s; both must be finite numbers");
}

TEST(MechanismErrors, OfParts) {
    expect_faults({
        {Rod<double>{one, std::size_t{4}, 1},
         "constraint 6 (rod 1–5): there is no particle 5; the mechanism has 1 to 4"},
        {Rod<double>{two, two, 1},
         "constraint 6 (rod 2–2): it joins particle 2 to itself; it needs two different particles"},
        {Rod<double>{two, P(0, 0), 0}, "constraint 6 (rod 2–fixed): its length is 0 m; it must be greater than 0"},
        {SlotCircle<double>{three, P(0, 0), 0},
         "constraint 6 (slot-circle of particle 3): its radius is 0 m; it must be greater than 0"},
        {SlotLine<double>{three, P(0, 0), P(0, 0)},
         "constraint 6 (slot-line of particle 3): its direction is (0, 0); it must not be zero"},
        {Anchor<double>{one, P(0, INFINITY)},
         "constraint 6 (anchor of particle 1): its place is (0, inf); both must be finite numbers"},
        {Gravity<double>{std::nan("")}, "force 1 (gravity): its g is nan m/s²; it must be a finite number"},
        {Spring<double>{one, P(1, 1), 0, 1},
         "force 1 (spring 1–fixed): its stiffness is 0 N/m; it must be greater than 0"},
        {Spring<double>{one, two, 1, -1}, "force 1 (spring 1–2): its rest length is -1 m; it must not be negative"},
        {Spring<double>{one, two, 1, 1, -1}, "force 1 (spring 1–2): its damping is -1 N s/m; it must not be negative"},
        {Spring<double>{two, two, 1, 1},
         "force 1 (spring 2–2): it joins particle 2 to itself; it needs two different particles"},
        {Attraction<double>{one, one},
         "force 1 (attraction 1–1): it joins particle 1 to itself; it needs two different particles"},
        {Droplet<double>{P(0.6, 0.8), 1},
         "force 1 (droplet): particle 2 starts at (0.6, 0.8) m, the place of what attracts it; start it elsewhere"},
    });
}

TEST(MechanismErrors, OfAStartOffTheConstraints) {
    expect_faults({
        {Anchor<double>{two, P(0.5, 0.8)},
         "constraint 6 (anchor of particle 2): the particle starts at (0.6, 0.8) m, 0.1 m from its anchor (0.5, 0.8) "
         "m; anchor it at (0.6, 0.8)"},
        {Rod<double>{two, P(0.6, 0), 1},
         "constraint 6 (rod 2–fixed): its ends start 0.8 m apart, 0.2 m from its length 1 m; make the length 0.8"},
        {SlotLine<double>{two, P(0, 0), P(5, 0)},
         "constraint 6 (slot-line of particle 2): the particle starts at (0.6, 0.8) m, 0.8 m off the line; start it at "
         "(0.6, 0)"},
        {SlotCircle<double>{two, P(0.6, 0), 1},
         "constraint 6 (slot-circle of particle 2): the particle starts 0.8 m from the centre, 0.2 m from the radius 1 "
         "m; make the radius 0.8"},
    });
}

TEST(MechanismErrors, OfRedundantConstraints) {
    expect_faults({
        {Rod<double>{one, two, 1},
         "constraint 6 (rod 1–2) is redundant: it follows from constraint 2; leave it out, or start elsewhere"},
        {Rod<double>{four, one, 2},
         "constraint 6 (rod 4–1) is redundant: it follows from constraints 1 and 3; leave it out, or start elsewhere"},
        {SlotCircle<double>{two, P(0, 0), 1},
         "constraint 6 (slot-circle of particle 2) is redundant: it follows from constraints 1 and 2; leave it out, "
         "or start elsewhere"},
    });
}

// The error of a start may be at most 1e-9 of the mechanism's size.
TEST(MechanismErrors, IsMeasuredByTheSizeOfTheMechanism) {
    for (const double size : {0.01, 1.0, 100.0}) {
        const auto off_by = [&](double share) {
            return error_of({.particles = {{1, P(0, -size * (1 + share)), P(0, 0)}},
                             .constraints = {Rod<double>{one, P(0, 0), size}},
                             .forces = {}});
        };
        EXPECT_EQ(off_by(0.5e-9), no_fault) << size;
        EXPECT_NE(off_by(2e-9), no_fault) << size;
    }
    // the round-off error of a bead that starts at the origin is compared with the size of its slot
    EXPECT_EQ(error_of({.particles = {{1, P(0, 0)}},
                        .constraints = {SlotLine<double>{one, P(0.1, 0.3), P(1, 3)}},
                        .forces = {Gravity<double>{}}}),
              no_fault);
}

TEST(MechanismErrors, OfAStartThatLeavesTheConstraints) {
    auto parts = four_bars();
    parts.particles[0].velocity = P(0, 0.5);
    EXPECT_EQ(error_of(parts),
              "constraint 1 (anchor of particle 1): the start violates it at 0.5 m/s; start particle 1 "
              "at (0, 0) m/s");
    // the error names the constraint's particle
    parts = {.particles = {{1, P(0, 0)}, {1, P(3, 4), P(5, 0)}},
             .constraints = {Rod<double>{two, P(0, 0), 5}},
             .forces = {}};
    EXPECT_EQ(error_of(parts),
              "constraint 1 (rod 2–fixed): the start violates it at 3 m/s; start particle 2 at (3.2, -2.4) m/s");
    parts.particles[1].velocity = P(3.2, -2.4);
    EXPECT_EQ(error_of(parts), no_fault);
}

TEST(MechanismErrors, OfASingularConfigurationHoweverLongTheSteps) {
    check(parallelogram());
    for (const double step : {1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5}) {
        Mechanism<double> model(parallelogram());
        Rk4::Stepper<Mechanism<double>> stepper(model, model.start(parallelogram()), step);
        const auto [code, said] = test::thrown_by([&] { stepper.advance(std::lround(0.3 / step)); });
        EXPECT_EQ(code, ExitCode::method_failed) << step;
        EXPECT_EQ(said.substr(0, said.find("; the particles are at (1")),
                  "singular configuration: constraint 3 (rod 1–2) now follows from constraints 1 and 2, so the "
                  "forces are not determined");
        EXPECT_NE(said.find(") m; choose a start that does not lead there, or leave the constraint out"),
                  std::string::npos);
    }
    // if it turns back before that position, it moves
    auto slower = parallelogram();
    for (auto& particle : slower.particles) particle.velocity /= 8;
    Mechanism<double> model(slower);
    const double start = model.energy(model.start(slower));
    EXPECT_NEAR(model.energy(after(model, slower, 20000, 5e-4)), start, 3e-9);  // measured 5e-10
}

TEST(MechanismErrors, OfAMotionThatDiverges) {
    auto parts = four_bars();
    parts.forces.push_back(Spring<double>{two, P(0, 2), 1e9, 0.5});
    Mechanism<double> model(parts);
    const auto [code, message] = test::thrown_by([&] { after(model, parts, 100, 0.1); });
    EXPECT_EQ(code, ExitCode::method_failed);
    EXPECT_NE(message.find("the motion diverged; use a smaller step"), std::string::npos) << message;
}

TEST(MechanismErrors, OfRodsWithLargeErrors) {
    // two hinged rods are never singular; so far out that both ends coincide in double, the second rod has no direction
    const Pendulum<double> p{{1, 1}, {1, 1}, {1, 2}, {0, 0}, 9.8};
    const auto parts = parts_of(p);
    Mechanism<double> model(parts);
    auto y = model.start(parts), dydt = y;
    y.head(4) << 1e20, 2e20, 1e20, 2e20;
    EXPECT_EQ(test::thrown_by([&] { model.rate(y, dydt); }),
              (test::Thrown{ExitCode::method_failed,
                            "the particles are at (1e+20, 2e+20), (1e+20, 2e+20) m, where a constraint has an error of "
                            "2.2e+20 times the longest rod: the motion diverged; use a smaller step"}));
}

}  // namespace doppel::mechanism_errors_test
