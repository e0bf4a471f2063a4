#include "allocations.hpp"
#include "errors.hpp"
#include "integrate/angle_series.hpp"
#include "integrate/flow.hpp"
#include "integrate/lane_series.hpp"
#include "integrate/taped_series.hpp"
#include "integrate/taylor.hpp"
#include "integrate/widths.hpp"
#include "numeric/quad.hpp"
#include "physics/mechanisms.hpp"
#include "physics/pendulums.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace doppel::taylor_series_test {

using namespace counted;

static_assert(HasSeries<Mechanism<double>> && HasSeries<Projected<Mechanism<Quad>>>);
static_assert(!HasSeries<Baumgarte<Mechanism<double>>>);

template <class Scalar>
using Vector = State<Scalar, Eigen::Dynamic>;

/// Residual of the equations of motion along a series from `start`, |y′(h) − f(y(h))|, which shrinks with a power of h
/// only if every coefficient is correct. In quad; y′ by central differences.
template <class Model>
double residual(Model& model, const typename Model::State& start, int order, double h) {
    const auto series = series_of(model, order);
    series->expand(start);
    const auto moved = [&](const Quad& by) {
        Vector<Quad> change = start;
        series->move(by, change);
        return typename Model::State(start + change);
    };
    const Quad at(h), d(1e-9);
    typename Model::State rate = start;
    model.rate(moved(at), rate);
    rate -= (Quad(8) * (moved(at + d) - moved(at - d)) - (moved(at + d + d) - moved(at - d - d))) / (Quad(12) * d);
    double worst = 0;
    for (const Quad& difference : rate) worst = greater(worst, std::abs(static_cast<double>(difference)));
    return worst;
}

/// Expects that the residual at h shrinks as h^(order + more), to `within`.
template <class Model>
void expect_orders(Model& model, const typename Model::State& start, int most, double h, int more, double within) {
    for (int order = 1; order <= most; ++order) {
        const double ratio = residual(model, start, order, 2 * h) / residual(model, start, order, h);
        EXPECT_NEAR(std::log2(ratio), order + more, within) << order;
    }
}

template <class Model>
void expect_series_solves(const Pendulum<double>& p, int more = 0) {
    Model model(p.cast<Quad>());
    expect_orders(model, Model::start(p.cast<Quad>()), 10, 4e-3, more, 0.25);  // measured within 0.09
}

TEST(TaylorSeries, SolvesTheEquationsOfMotionOrderByOrder) {
    expect_series_solves<AngleChain<Quad, 2>>(uneven(2));
    expect_series_solves<AngleChain<Quad, 3>>(uneven(3));
    expect_series_solves<AngleChain<Quad, Eigen::Dynamic>>(uneven(1));
    expect_series_solves<AngleChain<Quad, Eigen::Dynamic>>(uneven(6));
    expect_series_solves<DoublePendulum<Quad>>(uneven(2));
    expect_series_solves<RodChain<Quad, 2>>(uneven(2), 1);
    expect_series_solves<RodChain<Quad, Eigen::Dynamic>>(uneven(5), 1);
}

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

TEST(MechanismSeries, SolvesTheEquationsOfMotionOrderByOrder) {
    for (const auto& parts : {sprung(), attracted(), looped()}) {
        check(parts);
        const auto assembly = parts.cast<Quad>();
        Mechanism<Quad> model(assembly);
        // the four bars move: their velocities must be consistent
        expect_orders(model, after(model, assembly, 10, Quad(0.005)), 8, 2e-3, 1, 0.2);  // measured within 0.1
    }
}

TEST(MechanismSeries, AllocatesNothingOnceItIsRecorded) {
    const auto allocated = []<class S>(const Assembly<S>& assembly) {
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
    EXPECT_EQ(allocated(of_everything()), 0);
    EXPECT_EQ(allocated(of_everything().cast<Quad>()), 0);
}

/// Drag changes its direction.
TEST(TapedSeries, AllocatesNothingAtEventsLikeEarlierOnes) {
    auto bodies = driven_bodies<double>(2);
    bodies.friction.link_quadratic = {0.1, 0.1};
    PhysicalChain<double> model(bodies);
    const auto series = series_of(model, 20);
    auto y = model.start(bodies), change = y;
    constexpr double longest = 0.03;
    int events = 0;
    long before = 0;
    for (int steps = 0; steps < 180; ++steps) {
        if (steps == 60) before = allocations(), events = 0;
        series->expand(y);
        const double h = series->first_event(longest);
        series->move(h, change);
        y += change;
        events += h < longest;
    }
    EXPECT_EQ(allocations() - before, 0);  // there were some 50 a step
    EXPECT_EQ(events, 9);
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
    check(parallelogram());
    EXPECT_EQ(said_of(parallelogram(), 0.08), "no error");
    for (const double h : {0.15, 0.2, 0.25}) {
        const auto said = said_of(parallelogram(), h);
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

/// Coefficient k of the rates: the difference between the series of orders k and k − 1, at h = 1.
template <class Series, class Scalar>
Vector<Scalar> coefficient(const Pendulum<Scalar>& p, const Vector<Scalar>& y, int k) {
    Series with(p, k), without(p, k - 1);
    auto one = y, other = y;
    with.expand(y);
    with.move(Scalar(1), one);
    without.expand(y);
    without.move(Scalar(1), other);
    return (one - other).tail(y.size() / 2);
}

TEST(TaylorSeries, LanesHaveTheSameCoefficients) {
    for (const std::size_t links : {2u, 3u}) {
        const auto p = uneven(links);
        const Vector<double> y = released_in_angles<double, Eigen::Dynamic>(p);
        for (int k = 2; k <= 24; ++k) {
            const auto quad = coefficient<AngleSeries<Quad>>(p.cast<Quad>(), Vector<Quad>(y.cast<Quad>()), k);
            const Vector<double> exact = quad.cast<double>();
            const double within = 1e-12 * exact.cwiseAbs().maxCoeff();
            EXPECT_LT((coefficient<LaneSeries>(p, y, k) - exact).cwiseAbs().maxCoeff(), within) << k;  // measured 1e-13
            EXPECT_LT((coefficient<AngleSeries<double>>(p, y, k) - exact).cwiseAbs().maxCoeff(), within)
                << k;  // measured 2e-13
        }
    }
}

TEST(TaylorSeries, GivesTheSameBitsWithTwoLanesAndFour) {
    for (const std::size_t links : {2u, 3u}) {
        const auto p = uneven(links);
        const Vector<double> y = released_in_angles<double, Eigen::Dynamic>(p);
        for (int order : {5, 8, 13, 24, 33}) {
            LaneSeries wide(p, order, std::min(register_widths().back(), 4)), narrow(p, order, 2);
            Vector<double> one = y, other = y;
            wide.expand(y);
            wide.move(0.02, one);
            narrow.expand(y);
            narrow.move(0.02, other);
            EXPECT_EQ(std::memcmp(one.data(), other.data(), sizeof(double) * static_cast<std::size_t>(y.size())), 0);
            for (int k = 0; k <= order; ++k) EXPECT_EQ(wide.size(k), narrow.size(k));
        }
    }
}

}  // namespace doppel::taylor_series_test
