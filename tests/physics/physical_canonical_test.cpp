#include "physics/physical_canonical.hpp"

#include "allocations.hpp"
#include "base/error.hpp"
#include "numeric/quad.hpp"
#include "physics/bob.hpp"
#include "physics/physical_pendulums.hpp"

#include <gtest/gtest.h>

namespace doppel {
namespace physical_canonical_test {

using Model = PhysicalChain<Quad>;
using State = Model::State;

double largest(const State& y) {
    return static_cast<double>(Quad(y.cwiseAbs().maxCoeff()));
}

/// A chain, its Hamilton's form and its start.
struct Form {
    PhysicalPendulum<Quad> p;
    Model model{p};
    Canonical<Model> form{model};
    State y = Model::start(p);

    explicit Form(const PhysicalPendulum<Quad>& pendulum) : p(pendulum) {}

    State momenta(const State& at) {
        State z = at;
        form.momenta(at, z);
        return z;
    }
    State velocities(const State& z) {
        State at = z;
        form.velocities(z, at);
        return at;
    }
    State rate(const State& at) {
        State dydt = at;
        model.rate(at, dydt);
        return dydt;
    }
    State hamilton(const State& z) {
        Canonical<Model>::Angles angles;
        State dzdt = z;
        form.rate(z, angles, dzdt);
        return dzdt;
    }
    Energies<Quad> energies(const State& at) const {
        const PivotPlace<Quad> pivot(p.pivot, model.layout.time_of(at));
        auto bobs = bobs_of_angles<Quad>(p.chain, model.layout.of_links(at));
        for (auto& bob : bobs) {
            bob.x += pivot.place.x;
            bob.y += pivot.place.y;
            bob.vx += pivot.velocity.x;
            bob.vy += pivot.velocity.y;
        }
        return doppel::energies(p, bobs, {Quad(0), pivot.place.x, pivot.place.y, pivot.velocity.x, pivot.velocity.y});
    }
};

std::vector<PhysicalPendulum<Quad>> cases() {
    return {bodies<Quad>(1), bodies<Quad>(4), driven_bodies<Quad>(1), driven_bodies<Quad>(4)};
}

TEST(PhysicalCanonical, MomentaAreTheSlopesOfKineticEnergy) {
    // T is a square in ω, so central differences are exact
    for (const auto& p : cases()) {
        Form f(p);
        const auto z = f.momenta(f.y);
        const auto half = f.model.layout.half;
        for (Eigen::Index i = 0; i < f.model.layout.coordinates; ++i) {
            auto less = f.y, more = f.y;
            less[half + i] -= Quad(1);
            more[half + i] += Quad(1);
            const Quad slope = (f.energies(more).kinetic - f.energies(less).kinetic) / Quad(2);
            EXPECT_LT(static_cast<double>(abs(Quad(slope - z[half + i]))), 2e-32);  // measured 2.3e-33
        }
    }
}

TEST(PhysicalCanonical, VelocitiesComeBack) {
    for (const auto& p : cases()) {
        Form f(p);
        EXPECT_LT(largest(f.velocities(f.momenta(f.y)) - f.y), 2e-32);  // measured 2e-33
    }
}

TEST(PhysicalCanonical, IsTheModelsMotion) {
    // dz/dt along the motion of the model in (θ, ω), by differences; time and work too
    for (const auto& p : cases()) {
        Form f(p);
        const Quad step(1e-11);
        const State move = step * f.rate(f.y);
        const State along = (f.momenta(f.y + move) - f.momenta(f.y - move)) / (Quad(2) * step);
        EXPECT_LT(largest(along - f.hamilton(f.momenta(f.y))), 3e-19);  // measured 2.7e-20
    }
}

TEST(PhysicalCanonical, OfPointMassesIsTheAngleChain) {
    const auto chain = bodies<Quad>(3).chain;
    Form f(physical(chain));
    AngleChain<Quad, Eigen::Dynamic> points(chain);
    Canonical<AngleChain<Quad, Eigen::Dynamic>> form(points);
    State z = f.y, dzdt = f.y;
    form.momenta(f.y, z);
    EXPECT_LT(largest(f.momenta(f.y) - z), 4e-33);  // measured 4e-34
    Canonical<AngleChain<Quad, Eigen::Dynamic>>::Angles angles;
    form.rate(z, angles, dzdt);
    EXPECT_LT(largest(f.hamilton(z) - dzdt), 5e-32);  // measured 5e-33
}

TEST(PhysicalCanonical, RefusesJointsThatStick) {
    auto p = bodies<Quad>(2);
    p.friction.coulomb = {Quad(0.1), Quad(0)};
    try {
        Form f(p);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::bad_input);
        EXPECT_NE(std::string(error.what()).find("Coulomb"), std::string::npos);
    }
}

TEST(PhysicalCanonical, AsksForNoMemory) {
    using Plain = PhysicalChain<double>;
    const auto p = driven_bodies<double>(4);
    Plain model(p);
    Canonical<Plain> form(model);
    Canonical<Plain>::Angles angles;
    Plain::State z = Plain::start(p), dzdt = z;
    form.rate(z, angles, dzdt);
    const long before = allocations();
    for (int i = 0; i < 10; ++i) form.rate(z, angles, dzdt);
    EXPECT_EQ(allocations() - before, 0);
}

}  // namespace physical_canonical_test
}  // namespace doppel
