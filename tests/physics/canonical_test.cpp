#include "physics/canonical.hpp"

#include "numeric/quad.hpp"
#include "physics/oracles.hpp"
#include "physics/pendulums.hpp"

#include <gtest/gtest.h>

namespace doppel::canonical_test {

using Angles = AngleChain<Quad, Eigen::Dynamic>;
using Bodies = PhysicalChain<Quad>;

/// The index of the first rate in a state, and the number of rates.
template <class Model>
std::pair<Eigen::Index, Eigen::Index> rates_of(const Model&, const typename Model::State& y) {
    return {y.size() / 2, y.size() / 2};
}
std::pair<Eigen::Index, Eigen::Index> rates_of(const Bodies& model, const Bodies::State&) {
    return {model.layout.half, model.layout.coordinates};
}

template <class Model>
Quad energy_of(const Pendulum<Quad>& p, const Model&, const typename Model::State& y) {
    return energy(bobs_of_angles<Quad>(p, y), p.gravity);
}
Quad energy_of(const PhysicalPendulum<Quad>& p, const Bodies& model, const Bodies::State& y) {
    return configuration_of(p, model.layout.of_links(y), Quad(model.layout.time_of(y))).energy;
}

/// A model, its Hamiltonian form and its start.
template <class Model, class Description>
struct Form {
    using State = typename Model::State;

    Description p;
    Model model{p};
    Canonical<Model> form{model};
    State y = Model::start(p);

    explicit Form(const Description& description) : p(description) {}

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
    State hamilton(const State& z) {
        typename Canonical<Model>::Angles angles;
        State dzdt = z;
        form.rate(z, angles, dzdt);
        return dzdt;
    }
    State rate(const State& at) {
        State dydt = at;
        model.rate(at, dydt);
        return dydt;
    }
};

Pendulum<Quad> unequal(std::size_t links) {
    std::mt19937 random(4);
    return random_pendulum(random, links).cast<Quad>();
}

/// Calls check(form) for each model with a Hamiltonian form: chains of points and of rigid bodies, with a fixed or a
/// driven pivot.
template <class Check>
void for_each_form(const Check& check) {
    const auto named = [&](const char* name, auto form) {
        SCOPED_TRACE(name);
        check(form);
    };
    named("double pendulum", Form<DoublePendulum<Quad>, Pendulum<Quad>>(unequal(2)));
    named("five links", Form<Angles, Pendulum<Quad>>(unequal(5)));
    for (const std::size_t links : {1u, 4u}) {
        named("bodies", Form<Bodies, PhysicalPendulum<Quad>>(bodies<Quad>(links)));
        named("driven bodies", Form<Bodies, PhysicalPendulum<Quad>>(driven_bodies<Quad>(links)));
    }
}

template <class State>
double largest(const State& y) {
    return static_cast<double>(Quad(y.cwiseAbs().maxCoeff()));
}

TEST(Canonical, MomentaAreTheSlopesOfKineticEnergyAndVelocitiesComeBack) {
    // T is quadratic in ω, so central differences are exact
    for_each_form([](auto& f) {
        const auto z = f.momenta(f.y);
        const auto [first, count] = rates_of(f.model, f.y);
        for (Eigen::Index i = first; i < first + count; ++i) {
            auto less = f.y, more = f.y;
            less[i] -= Quad(1);
            more[i] += Quad(1);
            const Quad slope = (energy_of(f.p, f.model, more) - energy_of(f.p, f.model, less)) / Quad(2);
            EXPECT_LT(static_cast<double>(abs(Quad(slope - z[i]))), 1e-31) << i;  // measured 2.4e-32
            EXPECT_EQ(z[i - first], f.y[i - first]);
        }
        EXPECT_LT(largest((f.velocities(z) - f.y).eval()), 5e-32);  // measured 1e-32
    });
}

TEST(Canonical, IsTheModelsMotion) {
    // dz/dt along the motion of the model in (θ, ω), by differences; for rigid bodies also of time and work
    for_each_form([](auto& f) {
        const Quad step(1e-11);
        const auto move = (step * f.rate(f.y)).eval();
        const auto along = ((f.momenta(f.y + move) - f.momenta(f.y - move)) / (Quad(2) * step)).eval();
        EXPECT_LT(largest((along - f.hamilton(f.momenta(f.y))).eval()), 1e-18);  // measured 2.4e-19
    });
}

/// The largest error of a changing angle over steps of `step`, in units of ε.
template <class Scalar>
double error_of_turning(double step) {
    CachedSinCos<Scalar> turning;
    double worst = 0;
    Scalar angle(0.3);
    for (int i = 0; i < 1000; ++i) {
        const auto turned = turning.at(angle);
        const Quad wide(angle), s = sin(wide), c = cos(wide);
        const Quad error = abs(Quad(turned.sin) - s) + abs(Quad(turned.cos) - c);
        worst = std::max(worst, static_cast<double>(Quad(error / Quad(std::numeric_limits<Scalar>::epsilon()))));
        angle += Scalar(step);
    }
    return worst;
}

TEST(CachedSinCos, IsSineAndCosineToRounding) {
    for (const double step : {1.0, 1.2e-2, 1e-3, 1e-6}) {
        EXPECT_LT(error_of_turning<double>(step), 1.0) << step;       // measured 0.84
        EXPECT_LT(error_of_turning<Quad>(step * 1e-3), 1.6) << step;  // measured 0.75, against rounded sines
    }
    CachedSinCos<double> down;
    EXPECT_EQ(down.at(0.0).sin, 0.0);
    EXPECT_EQ(down.at(0.0).cos, 1.0);
}

}  // namespace doppel::canonical_test
