// What goes on from another state keeps its step: for motions whose tangents are made orthonormal again and again.

#include "integrate/dormand_prince.hpp"
#include "integrate/pendulums.hpp"
#include "physics/angle_chain.hpp"

#include <gtest/gtest.h>

namespace doppel {
namespace reset_test {

using Model = DoublePendulum<double>;

template <class Which>
class Reset : public testing::Test {};
using Methods = testing::Types<Dopri5, Dop853>;
TYPED_TEST_SUITE(Reset, Methods);

TYPED_TEST(Reset, GoesOnFromAnotherStateByTheStepsItHad) {
    const auto p = uneven(2);
    Model model(p);
    const auto start = Model::start(p);
    const auto end_of = [&](double tolerance) {
        typename TypeParam::template Stepper<Model> stepper(model, start, tolerance);
        stepper.advance(1.1);
        return stepper.state();
    };
    typename TypeParam::template Stepper<Model> stepper(model, start, 1e-8);
    stepper.advance(1.1);
    const long steps = stepper.steps();
    stepper.reset(start);
    EXPECT_EQ(stepper.state(), start);
    stepper.advance(0.01);
    EXPECT_EQ(stepper.steps(), steps + 1);  // a beginning takes dopri5 two
    stepper.advance(1.09);
    EXPECT_LT((stepper.state() - end_of(1e-14)).norm(), 5e-7);  // measured 8e-8
}

}  // namespace reset_test
}  // namespace doppel
