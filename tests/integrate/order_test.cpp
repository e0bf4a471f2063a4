// The error of every explicit method shrinks like step^order: measured in quad, where rounding does not hide it.

#include "integrate/adams.hpp"
#include "integrate/dormand_prince.hpp"
#include "integrate/euler.hpp"
#include "integrate/fixed_step.hpp"
#include "integrate/runge_kutta.hpp"
#include "numeric/quad.hpp"
#include "physics/angle_chain.hpp"
#include "physics/rod_chain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace doppel {
namespace order_test {

Pendulum<Quad> unequal() {
    return {
        {Quad(1), Quad(7) / 10}, {Quad(1), Quad(13) / 10}, {Quad(2), Quad(-1) / 2}, {Quad(0), Quad(1)}, Quad(98) / 10};
}

/// Half a second on, with steps of 2^-halvings s.
template <class Which, class Model>
typename Model::State after_half_a_second(int halvings) {
    Model model(unequal());
    typename Which::template Stepper<Model> stepper(model, Model::start(unequal()), ldexp(Quad(1), -halvings));
    stepper.advance(1L << (halvings - 1));
    return stepper.state();
}

struct Expected {
    int halvings;  // the coarser of the two steps is 2^-halvings s
    double within;
    double error;  // at the finer step, at most
};

template <class Which, class Model>
void measure(const typename Model::State& truth, const Expected& expected) {
    const auto error = [&](int halvings) {
        return static_cast<double>((after_half_a_second<Which, Model>(halvings) - truth).norm());
    };
    const double coarse = error(expected.halvings), fine = error(expected.halvings + 1);
    EXPECT_NEAR(std::log2(coarse / fine), Which::method.order, expected.within) << Which::method.name;
    EXPECT_LT(fine, expected.error) << Which::method.name;
}

template <class Model>
class Order : public testing::Test {};
using Models = testing::Types<DoublePendulum<Quad>, RodChain<Quad, 2>>;
TYPED_TEST_SUITE(Order, Models);

TYPED_TEST(Order, IsAsStated) {
    const auto truth = after_half_a_second<Fixed<Dop853>, TypeParam>(14);
    measure<Euler, TypeParam>(truth, {11, 0.02, 0.1});
    measure<SemiImplicitEuler, TypeParam>(truth, {11, 0.02, 0.1});
    measure<Midpoint, TypeParam>(truth, {10, 0.02, 2e-4});
    measure<Rk4, TypeParam>(truth, {10, 0.02, 2e-10});
    measure<Fixed<Dopri5>, TypeParam>(truth, {12, 0.02, 1e-16});
    measure<Fixed<Dop853>, TypeParam>(truth, {9, 0.05, 1e-20});
    measure<Fixed<Dop853>, TypeParam>(truth, {12, 0.05, 1e-27});
    measure<Adams, TypeParam>(truth, {13, 0.05, 1e-20});
}

/// Order of the interpolation: the error a quarter into the first step shrinks like step^(order + 1).
template <class Which>
double interpolation_order(double coarse_tolerance, double fine_tolerance) {
    using Model = DoublePendulum<Quad>;
    const auto measured = [](double tolerance) {
        Model model(unequal());
        const auto start = Model::start(unequal());
        typename Which::template Stepper<Model> stepper(model, start, Quad(tolerance));
        const Quad little = ldexp(Quad(1), -80);
        stepper.advance(little);
        const Quad step = stepper.smallest_step();
        stepper.advance(step / 4 - little);
        EXPECT_EQ(stepper.steps(), 1);
        AtFixedStep<Model, Dop853::pair> truth(model, start, step / 128);
        truth.advance(32);
        return std::pair(std::log(static_cast<double>((stepper.state() - truth.state()).norm())),
                         std::log(static_cast<double>(step)));
    };
    const auto [coarse_error, coarse_step] = measured(coarse_tolerance);
    const auto [fine_error, fine_step] = measured(fine_tolerance);
    return (coarse_error - fine_error) / (coarse_step - fine_step) - 1;
}

TEST(Interpolation, HasItsOrder) {
    EXPECT_NEAR(interpolation_order<Dopri5>(1e-10, 1e-14), 4, 0.02);
    EXPECT_NEAR(interpolation_order<Dop853>(1e-17, 1e-20), 7, 0.02);
}

// Butcher's conditions: for every rooted tree t of no more than `order` nodes Σ b_i φ_i(t) = 1/γ(t). A tree is the list
// of its branches; they come sorted, so that each tree comes once.

struct Tree {
    std::vector<Tree> branches;
    int nodes = 1;
};

void grow(int nodes, const std::vector<Tree>& smaller, std::size_t from, Tree& tree, std::vector<Tree>& found) {
    if (tree.nodes == nodes) found.push_back(tree);
    for (std::size_t i = from; i < smaller.size(); ++i) {
        if (tree.nodes + smaller[i].nodes > nodes) continue;
        tree.branches.push_back(smaller[i]);
        tree.nodes += smaller[i].nodes;
        grow(nodes, smaller, i, tree, found);
        tree.nodes -= smaller[i].nodes;
        tree.branches.pop_back();
    }
}

std::vector<Tree> trees_up_to(int nodes) {
    std::vector<Tree> all;
    for (int n = 1; n <= nodes; ++n) {
        std::vector<Tree> found;
        Tree root;
        grow(n, all, 0, root, found);
        all.insert(all.end(), found.begin(), found.end());
    }
    return all;
}

using Column = std::vector<Quad>;
struct Weights {
    std::vector<Column> a;
    Column b;
};

template <class Rows, class Row>
Weights weights_of(const Rows& a, const Row& b, std::size_t stages) {
    const auto all = [&](const auto& row) {
        Column made;
        for (std::size_t j = 0; j < stages; ++j) made.push_back(value<Quad>(row[j]));
        return made;
    };
    Weights weights;
    for (std::size_t i = 0; i < stages; ++i) weights.a.push_back(all(a[i]));
    weights.b = all(b);
    return weights;
}

Quad density(const Tree& tree) {
    Quad product(tree.nodes);
    for (const auto& branch : tree.branches) product *= density(branch);
    return product;
}

Column elementary_weights(const Weights& w, const Tree& tree) {
    Column phi(w.b.size(), Quad(1));
    for (const auto& branch : tree.branches) {
        const Column inner = elementary_weights(w, branch);
        for (std::size_t i = 0; i < phi.size(); ++i)
            phi[i] *= std::inner_product(w.a[i].begin(), w.a[i].end(), inner.begin(), Quad(0));
    }
    return phi;
}

/// The worst of the conditions that trees of `from` to `to` nodes pose.
double violation(const Weights& w, int from, int to) {
    double worst = 0;
    for (const auto& tree : trees_up_to(to)) {
        if (tree.nodes < from) continue;
        const Column phi = elementary_weights(w, tree);
        const Quad sum = std::inner_product(w.b.begin(), w.b.end(), phi.begin(), Quad(0));
        worst = std::max(worst, std::abs(static_cast<double>(Quad(sum * density(tree) - 1))));
    }
    return worst;
}

TEST(OrderConditions, HoldForEveryTree) {
    EXPECT_EQ(trees_up_to(8).size(), 200u);  // 1 + 1 + 2 + 4 + 9 + 20 + 48 + 115
    const auto check = [](const char* name, const Weights& w, int order, double most) {
        EXPECT_LT(violation(w, 1, order), most) << name;
        EXPECT_GT(violation(w, order + 1, order + 1), 1e-3) << name;
    };
    check("euler", weights_of(Euler::table.a, Euler::table.b, 1), 1, 1e-33);
    check("midpoint", weights_of(Midpoint::table.a, Midpoint::table.b, 2), 2, 1e-33);
    check("rk4", weights_of(Rk4::table.a, Rk4::table.b, 4), 4, 1e-32);
    check("dopri5", weights_of(Dopri5::pair.a, Dopri5::pair.a[6], 6), 5, 1e-31);
    check("dop853", weights_of(Dop853::pair.a, Dop853::pair.a[12], 12), 8, 1e-29);  // measured 3.4e-30
}

}  // namespace order_test
}  // namespace doppel
