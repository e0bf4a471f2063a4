#include "errors.hpp"
#include "integrate/flips.hpp"
#include "integrate/flips_kernel.hpp"
#include "integrate/taylor.hpp"
#include "integrate/widths.hpp"
#include "numeric/roots.hpp"
#include "physics/pendulums.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace doppel::flip_test {

constexpr double never = std::numeric_limits<double>::infinity();

/// The initial angles of a double pendulum, rad.
struct Release {
    double theta1, theta2;
};

/// Evenly distributed over the square of −180…180°.
std::vector<Release> some_releases(std::size_t count) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> some(-pi, pi);
    std::vector<Release> all(count);
    for (auto& release : all) release = {some(random), some(random)};
    return all;
}

Pendulum<double> released(Pendulum<double> p, const Release& release) {
    p.angle = {release.theta1, release.theta2};
    return p;
}

std::vector<Pendulum<double>> all_released(const Pendulum<double>& p, const std::vector<Release>& releases) {
    std::vector<Pendulum<double>> all;
    for (const auto& release : releases) all.push_back(p.links() == 2 ? released(p, release) : p);
    return all;
}

std::vector<double> flips(const std::vector<Release>& releases, const Pendulum<double>& p = {},
                          const FlipSpec& spec = {}, int width = 0) {
    std::vector<double> times(releases.size(), -7);
    first_flips(all_released(p, releases), spec, times, false, width);
    return times;
}

/// The first flip of one pendulum by other equations and code: TaylorStepper with a tolerance. At 1e-13, all of
/// 110 flips within 20 s are within 2e-6 s of those in quad at 1e-24.
double reference_flip(const Pendulum<double>& pendulum, double duration, double tolerance) {
    struct Outward {
        double value, rate;
    };
    DoublePendulum<double> model(pendulum);
    const auto start = DoublePendulum<double>::start(pendulum);
    if (start.head(2).cwiseAbs().maxCoeff() > pi) return 0;
    TaylorStepper<DoublePendulum<double>> stepper(model, start, tolerance);
    for (double time = 0; time < duration; time += stepper.step()) {
        stepper.take_step();
        double flip = never;
        for (const int rod : {0, 1})
            for (const double sense : {1.0, -1.0}) {
                auto angle = stepper.on_step(rod);
                for (double& value : angle.b) value *= sense;
                for (const auto& rise : angle.rises(pi)) {
                    const auto at = [&](double t) {
                        const auto& y = stepper.at(t);
                        return Outward{sense * y[rod] - pi, sense * y[2 + rod]};
                    };
                    flip = std::min(flip, root(rise, at));
                }
            }
        if (flip < never) return time + flip <= duration ? time + flip : never;
    }
    return never;
}

/// Unequal masses, lengths and gravity.
Pendulum<double> uneven() {
    Pendulum<double> p;
    p.mass = {1, 3};
    p.length = {2, 0.5};
    p.gravity = 3.7;
    return p;
}

/// Time from θ to upright, s, of a single rod with the rate at θ that it has from passing the bottom with `omega`:
///     θ′² = ω² − 4 (g/l) sin² θ/2,   t = (2/ω) (K(k) − F(θ/2, k)),   k = 2 √(g/l) / ω
double time_to_upright(double theta, double omega, double length, double gravity) {
    const double k = 2 * std::sqrt(gravity / length) / omega;
    return 2 / omega * (std::comp_ellint_1(k) - std::ellint_1(k, theta / 2));
}
double rate_there(double theta, double omega, double length, double gravity) {
    return std::sqrt(omega * omega - 4 * gravity / length * std::pow(std::sin(theta / 2), 2));
}

