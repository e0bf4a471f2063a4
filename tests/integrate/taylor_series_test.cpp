#include "integrate/angle_series.hpp"
#include "integrate/lane_series.hpp"
#include "integrate/pendulums.hpp"
#include "integrate/taylor.hpp"
#include "integrate/widths.hpp"
#include "numeric/quad.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace doppel {
namespace taylor_series_test {

template <class Scalar>
using Vector = State<Scalar, Eigen::Dynamic>;

/// Residual of the equations of motion along a series, |y′(h) − f(y(h))|, which shrinks as h^order only if every
/// coefficient is correct. In quad; y′ by central differences.
template <class Model>
double residual(const Pendulum<double>& p, int order, double h) {
    const auto q = p.cast<Quad>();
    Model model(q);
    const typename Model::State start = Model::start(q);
    const auto series = series_of(model, order);
    series->expand(start);
    const auto moved = [&](const Quad& by) {
        Vector<Quad> change = start;
        series->move(by, change);
        return typename Model::State(start + change);
    };
    const Quad at(h), d(1e-9);
    typename Model::State rate = start;
    model.rate(moved(at), rate);
    rate -= (Quad(8) * (moved(at + d) - moved(at - d)) - (moved(at + d + d) - moved(at - d - d))) / (Quad(12) * d);
    double worst = 0;
    for (const Quad& difference : rate) worst = greater(worst, std::abs(static_cast<double>(difference)));
    return worst;
}

/// Expects that the residual shrinks as h^(order + more).
template <class Model>
void expect_series_solves(const Pendulum<double>& p, int more = 0) {
    for (int order : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}) {
        const double h = 4e-3, ratio = residual<Model>(p, order, 2 * h) / residual<Model>(p, order, h);
        EXPECT_NEAR(std::log2(ratio), order + more, 0.25) << order;  // measured within 0.09
    }
}

TEST(TaylorSeries, SolvesTheEquationsOfMotionOrderByOrder) {
    expect_series_solves<AngleChain<Quad, 2>>(uneven(2));
    expect_series_solves<AngleChain<Quad, 3>>(uneven(3));
    expect_series_solves<AngleChain<Quad, Eigen::Dynamic>>(uneven(1));
    expect_series_solves<AngleChain<Quad, Eigen::Dynamic>>(uneven(6));
    expect_series_solves<DoublePendulum<Quad>>(uneven(2));
    expect_series_solves<RodChain<Quad, 2>>(uneven(2), 1);
    expect_series_solves<RodChain<Quad, Eigen::Dynamic>>(uneven(5), 1);
}

/// Coefficient k of the rates: the difference between the series of orders k and k − 1, at h = 1.
template <class Series, class Scalar>
Vector<Scalar> coefficient(const Pendulum<Scalar>& p, const Vector<Scalar>& y, int k) {
    Series with(p, k), without(p, k - 1);
    auto one = y, other = y;
    with.expand(y);
    with.move(Scalar(1), one);
    without.expand(y);
    without.move(Scalar(1), other);
    return (one - other).tail(y.size() / 2);
}

template <int N>
void expect_lanes_like_quad() {
    const auto p = uneven(N);
    const Vector<double> y = released_in_angles<double, Eigen::Dynamic>(p);
    for (int k = 2; k <= 24; ++k) {
        const auto lanes = coefficient<LaneSeries>(p, y, k);
        const auto chain = coefficient<AngleSeries<double>>(p, y, k);
        const auto quad = coefficient<AngleSeries<Quad>>(p.template cast<Quad>(), Vector<Quad>(y.cast<Quad>()), k);
        const double size = static_cast<double>(Quad(quad.cwiseAbs().maxCoeff()));
        for (int i = 0; i < N; ++i) {
            EXPECT_NEAR(lanes[i], static_cast<double>(quad[i]), 1e-12 * size) << k;  // measured 1e-13
            EXPECT_NEAR(chain[i], static_cast<double>(quad[i]), 1e-12 * size) << k;  // measured 2e-13
        }
    }
}

TEST(TaylorSeries, LanesHaveTheSameCoefficients) {
    expect_lanes_like_quad<2>();
    expect_lanes_like_quad<3>();
}

template <int N>
void expect_same_bits() {
    const auto p = uneven(N);
    const Vector<double> y = released_in_angles<double, Eigen::Dynamic>(p);
    for (int order : {5, 8, 13, 24, 33}) {
        LaneSeries wide(p, order, std::min(register_widths().back(), 4)), narrow(p, order, 2);
        Vector<double> one = y, other = y;
        wide.expand(y);
        wide.move(0.02, one);
        narrow.expand(y);
        narrow.move(0.02, other);
        EXPECT_EQ(std::memcmp(one.data(), other.data(), sizeof(double) * static_cast<std::size_t>(y.size())), 0);
        for (int k = 0; k <= order; ++k) EXPECT_EQ(wide.size(k), narrow.size(k));
    }
}

TEST(TaylorSeries, GivesTheSameBitsWithTwoLanesAndFour) {
    expect_same_bits<2>();
    expect_same_bits<3>();
}

}  // namespace taylor_series_test
}  // namespace doppel
