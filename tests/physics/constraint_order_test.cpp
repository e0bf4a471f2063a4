#include "errors.hpp"
#include "physics/constraint_set.hpp"
#include "physics/mechanisms.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace doppel {
namespace constraint_order_test {

using Column = State<double, Eigen::Dynamic>;

/// A zigzag chain of rods from the origin. `shuffled`: its rods are listed in random order; `looped`: two more rods
/// hold its end.
Assembly<double> chain(std::size_t links, bool shuffled, bool looped) {
    Assembly<double> made{.particles = {}, .constraints = {}, .forces = {Gravity<double>{}}};
    std::vector<std::size_t> order(links);
    std::iota(order.begin(), order.end(), std::size_t(0));
    for (const auto i : order)
        made.particles.push_back(
            {1 + 0.1 * static_cast<double>(i % 7), P(0.8 * static_cast<double>(i + 1), i % 2 ? 0 : 0.6)});
    if (shuffled) std::shuffle(order.begin(), order.end(), std::mt19937(3));
    for (const auto i : order) {
        const End<double> above = i == 0 ? End<double>(P(0, 0)) : End<double>(i - 1);
        made.constraints.push_back(Rod<double>{i, above, 1});
    }
    if (looped && links > 3) {
        const auto& last = made.particles.back().place;
        made.constraints.push_back(Rod<double>{links - 1, last + P(3, 4), 5});
        made.constraints.push_back(
            Rod<double>{links / 2, std::size_t{1}, (made.particles[links / 2].place - made.particles[1].place).norm()});
    }
    return made;
}

Column inverse_masses(const Assembly<double>& parts) {
    Column w(static_cast<Eigen::Index>(parts.particles.size()));
    for (Eigen::Index i = 0; i < w.size(); ++i) w[i] = 1 / parts.particles[static_cast<std::size_t>(i)].mass;
    return w;
}

TEST(ConstraintOrder, KeepsAFewNumbersForEachOfTenThousandLinks) {
    for (const bool looped : {false, true}) {
        const auto parts = chain(10000, false, looped);
        const ConstraintSet<double> set(parts.constraints, inverse_masses(parts));
        // the diagonal and its neighbours on both sides; a loop adds the distance of its ends
        EXPECT_LE(set.blank_matrix().entries(), (looped ? 8 : 4) * set.constraints()) << looped;
    }
}

TEST(ConstraintOrder, GivesTheSameMultipliersAsADenseMatrix) {
    for (const bool looped : {false, true}) {
        const auto parts = chain(40, true, looped);
        const auto start = Mechanism<double>::start(parts);
        const Column q = start.head(start.size() / 2), w = inverse_masses(parts);
        ConstraintSet<double> set(parts.constraints, w);
        auto gradients = set.blank_gradients();
        set.update(q, gradients);

        // J row by row of the constraints, from its products with unit velocities
        Eigen::MatrixXd j(set.constraints(), q.size());
        for (Eigen::Index c = 0; c < q.size(); ++c) {
            Column s(set.constraints());
            set.constraint_velocity(q, Column::Unit(q.size(), c), s);
            j.col(c) = s;
        }
        Eigen::VectorXd by_mass(q.size());
        for (Eigen::Index c = 0; c < q.size(); ++c) by_mass[c] = w[c / 2];
        const Eigen::MatrixXd dense = j * by_mass.asDiagonal() * j.transpose();

        auto matrix = set.blank_matrix();
        set.couple(gradients, gradients, matrix);
        matrix.factor();
        ASSERT_EQ(matrix.dependent_row(), set.constraints());
        const Column right = Column::LinSpaced(set.constraints(), -1, 2);
        Column x = right;
        matrix.solve(x);
        EXPECT_LT((dense * x - right).cwiseAbs().maxCoeff(), 1e-11);
        const Column exact = dense.partialPivLu().solve(right);
        EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-10 * exact.cwiseAbs().maxCoeff());
    }
}

TEST(ConstraintOrder, StillNamesWhatDependsOnOthers) {
    auto parts = chain(60, true, false);
    parts.constraints.insert(parts.constraints.begin() + 7, Anchor<double>{30, parts.particles[30].place});
    parts.constraints.push_back(Anchor<double>{30, parts.particles[30].place});
    const auto message = test::thrown_by([&] { check(parts); }).second;
    EXPECT_NE(message.find("anchor of particle 31"), std::string::npos) << message;
}

}  // namespace constraint_order_test
}  // namespace doppel
