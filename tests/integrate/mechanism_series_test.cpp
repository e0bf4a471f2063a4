#include "allocations.hpp"
#include "errors.hpp"
#include "integrate/taped_series.hpp"
#include "integrate/taylor.hpp"
#include "numeric/quad.hpp"
#include "physics/mechanism.hpp"
#include "physics/mechanisms.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel {
namespace mechanism_series_test {

using namespace counted;

static_assert(HasSeries<Mechanism<double>> && HasSeries<Projected<Mechanism<Quad>>>);
static_assert(!HasSeries<Baumgarte<Mechanism<double>>>);

/// A bob on a rod with a spring to a second bob, which slides in a circular slot; both have springs to other particles.
Assembly<double> sprung() {
    return {.particles = {{1.3, P(0.6, -0.8), P(0.8, 0.6)}, {0.7, P(2, 0.5), P(0, 1.1)}, {0.4, P(0.4, 1.2), P(-1, 0)}},
            .constraints = {Rod<double>{one, P(0, 0), 1}, SlotCircle<double>{two, P(1, 0.5), 1}},
            .forces = {Gravity<double>{}, Spring<double>{one, two, 5, 1.1, 0.3}, Spring<double>{three, P(0, 2), 7, 0},
                       Spring<double>{three, one, 3, 0.4, 0.2}}};
}

/// Two beads in straight slots, and a bob on a rod from an anchored particle, all with mutual attraction.
Assembly<double> attracted() {
    return {
        .particles = {{2, P(0, 0), P(1, 0.5)}, {3, P(1.5, -1), P(1, 0)}, {1, P(1.5, 0.2)}, {1, P(0, 2.2), P(1, 0.75)}},
        .constraints = {SlotLine<double>{one, P(0, 0), P(2, 1)}, SlotLine<double>{two, P(0, -1), P(3, 0)},
                        Anchor<double>{three, P(1.5, 0.2)}, Rod<double>{three, four, 2.5}},
        .forces = {Attraction<double>{one, four, 4}, Attraction<double>{two, one, 1.5},
                   Droplet<double>{P(3, 3), 5, 0.8}, Gravity<double>{3}}};
}

/// A four-bar loop with a rod hanging from it, braced by a damped spring.
Assembly<double> looped() {
    auto parts = four_bars();
    parts.particles.push_back({0.5, P(2.9, 0.6), P(0.5, 0)});
    parts.constraints.push_back(Rod<double>{5 - 1, three, 0.6});
    parts.forces.push_back(Spring<double>{two, P(2, 0), 20, 1, 0.5});
    return parts;
}

/// The four bars move: their velocities must be consistent.
template <class S>
State<S, Eigen::Dynamic> moving(Mechanism<S>& model, const Assembly<S>& assembly, const S& seconds) {
    return after(model, assembly, 10, S(seconds / S(10)));
}

/// Residual of the equations of motion along a series, |y′(h) − f(y(h))|. It shrinks as h^(order + 1) only if every
/// coefficient is correct. In quad; y′ by central differences.
double residual(const Assembly<double>& parts, int order, double h) {
    const auto assembly = parts.cast<Quad>();
    Mechanism<Quad> model(assembly);
    const auto start = moving(model, assembly, Quad(0.05));
    MechanismSeries<Quad> series(assembly, order);
    series.expand(start);
    const auto moved = [&](const Quad& by) {
        auto change = start;
        series.move(by, change);
        return State<Quad, Eigen::Dynamic>(start + change);
    };
    const Quad at(h), d(1e-9);
    auto rate = start;
    model.rate(moved(at), rate);
    rate -= (Quad(8) * (moved(at + d) - moved(at - d)) - (moved(at + d + d) - moved(at - d - d))) / (Quad(12) * d);
    double worst = 0;
    for (const Quad& difference : rate) worst = greater(worst, std::abs(static_cast<double>(difference)));
    return worst;
}

TEST(MechanismSeries, SolvesTheEquationsOfMotionOrderByOrder) {
    for (const auto& parts : {sprung(), attracted(), looped()}) {
        check(parts);
        for (int order : {1, 2, 3, 4, 5, 6, 7, 8}) {
            const double h = 2e-3, ratio = residual(parts, order, 2 * h) / residual(parts, order, h);
            EXPECT_NEAR(std::log2(ratio), order + 1, 0.2) << order;  // measured within 0.1
        }
    }
}

TEST(MechanismSeries, AllocatesNothingOnceItIsRecorded) {
    for (const auto& parts : {sprung(), attracted(), looped()}) {
        const auto allocated = [](const auto& assembly) {
            using S = std::decay_t<decltype(assembly.particles[0].mass)>;
            MechanismSeries<S> series(assembly, 20);
            auto y = Mechanism<S>::start(assembly), change = y;
            series.expand(y);
            series.move(S(0.02), change);
            y += change;
            const long before = allocations();
            series.move(S(0.01), change);
            series.expand(y);
            return allocations() - before;
        };
        EXPECT_EQ(allocated(parts), 0);
        EXPECT_EQ(allocated(parts.cast<Quad>()), 0);
    }
}

/// The error message of a series that runs from the start of a mechanism.
std::string said_of(const Assembly<double>& parts, double h) {
    MechanismSeries<double> series(parts, 30);
    auto y = Mechanism<double>::start(parts), change = y;
    const auto [code, said] = test::thrown_by([&] {
        series.expand(y);
        series.move(h, change);
    });
    EXPECT_TRUE(code == ExitCode::method_failed || code == ExitCode::done);
    return said;
}

TEST(MechanismSeries, NamesASingularConfigurationOnTheWay) {
    // cranks of 1 m, a coupler of 2 m: aligned after about 0.09 s, where two continuations are possible
    Assembly<double> parts{
        .particles = {{1, P(0.6, -0.8), P(6.4, 4.8)}, {1.5, P(2.6, -0.8), P(6.4, 4.8)}},
        .constraints = {Rod<double>{one, P(0, 0), 1}, Rod<double>{two, P(2, 0), 1}, Rod<double>{one, two, 2}},
        .forces = {Gravity<double>{}}};
    check(parts);
    EXPECT_EQ(said_of(parts, 0.08), "no error");
    for (const double h : {0.15, 0.2, 0.25}) {
        const auto said = said_of(parts, h);
        EXPECT_EQ(said.substr(0, said.find("; the particles are at (1, ")),
                  "singular configuration: constraint 3 (rod 1–2) now follows from constraints 1 and 2, so the "
                  "forces are not determined");
    }
}

TEST(MechanismSeries, PassesNearASingularConfiguration) {
    // a light bob above a heavy one, passing the position where both rods are aligned
    for (const double light : {1e-2, 1e-4, 1e-6}) {
        Assembly<double> parts{
            .particles = {{light, P(-0.05, -1), P(1, -0.05)}, {1, P(0, -2), P(2, 0)}},
            .constraints = {Rod<double>{one, P(0, 0), std::hypot(0.05, 1)}, Rod<double>{two, one, std::hypot(0.05, 1)}},
            .forces = {}};
        EXPECT_EQ(said_of(parts, 0.12), "no error") << light;
    }
}

TEST(MechanismSeries, NamesASpringWhoseEndsMeet) {
    Assembly<double> parts{.particles = {{1, P(1, 1)}}, .constraints = {}, .forces = {Gravity<double>{}}};
    parts.forces.push_back(Spring<double>{one, P(1, 1), 5, 0});
    EXPECT_EQ(said_of(parts, 0.1), "no error");  // its stiffness is 5 N/m in any direction
    parts.forces.push_back(Spring<double>{one, P(1, 1), 5, 1});
    EXPECT_EQ(said_of(parts, 0.1),
              "force 2 (spring 1–fixed): its ends are at the same place, where its direction is undefined; choose a "
              "start that does not lead there");
}

}  // namespace mechanism_series_test
}  // namespace doppel
