#include "integrate/gauss.hpp"

#include "errors.hpp"
#include "integrate/flow.hpp"
#include "integrate/pendulums.hpp"
#include "integrate/runge_kutta.hpp"
#include "numeric/quad.hpp"
#include "physics/bob.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel {
namespace gauss_test {

using Angles = DoublePendulum<double>;

/// The difference between SᵀJS and J; S is the Jacobian of one step in canonical variables, by differences in Quad.
template <class Which, class Model>
double symplecticity_error(const Quad& step) {
    const auto p = unequal<Quad>();
    Model model(p);
    Canonical<Model> form(model);
    using State = typename Model::State;
    const auto one = [&](const State& z) {
        State y = z;
        form.velocities(z, y);
        const State end = after<Which, Model>(p, y, step, 1);
        State z1 = end;
        form.momenta(end, z1);
        return z1;
    };
    State z = Model::start(p);
    form.momenta(State(z), z);
    return doppel::symplecticity_error(one, z);
}

TEST(Gauss, IsSymplectic) {
    const Quad step(0.1);
    EXPECT_LT((symplecticity_error<Gauss4, DoublePendulum<Quad>>(step)), 2e-22);  // measured 2e-23
    EXPECT_LT((symplecticity_error<Gauss6, DoublePendulum<Quad>>(step)), 2e-22);  // measured 2e-23
    EXPECT_LT((symplecticity_error<Gauss6, AngleChain<Quad, 2>>(step)), 2e-22);   // measured 2.7e-23
    EXPECT_GT((symplecticity_error<Rk4, DoublePendulum<Quad>>(step)), 1e-6);      // measured 3e-4
}

TEST(Gauss, ReturnsWhenTimeIsReversed) {
    EXPECT_LT((way_back<Gauss4, Angles>(0.02, 100)), 5e-15);  // measured 9.4e-16
    EXPECT_LT((way_back<Gauss6, Angles>(0.02, 100)), 1e-15);  // measured 1.9e-16
    EXPECT_GT((way_back<Rk4, Angles>(0.02, 100)), 1e-6);      // measured 5e-5
}

TEST(Gauss, KeepsEnergyOverAHundredThousandPeriods) {
    // the slow mode of 30/0 has a period of 1.9 s: a run of 1.9e5 s in steps of 0.1 s
    const auto gauss = errors_of<Gauss4, Angles>(released(30, 0), 0.1, 1'900'000);
    EXPECT_LT(gauss.late, 1.5 * gauss.early);  // measured 1.25
    EXPECT_LT(gauss.late, 2e-3);               // measured 9e-4 J
}

TEST(Gauss, HasNoEnergyDriftFromRounding) {
    // with steps so short that truncation is negligible, the rest is round-off, which must grow as a random walk
    const auto errors = errors_of<Gauss6, Angles>(released(30, 0), 1.0 / 512, 1'000'000);
    EXPECT_LT(errors.late, 4e-14);  // measured 7e-15 J of 30; 3e-13 without compensation, 2e-13 with a loose iteration
}

TEST(Gauss, FailsIfTheStepIsTooLong) {
    using Model = DoublePendulum<double>;
    const auto p = unequal<double>();
    const auto [code, text] = test::thrown_by([&] { after<Gauss6, Model>(p, Model::start(p), 3.0, 10); });
    EXPECT_EQ(code, ExitCode::method_failed);
    EXPECT_EQ(text.rfind("gauss6: step ", 0), 0u) << text;
    EXPECT_NE(text.find("choose a smaller step_s than 3"), std::string::npos) << text;
}

}  // namespace gauss_test
}  // namespace doppel
