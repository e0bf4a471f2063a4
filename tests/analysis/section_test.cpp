#include "analysis/section.hpp"

#include "base/error.hpp"
#include "integrate/dormand_prince.hpp"
#include "integrate/taylor.hpp"
#include "physics/bob.hpp"
#include "physics/canonical.hpp"
#include "physics/pendulums.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

namespace doppel::section_test {

using Model = DoublePendulum<double>;
const std::atomic<bool> never = false;

/// The state in angles at a point of the section.
State<double, 4> state_at(const Pendulum<double>& p, const SectionPoint& point) {
    State<double, 4> y;
    Canonical<Model>(Model(p)).velocities(State<double, 4>(0, point.theta2, point.p1, point.p2), y);
    return y;
}

/// The energy above that of hanging at rest, J.
double energy_above(const Pendulum<double>& p, const State<double, 4>& y) {
    return energy(bobs_of_angles(p, y), p.gravity) + p.potential_range() / 2;
}

Pendulum<double> odd_one() {
    auto p = uneven(2);
    p.mass = {0.7, 1.6};
    p.length = {1.3, 0.6};
    return p;
}

TEST(Section, PointsAreOnItAndHaveTheEnergyAskedFor) {
    for (const double energy_J : {3.0, 15.0, 40.0, 140.0})
        for (const auto& release : releases_of_energy(odd_one(), energy_J, 4)) {
            const auto points = poincare_section(release, {.crossings = 50}, never);
            ASSERT_EQ(points.size(), 50u);
            for (const auto& point : points) {
                const auto y = state_at(release, point);
                EXPECT_NEAR(energy_above(release, y) / energy_J, 1, 2e-11);  // measured 4e-12
                EXPECT_GT(y[2], 0);
                EXPECT_LE(std::abs(point.theta2), pi);
            }
        }
}

TEST(Section, PointsAreLocatedInTime) {
    // the motion at the given time, by the same method with a smaller tolerance and without interpolation
    const auto release = releases_of_energy(odd_one(), 15, 3)[2];
    const auto points = poincare_section(release, {.crossings = 8}, never);
    Model model(release);
    Taylor::Stepper<Model> stepper(model, Model::start(release), 1e-15);
    double time = 0;
    for (const auto& point : points) {
        stepper.advance(point.time_s - time);
        time = point.time_s;
        const auto& y = stepper.state();
        EXPECT_NEAR(std::remainder(y[0], 2 * pi), 0, 3e-12);                               // measured 6e-13
        EXPECT_NEAR(std::remainder(y[1] - point.theta2, 2 * pi), 0, 1e-11);                // measured 1.6e-12
        EXPECT_NEAR((y.tail<2>() - state_at(release, point).tail<2>()).norm(), 0, 5e-11);  // measured 1e-11
    }
}

/// The times at which θ1 passes 0 upwards after the start and before `to`, s, from its signs 2e-5 s apart, by dop853.
std::vector<double> passages(const Pendulum<double>& p, double to) {
    Model model(p);
    Dop853::Stepper<Model> stepper(model, Model::start(p), 1e-13);
    std::vector<double> times;
    constexpr double apart = 2e-5;
    for (double time = 0, before = stepper.state()[0]; time < to; time += apart) {
        stepper.advance(apart);
        const double after = stepper.state()[0];
        if (std::floor(after / (2 * pi)) > std::floor(before / (2 * pi))) times.push_back(time + apart);
        before = after;
    }
    return times;
}

TEST(Section, ReturnsThatAllButTouchAreFound) {
    // unit masses and lengths; θ1 is above 0 for hundredths of a second only
    for (const auto& [energy_J, orbit, time_s] : {std::tuple{5.88, 4u, 74.448}, {14.7, 9u, 171.162}}) {
        auto release = releases_of_energy({}, energy_J, 24)[orbit];
        const auto before = poincare_section(release, {.crossings = 500, .longest_s = time_s + 1e-3}, never).back();
        // two computations of so long a chaotic motion diverge: start again at the last crossing before
        const auto y = state_at(release, before);
        release.angle = {y[0], y[1]};
        release.rate = {y[2], y[3]};
        const auto points = poincare_section(release, {.crossings = 500, .longest_s = 4}, never);
        const auto expected = passages(release, 4);
        ASSERT_EQ(points.size(), expected.size()) << energy_J;
        for (std::size_t i = 0; i < points.size(); ++i)
            EXPECT_NEAR(points[i].time_s, expected[i], 1e-4) << energy_J;  // measured 2e-5, the steps of the signs
    }
}

TEST(Section, IsItsOwnMirrorImageBackwardsInTime) {
    // (−θ1, −θ2, p1, p2) is the motion with time reversed
    const auto release = releases_of_energy(odd_one(), 12, 7)[4];
    const auto points = poincare_section(release, {.crossings = 21}, never);
    const auto end = state_at(release, points.back());
    auto mirrored = release;
    mirrored.angle = {0, -end[1]};
    mirrored.rate = {end[2], end[3]};
    const auto back = poincare_section(mirrored, {.crossings = 20}, never);
    for (std::size_t i = 0; i < 20; ++i) {
        EXPECT_NEAR(back[i].theta2, -points[19 - i].theta2, 5e-11) << i;  // measured 9e-12
        EXPECT_NEAR(back[i].p2, points[19 - i].p2, 2e-10) << i;           // measured 2.4e-11
    }
}

TEST(Section, CountsWholeTurnsInTheOrderOfTime) {
    // without gravity, stretched and rotating as one, it crosses once per turn; in the other direction it never does
    auto p = odd_one();
    p.gravity = 0;
    p.angle = {0, 0};
    p.rate = {3, 3};
    // measured 1.3e-13; with a first step of three and a half turns, 1.7e-4
    for (const auto& [tolerance, crossings, maximum] : {std::tuple{1e-13, 10, 7e-13}, {1e-2, 3, 1e-3}}) {
        const auto points = poincare_section(p, {.crossings = crossings, .tolerance = tolerance}, never);
        ASSERT_EQ(points.size(), static_cast<std::size_t>(crossings));
        for (std::size_t i = 0; i < points.size(); ++i)
            EXPECT_NEAR(points[i].time_s, static_cast<double>(i + 1) * 2 * pi / 3, maximum) << i;
    }
    p.rate = {-3, -3};
    EXPECT_TRUE(poincare_section(p, {.crossings = 10, .longest_s = 50}, never).empty());
}

TEST(Section, ReleasesAreSpreadByMultiplesOfThePlasticNumber) {
    // Roberts 2018: fractions of ½ + k/ρ and ½ + k/ρ², along θ2 and along p2 at this θ2
    auto p = odd_one();
    for (const double gravity : {9.8, 0.5, 0.0}) {
        p.gravity = gravity;
        constexpr double energy_J = 4;
        const double weight = 1.6 * gravity * 0.6, inertia = 1.6 * 0.6 * 0.6;
        const double widest = weight > energy_J / 2 ? std::acos(1 - energy_J / weight) : pi;
        const auto releases = releases_of_energy(p, energy_J, 5);
        ASSERT_EQ(releases.size(), 5u);
        for (std::size_t k = 0; k < 5; ++k) {
            const double u = std::fmod(0.5 + static_cast<double>(k) * 0.7548776662466927, 1);
            const double v = std::fmod(0.5 + static_cast<double>(k) * 0.5698402909980533, 1);
            const auto y = Model::start(releases[k]);
            State<double, 4> z;
            Canonical<Model>(Model(releases[k])).momenta(y, z);
            const double kinetic = energy_J - weight * (1 - std::cos(y[1]));
            EXPECT_EQ(y[0], 0);
            EXPECT_GT(y[2], 0);
            EXPECT_NEAR(energy_above(p, y) / energy_J, 1, 2e-14) << k;
            EXPECT_NEAR(y[1], widest * (2 * u - 1), 2e-14) << k;                            // measured 3e-15
            EXPECT_NEAR(z[3], std::sqrt(2 * inertia * kinetic) * (2 * v - 1), 2e-14) << k;  // measured 2.7e-15
        }
    }
}

TEST(Section, NeedsEnergyAndStopsOnRequest) {
    const std::atomic<bool> stop = true;
    EXPECT_THROW(poincare_section(uneven(2), {}, stop), Error);
    EXPECT_THROW(releases_of_energy(uneven(2), 0, 3), Error);
    auto upwards = uneven(2);
    upwards.gravity = -1;
    EXPECT_THROW(releases_of_energy(upwards, 1, 3), Error);
}

}  // namespace doppel::section_test