TEST(Flips, AreForbiddenBelowTheEnergyOfAnUprightRod) {
    // below the limit of an angle or a rate, not above
    const auto expect_limit = [](Pendulum<double> p, std::vector<double> Pendulum<double>::*numbers, std::size_t link,
                                 double limit) {
        double& number = (p.*numbers)[link];
        number = limit * (1 - 1e-9);
        EXPECT_TRUE(flip_is_forbidden(p)) << limit;
        number = limit * (1 + 1e-9);
        EXPECT_FALSE(flip_is_forbidden(p)) << limit;
    };
    const auto angle = &Pendulum<double>::angle, rate = &Pendulum<double>::rate;
    const auto hanging = released({}, {0, 0});
    // −2 cosθ1 − cosθ2 < −2 + 1 for equal masses: at θ1 = 90° and θ2 = 180°, and at θ2 = 0 and θ1 = 90°
    expect_limit(hanging, angle, 0, pi / 2);
    // W = 8 g, 1.5 g:  −8 cosθ1 − 1.5 = −9.5 + 3
    expect_limit(released(uneven(), {0, 0}), angle, 0, -std::acos(5.0 / 8));
    // the upper rod flips more easily: W = 0.2 g, 1 g:  −0.2 − cosθ2 = −1.2 + 0.4
    auto upper = hanging;
    upper.length = {0.1, 1};
    expect_limit(upper, angle, 1, std::acos(0.6));
    // three links, W = 3 g, 2 g, 1 g:  −3 − 2 cosθ2 − 1 = −6 + 2
    expect_limit({{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, {0, 0, 0}}, angle, 1, pi / 2);
    // hanging, the lower rod with a rate:  ½ m l² ω² = 2 m g l
    expect_limit(Pendulum<double>{.angle = {0, 0}}, rate, 1, 2 * std::sqrt(9.8));
}

/// The kernel itself, without the energy bound.
std::vector<double> kernel_flips(const std::vector<Release>& releases, const FlipSpec& spec = {}) {
    std::vector<double> times(releases.size(), -1);
    const std::atomic<bool> stop{false};
    const Pendulum<double> hanging;
    std::vector<Pendulum<double>> pendulums;
    for (const auto& release : releases) pendulums.push_back(released({}, release));
    find_flips<2>({.duration = spec.duration,
                   .allowed = std::log2(spec.tolerance),
                   .count = pendulums.size(),
                   .pendulums = pendulums.data(),
                   .hanging = &hanging,
                   .times = times.data(),
                   .stop = &stop});
    return times;
}

TEST(Flips, DoNotOccurWhereForbidden) {
    auto releases = some_releases(1000);
    std::erase_if(releases, [](const Release& r) { return !flip_is_forbidden(released({}, r)); });
    ASSERT_GT(releases.size(), 200u);
    for (double theta2 = -3; theta2 < 3; theta2 += 0.05)  // just below the bound, 2 cosθ1 + cosθ2 = 1
        releases.push_back({std::acos((1 + 1e-6 - std::cos(theta2)) / 2), theta2});
    for (const double time : kernel_flips(releases)) EXPECT_EQ(time, never);
    for (const double time : flips(releases)) EXPECT_EQ(time, never);
}

TEST(Flips, OfASingleRodComeAtTheEllipticIntegral) {
    // the upper mass, 10¹⁴ times as heavy, hangs at rest
    struct Case {
        double omega, loose, tight;  // maximum error at the default tolerance and at a fine one, s
    };
    // 2 √g = 6.26099; measured 1.8e-12, 2.1e-10, 6.9e-8 and 2.4e-15, 2.2e-13, 8.1e-11
    for (const auto& [omega, loose, tight] :
         {Case{9.0, 1e-11, 2e-14}, Case{6.3, 2e-9, 2e-12}, Case{6.2611, 5e-7, 5e-10}})
        for (const double theta : {0.0, 0.7, -1.1, 2.5}) {
            Pendulum<double> p;
            p.mass = {1e14, 1};
            p.rate = {0, rate_there(theta, omega, 1, p.gravity)};
            const double exact = time_to_upright(theta, omega, 1, p.gravity);
            EXPECT_NEAR(flips({{0, theta}}, p)[0], exact, loose) << omega << ' ' << theta;
            EXPECT_NEAR(flips({{0, theta}}, p, {.tolerance = 1e-12})[0], exact, tight) << omega << ' ' << theta;
            EXPECT_NEAR(reference_flip(released(p, {0, theta}), 20, 1e-13), exact, tight) << omega << ' ' << theta;
        }
    // the lower mass is zero, and its rod is long
    Pendulum<double> p;
    p.mass = {1, 1e-13};
    p.length = {1, 10};
    p.rate = {20, 0};
    EXPECT_NEAR(flips({{0, 0}}, p)[0], time_to_upright(0, 20, 1, p.gravity), 5e-14);  // measured 6.5e-15
}

struct Agreement {
    std::size_t wrong;  // flips with an error above 0.01 s
    double early;       // s, the 99th percentile of the errors in the first five seconds
};
Agreement agreement(const Pendulum<double>& pendulum, std::size_t count) {
    const auto releases = some_releases(count);
    const auto times = flips(releases, pendulum);
    std::vector<double> early;
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < releases.size(); ++i) {
        const auto p = released(pendulum, releases[i]);
        const double exact = flip_is_forbidden(p) ? never : reference_flip(p, 20, 1e-13);
        const double error = times[i] == exact ? 0 : std::abs(times[i] - exact);
        wrong += !(error < 0.01);
        if (exact < 5) early.push_back(error);
    }
    EXPECT_GT(early.size(), count / 10);
    std::sort(early.begin(), early.end());
    return {wrong, early[early.size() * 99 / 100]};
}

