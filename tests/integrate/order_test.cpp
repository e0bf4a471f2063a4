// The order of interpolations, and Butcher's conditions; the orders of all methods:
// integrate/physical_methods_test.cpp.

#include "integrate/dormand_prince.hpp"
#include "integrate/euler.hpp"
#include "integrate/fixed_step.hpp"
#include "integrate/flow.hpp"
#include "integrate/runge_kutta.hpp"
#include "numeric/quad.hpp"
#include "physics/angle_chain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace doppel {
namespace order_test {

/// Order of the interpolation: the error at a quarter of the first step shrinks as step^(order + 1).
template <class Which>
double interpolation_order(double coarse_tolerance, double fine_tolerance) {
    using Model = DoublePendulum<Quad>;
    const auto measured = [](double tolerance) {
        Model model(unequal<Quad>());
        const auto start = Model::start(unequal<Quad>());
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

// Butcher's conditions: for every rooted tree t of at most `order` nodes Σ b_i φ_i(t) = 1/γ(t). A tree is the sorted
// list of its branches, so that each tree occurs once.

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

/// The largest residual of the conditions for trees of `from` to `to` nodes.
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
    const auto check = [](const char* name, const Weights& w, int order, double maximum) {
        EXPECT_LT(violation(w, 1, order), maximum) << name;
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
