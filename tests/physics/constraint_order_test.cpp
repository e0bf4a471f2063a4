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

/// A chain of rods in a zigzag from the origin, its rods listed in a random order where `shuffled`, with its end held by
/// two more rods where `looped`.
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

Column places(const Assembly<double>& parts) {
    Column q(2 * static_cast<Eigen::Index>(parts.particles.size()));
    for (std::size_t i = 0; i < parts.particles.size(); ++i)
        q.segment<2>(2 * static_cast<Eigen::Index>(i)) = parts.particles[i].place;
    return q;
}

TEST(ConstraintOrder, KeepsAFewNumbersForEachOfTenThousandLinks) {
    for (const bool looped : {false, true}) {
        const auto parts = chain(10000, false, looped);
        const ConstraintSet<double> set(parts.constraints, places(parts));
        // a diagonal, and what is beside it on both sides; a loop adds the distance of its ends
        EXPECT_LE(set.blank_matrix().entries(), (looped ? 8 : 4) * set.rows()) << looped;
    }
}

TEST(ConstraintOrder, GivesTheSameMultipliersAsADenseMatrix) {
    for (const bool looped : {false, true}) {
        const auto parts = chain(40, true, looped);
        const auto q = places(parts);
        const ConstraintSet<double> set(parts.constraints, q);
        auto gradients = set.blank_gradients();
        set.update(q, gradients);
        Column w(static_cast<Eigen::Index>(parts.particles.size()));
        for (Eigen::Index i = 0; i < w.size(); ++i) w[i] = 1 / parts.particles[static_cast<std::size_t>(i)].mass;

        // J row by row of the constraints, from what it does to unit velocities
        Eigen::MatrixXd j(set.rows(), q.size());
        for (Eigen::Index c = 0; c < q.size(); ++c) {
            Column s = Column::Zero(set.rows());
            set.add_constraint_velocity(gradients, Column(Column::Unit(q.size(), c)), s);
            j.col(c) = s;
        }
        Eigen::VectorXd by_mass(q.size());
        for (Eigen::Index c = 0; c < q.size(); ++c) by_mass[c] = w[c / 2];
        const Eigen::MatrixXd dense = j * by_mass.asDiagonal() * j.transpose();

        auto matrix = set.blank_matrix();
        set.couple(gradients, gradients, w, matrix);
        matrix.factor();
        ASSERT_EQ(matrix.dependent_row(), set.rows());
        const Column right = Column::LinSpaced(set.rows(), -1, 2);
        Column x = right;
        matrix.solve(x);
        EXPECT_LT((dense * x - right).cwiseAbs().maxCoeff(), 1e-11);
        const Column exact = dense.partialPivLu().solve(right);
        EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-10 * exact.cwiseAbs().maxCoeff());
    }
}

/// Whatever the order of the rods, the particles move as they do, and values come in the order of the constraints.
TEST(ConstraintOrder, ChangesNoMotion) {
    const auto plain = chain(60, false, true), shuffled = chain(60, true, true);
    Mechanism<double> one(plain), other(shuffled);
    const auto y = Mechanism<double>::start(plain);
    Column rate = y, same = y;
    one.rate(y, rate);
    other.rate(y, same);
    EXPECT_LT((rate - same).cwiseAbs().maxCoeff(), 1e-9 * rate.cwiseAbs().maxCoeff());

    const auto pulls = one.tensions(y), others = other.tensions(y);
    for (std::size_t i = 0; i < pulls.size(); ++i) {
        const auto& rod = std::get<Rod<double>>(shuffled.constraints[i]);
        const auto at = i < 60 ? rod.a : i;
        EXPECT_NEAR(others[i], pulls[at], 1e-9 * (1 + std::abs(pulls[at]))) << i;
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