TEST(Flips, ComeWhenTheReferenceSays) {
    const auto even = agreement({}, 1500), odd = agreement(uneven(), 500);
    EXPECT_EQ(even.wrong, 0u);    // of 10 000, 2
    EXPECT_LT(even.early, 1e-7);  // measured 1.3e-8
    EXPECT_EQ(odd.wrong, 0u);
    EXPECT_LT(odd.early, 1e-7);  // measured 1.2e-8
}

TEST(Flips, ComeWhenTheReferenceSaysInLongerRunsToo) {
    EXPECT_EQ(flip_tolerance(20), 1e-8);
    EXPECT_EQ(flip_tolerance(5), 1e-8);
    EXPECT_EQ(flip_tolerance(25), 1e-11);
    EXPECT_EQ(flip_tolerance(1000), 1e-14);
    // all flips after 20 s of random samples of releases
    const double duration = 30;
    const auto releases = some_releases(3000);
    const auto times = flips(releases, {}, {duration, flip_tolerance(duration)}),
               coarse = flips(releases, {}, {duration});
    int late = 0, wrong = 0, wrong_before = 0;
    for (std::size_t i = 0; i < releases.size(); ++i) {
        if (std::min(times[i], coarse[i]) < 20 || std::min(times[i], coarse[i]) == never) continue;
        ++late;
        const double exact = reference_flip(released({}, releases[i]), duration, 1e-14);
        const auto is_wrong = [&](double time) { return time != exact && !(std::abs(time - exact) < 0.01); };
        wrong += is_wrong(times[i]);
        wrong_before += is_wrong(coarse[i]);
    }
    EXPECT_GT(late, 30);
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(wrong_before, 0);  // measured 9 of 41
}

/// Between two releases with very different flip times, there is one whose rod just reaches the upright.
TEST(Flips, AreFoundWhereTheRodTurnsBackWithinTheStep) {
    constexpr double tolerance = 1e-11;
    const FlipSpec spec{.duration = 5, .tolerance = tolerance};
    int edges = 0;
    for (double theta2 = -3; theta2 < 3; theta2 += 0.25)
        for (double theta1 = 1.8; theta1 < 3; theta1 += 0.1) {
            double one = theta1, other = theta1 + 0.1;
            auto times = flips({{one, theta2}, {other, theta2}}, {}, spec);
            if (std::min(times[0], times[1]) > 2 || std::abs(times[0] - times[1]) < 0.5) continue;
            while (std::abs(other - one) > 1e-7) {
                const double middle = 0.5 * (one + other);
                const double time = flips({{middle, theta2}}, {}, spec)[0];
                const bool like_one = std::abs(time - times[0]) < std::abs(time - times[1]) || time == times[0];
                (like_one ? one : other) = middle;
                times[like_one ? 0 : 1] = time;
            }
            if (!(std::abs(times[0] - times[1]) > 0.2)) continue;  // a continuous change
            ++edges;
            for (const double theta : {one, other}) {
                const double time = flips({{theta, theta2}}, {}, spec)[0];
                const double exact = reference_flip(released({}, {theta, theta2}), 5, 1e-13);
                EXPECT_LT(time == exact ? 0 : std::abs(time - exact), 1e-8) << theta << ' ' << theta2;  // measured 2e-9
            }
        }
    EXPECT_GT(edges, 30);
}

TEST(Flips, OfMirrorImagesComeAtTheSameTimeToTheLastBit) {
    const auto releases = some_releases(1000);
    auto mirrored = releases;
    for (auto& [theta1, theta2] : mirrored) theta1 = -theta1, theta2 = -theta2;
    EXPECT_EQ(flips(mirrored), flips(releases));
    EXPECT_EQ(flips(mirrored, uneven()), flips(releases, uneven()));
}

