#include "numeric/quad.hpp"
#include "physics/angle_chain.hpp"
#include "physics/physical_chain.hpp"
#include "physics/rod_chain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace light_mass_test {

/// Every pattern of light and unit masses, with links 1e-3 rad from aligned that rotate at different rates.
template <class Check>
void for_each_pattern(std::size_t links, double light, const Check& check) {
    for (unsigned pattern = 0; pattern < 1u << links; ++pattern) {
        Pendulum<double> p{{}, {}, {}, {}, 9.8};
        for (std::size_t i = 0; i < links; ++i) {
            p.mass.push_back((pattern >> i & 1u) == 1 ? light : 1);
            p.length.push_back(1 - 0.1 * static_cast<double>(i));
            p.angle.push_back(0.7 + (i % 2 == 0 ? 0 : 1e-3));
            p.rate.push_back(1 + 0.5 * static_cast<double>(i));
        }
        check(p);
    }
}

/// The error of the accelerations of `model` against quad at the same state, relative to the largest one.
template <template <class> class Model, class Description>
double error_of(const Description& description) {
    Model<double> model(description);
    const auto exactly = description.template cast<Quad>();
    Model<Quad> truth(exactly);
    const auto y = Model<double>::start(description);
    typename Model<double>::State found = y;
    typename Model<Quad>::State exact_y = y.template cast<Quad>(), expected = exact_y;
    model.rate(y, found);
    truth.rate(exact_y, expected);
    double worst = 0, size = 0;
    for (Eigen::Index i = y.size() / 2; i < y.size(); ++i) {
        worst = std::max(worst, std::abs(static_cast<double>(Quad(Quad(found[i]) - expected[i]))));
        size = std::max(size, std::abs(static_cast<double>(expected[i])));
    }
    return worst / size;
}

template <class S>
using Double = DoublePendulum<S>;
template <class S>
using Angles = AngleChain<S, Eigen::Dynamic>;
template <class S>
using Rods2 = RodChain<S, 2>;
template <class S>
using Rods3 = RodChain<S, 3>;
template <class S>
using Rods = RodChain<S, Eigen::Dynamic>;

TEST(LightMasses, KeepTheirAccelerations) {
    for (const double light : {1e-2, 1e-4, 1e-6, 1e-8}) {
        double angles = 0, rods = 0;
        const auto note = [](double& worst, double error) { worst = std::max(worst, error); };
        for (const std::size_t links : {2u, 3u, 5u})
            for_each_pattern(links, light, [&](const auto& p) {
                note(angles, error_of<Angles>(p)), note(rods, error_of<Rods>(p));
                if (links == 2) note(angles, error_of<Double>(p)), note(rods, error_of<Rods2>(p));
                if (links == 3) note(rods, error_of<Rods3>(p));
            });
        EXPECT_LT(angles, 5e-15) << light;  // measured 7e-16
        EXPECT_LT(rods, 5e-15) << light;    // measured 1.1e-15
    }
}

TEST(LightMasses, KeepTheirAccelerationsAsBodies) {
    for (const double light : {1e-2, 1e-4, 1e-6, 1e-8})
        for (const double share : {1.0, 0.5}) {  // centre of mass at the end, or in the middle of a uniform rod
            for (const std::size_t links : {2u, 3u, 5u}) {
                double worst = 0;
                for_each_pattern(links, light, [&](const auto& chain) {
                    auto p = physical(chain);
                    for (std::size_t i = 0; i < links; ++i) {
                        p.center[i] *= share;
                        if (share < 1) p.inertia[i] = chain.mass[i] * chain.length[i] * chain.length[i] / 12;
                    }
                    worst = std::max(worst, error_of<PhysicalChain>(p));
                });
                EXPECT_LT(worst, links == 5 ? 5e-14 : 1e-14) << light << ' ' << share;  // measured 1.7e-14 and 4e-15
            }
        }
}

}  // namespace light_mass_test
}  // namespace doppel
