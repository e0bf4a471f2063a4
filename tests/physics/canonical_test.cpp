#include "physics/canonical.hpp"

#include "numeric/quad.hpp"
#include "physics/bob.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace doppel {
namespace canonical_test {

/// A pendulum with everything unequal, in motion, drawn from a seed.
Pendulum<Quad> random_pendulum(int links, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> size(0.3, 3), angle(-3, 3), rate(-5, 5);
    Pendulum<Quad> p{{}, {}, {}, {}, Quad(9.8)};
    for (int i = 0; i < links; ++i) {
        p.mass.push_back(Quad(size(random)));
        p.length.push_back(Quad(size(random)));
        p.angle.push_back(Quad(angle(random)));
        p.rate.push_back(Quad(rate(random)));
    }
    return p;
}

/// A model with its Hamilton's form, and what is asked of both.
template <class Model>
struct Forms {
    using State = typename Model::State;

    Pendulum<Quad> p;
    Model model{p};
    Canonical<Model> form{model};

    explicit Forms(const Pendulum<Quad>& pendulum) : p(pendulum) {}

    State momenta(const State& y) {
        State z = y;
        form.momenta(y, z);
        return z;
    }
    State velocities(const State& z) {
        State y = z;
        form.velocities(z, y);
        return y;
    }
    State hamilton(const State& z) {
        typename Canonical<Model>::Angles angles;
        State dzdt = z;
        form.rate(z, angles, dzdt);
        return dzdt;
    }
    State rate(const State& y) {
        State dydt = y;
        model.rate(y, dydt);
        return dydt;
    }
    Quad energy(const State& y) const { return doppel::energy(bobs_of_angles<Quad>(p, y), p.gravity); }
};

template <class State>
double largest(const State& y) {
    return static_cast<double>(Quad(y.cwiseAbs().maxCoeff()));
}

template <class Model>
class CanonicalForm : public testing::Test {};
using Models =
    testing::Types<DoublePendulum<Quad>, AngleChain<Quad, 2>, AngleChain<Quad, 3>, AngleChain<Quad, Eigen::Dynamic>>;
TYPED_TEST_SUITE(CanonicalForm, Models);

template <class Model>
Forms<Model> forms(unsigned seed) {
    constexpr int size = std::is_same_v<Model, DoublePendulum<Quad>> ? 4 : Model::State::RowsAtCompileTime;
    return Forms<Model>(random_pendulum(size == Eigen::Dynamic ? 5 : size / 2, seed));
}

TYPED_TEST(CanonicalForm, MomentaAreTheSlopesOfKineticEnergy) {
    // T is a square in ω, so central differences are exact
    auto f = forms<TypeParam>(1);
    const auto y = TypeParam::start(f.p);
    const auto z = f.momenta(y);
    const auto n = y.size() / 2;
    for (Eigen::Index i = 0; i < n; ++i) {
        auto less = y, more = y;
        less[n + i] -= Quad(1);
        more[n + i] += Quad(1);
        const Quad slope = (f.energy(more) - f.energy(less)) / Quad(2);
        EXPECT_LT(static_cast<double>(abs(slope - z[n + i])), 5e-31);  // measured 1e-31
        EXPECT_EQ(z[i], y[i]);
    }
}

TYPED_TEST(CanonicalForm, VelocitiesComeBack) {
    auto f = forms<TypeParam>(2);
    const auto y = TypeParam::start(f.p);
    EXPECT_LT(largest((f.velocities(f.momenta(y)) - y).eval()), 3e-32);  // measured 3e-33
}

TYPED_TEST(CanonicalForm, IsHamiltonsEquations) {
    // θ′ = ∂H/∂p, p′ = −∂H/∂θ with H(z) = the energy of the bobs
    auto f = forms<TypeParam>(3);
    const auto z = f.momenta(TypeParam::start(f.p));
    const auto rate = f.hamilton(z);
    const auto n = z.size() / 2;
    const Quad step(1e-11);
    for (Eigen::Index i = 0; i < 2 * n; ++i) {
        auto less = z, more = z;
        less[i] -= step;
        more[i] += step;
        const Quad slope = (f.energy(f.velocities(more)) - f.energy(f.velocities(less))) / (Quad(2) * step);
        const Quad expected = i < n ? Quad(-rate[n + i]) : Quad(rate[i - n]);
        EXPECT_LT(static_cast<double>(abs(slope - expected)), 3e-19) << i;  // measured 6e-20
    }
}

TYPED_TEST(CanonicalForm, IsTheModelsMotion) {
    // dz/dt along the motion of the model in (θ, ω), by differences
    auto f = forms<TypeParam>(4);
    const auto y = TypeParam::start(f.p);
    const Quad step(1e-11);
    const auto move = (step * f.rate(y)).eval();
    const auto along = ((f.momenta(y + move) - f.momenta(y - move)) / (Quad(2) * step)).eval();
    EXPECT_LT(largest((along - f.hamilton(f.momenta(y))).eval()), 3e-20);  // measured 5e-21
}

TEST(Canonical, ClosedFormOfTwoLinksIsTheChain) {
    const auto p = random_pendulum(2, 5);
    Forms<DoublePendulum<Quad>> closed(p);
    Forms<AngleChain<Quad, 2>> chain(p);
    const auto y = released_in_angles<Quad, 2>(p);
    EXPECT_LT(largest((closed.momenta(y) - chain.momenta(y)).eval()), 5e-33);    // measured 0
    EXPECT_LT(largest((closed.hamilton(y) - chain.hamilton(y)).eval()), 5e-33);  // measured 8e-34
}

/// The largest error of a turning angle on a walk whose steps are `step`, in units of ε.
template <class Scalar>
double error_of_turning(double step) {
    NearbyAngle<Scalar> turning;
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

TEST(NearbyAngle, IsSineAndCosineToRounding) {
    for (const double step : {1.0, 1.2e-2, 1e-3, 1e-6}) {
        EXPECT_LT(error_of_turning<double>(step), 1.0) << step;       // measured 0.84
        EXPECT_LT(error_of_turning<Quad>(step * 1e-3), 1.6) << step;  // measured 0.75, against sines as rounded
    }
}

TEST(NearbyAngle, StaysExactlyDown) {
    NearbyAngle<double> turning;
    EXPECT_EQ(turning.at(0.0).sin, 0.0);
    EXPECT_EQ(turning.at(0.0).cos, 1.0);
}

}  // namespace canonical_test
}  // namespace doppel