TEST(Flips, AreTheSameToTheLastBitAtEveryWidthAndInEveryGrouping) {
    std::mt19937 random(5);
    std::vector<Pendulum<double>> all(301);
    for (auto& p : all) {
        p = random_pendulum(random);
        p.gravity /= 2;
        for (auto& rate : p.rate) rate *= 0.6;
    }
    const auto flips_of = [](std::span<const Pendulum<double>> some, int width = 0) {
        std::vector<double> times(some.size());
        first_flips(some, {}, times, false, width);
        return times;
    };
    const auto times = flips_of(all);
    EXPECT_GT(std::count_if(times.begin(), times.end(), [](double t) { return t < never; }), 100);
    for (const int width : register_widths()) EXPECT_EQ(flips_of(all, width), times) << width;
    for (const std::size_t group : {1u, 7u})
        for (std::size_t first = 0; first < all.size(); first += group) {
            const auto found = flips_of(std::span(all).subspan(first, std::min(group, all.size() - first)));
            for (std::size_t i = 0; i < found.size(); ++i) ASSERT_EQ(found[i], times[first + i]) << group;
        }
    for (std::size_t i = 0; i < 57; ++i) {
        const double reference = reference_flip(all[i], 20, 1e-13);
        EXPECT_EQ(std::isfinite(times[i]), std::isfinite(reference)) << i;
        EXPECT_NEAR(std::isfinite(reference) ? times[i] - reference : 0, 0, 1e-4) << i;  // measured 2.2e-5
    }
}

TEST(Flips, HaveATimeWithinTheDurationOrNone) {
    std::vector<Release> grid;
    for (int i = -12; i <= 12; ++i)
        for (int j = -12; j <= 12; ++j) grid.push_back({radians(15 * i), radians(15 * j)});
    for (const double time : flips(grid, {}, {.duration = 3}))
        EXPECT_TRUE((time >= 0 && time <= 3) || time == never) << time;
    // the duration does not change a flip; a flip after it does not count
    const double time = flips({{2.5, 1}})[0];
    EXPECT_EQ(flips({{2.5, 1}}, {}, {.duration = std::nextafter(time, 0)})[0], never);
    EXPECT_EQ(flips({{2.5, 1}}, {}, {.duration = std::nextafter(time, 9)})[0], time);
    EXPECT_EQ(flips({{3.2, 0}, {0, -3.2}}), (std::vector<double>{0, 0}));
    for (const Release& beyond : {Release{3.2, 0}, Release{0, -3.2}})
        EXPECT_EQ(reference_flip(released({}, beyond), 1, 1e-12), 0);
    EXPECT_EQ(flips({}), std::vector<double>());
}

ExitCode refusal(const Pendulum<double>& p, const FlipSpec& spec, std::size_t times, bool stop = false, int width = 0) {
    std::vector<double> found(times);
    return test::thrown_by([&] { first_flips(all_released(p, {{2, 2}, {2.5, 1}}), spec, found, stop, width); }).first;
}

TEST(Flips, FailedOnesAreNaNAndDoNotAffectOthers) {
    // such strong gravity that a swing takes 1e-15 s
    const auto calm = released({}, {2.5, 1});
    auto wild = calm;
    wild.gravity = 1e30;
    const std::vector<Pendulum<double>> all{calm, wild, calm};
    std::vector<double> times(all.size());
    first_flips(all, {}, times, false);
    EXPECT_TRUE(std::isnan(times[1])) << times[1];
    EXPECT_EQ(times[0], flips({{2.5, 1}})[0]);
    EXPECT_EQ(times[2], times[0]);
}

TEST(Flips, AreNotSearchedWhereForbidden) {
    Pendulum<double> triple;
    triple.mass = triple.length = triple.angle = triple.rate = {1, 1, 1};
    EXPECT_EQ(refusal({}, {}, 2), ExitCode::done);
    EXPECT_EQ(refusal(triple, {}, 2), ExitCode::bad_input);
    EXPECT_EQ(refusal({}, {}, 1), ExitCode::bad_input);
    EXPECT_EQ(refusal({}, {.duration = never}, 2), ExitCode::bad_input);
    EXPECT_EQ(refusal({}, {.duration = 0}, 2), ExitCode::bad_input);
    EXPECT_EQ(refusal({}, {.tolerance = 0}, 2), ExitCode::bad_input);
    EXPECT_EQ(refusal({}, {}, 2, false, 3), ExitCode::bad_input);
    EXPECT_EQ(refusal({}, {}, 2, true), ExitCode::interrupted);
}

}  // namespace doppel::flip_test
