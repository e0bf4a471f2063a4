#pragma once

#include "physics/angle_chain.hpp"

#include <array>
#include <cmath>

namespace doppel {

/// The right-hand side of a chain in angles on plain arrays (θ1 … θN, ω1 … ωN), as a careful user writes it for two
/// and three links: precomputed constants, one division. It counts its evaluations. Other lengths use
/// AngleChain.
template <int N>
class ChainRate {
public:
    explicit ChainRate(const Pendulum<double>& p)
        : chain_(p), y_(2 * static_cast<Eigen::Index>(p.links())), dydt_(y_) {}

    void operator()(const double* y, double* dydt) {
        ++evaluations;
        y_ = Eigen::Map<const Eigen::VectorXd>(y, y_.size());
        chain_.rate(y_, dydt_);
        Eigen::Map<Eigen::VectorXd>(dydt, y_.size()) = dydt_;
    }

    long evaluations = 0;

private:
    AngleChain<double, Eigen::Dynamic> chain_;
    Eigen::VectorXd y_, dydt_;
};

/// The closed form of DoublePendulum.
template <>
class ChainRate<2> {
public:
    explicit ChainRate(const Pendulum<double>& p)
        : m1_(p.mass[0]), m2_(p.mass[1]), m_(m1_ + m2_), l1_(p.length[0]), l2_(p.length[1]), g_(p.gravity) {}

    void operator()(const double* y, double* dydt) {
        ++evaluations;
        const double sin1 = std::sin(y[0]), cos1 = std::cos(y[0]), sin2 = std::sin(y[1]), cos2 = std::cos(y[1]);
        const double s = sin1 * cos2 - cos1 * sin2, c = cos1 * cos2 + sin1 * sin2;
        const double pull1 = l1_ * y[2] * y[2], pull2 = l2_ * y[3] * y[3];
        const double f = 1 / ((m1_ + m2_ * s * s) * (l1_ * l2_));
        dydt[0] = y[2];
        dydt[1] = y[3];
        dydt[2] = -(m2_ * s * (pull2 + pull1 * c) + g_ * (m_ * sin1 - m2_ * c * sin2)) * (f * l2_);
        dydt[3] = (s * (m_ * pull1 + m2_ * pull2 * c) + m_ * g_ * (sin1 * c - sin2)) * (f * l1_);
    }

    long evaluations = 0;

private:
    double m1_, m2_, m_, l1_, l2_, g_;
};

/// The tensions of AngleChain by Cramer's rule.
template <>
class ChainRate<3> {
public:
    explicit ChainRate(const Pendulum<double>& p) : g_(p.gravity) {
        for (std::size_t i = 0; i < 3; ++i) {
            w_[i] = 1 / p.mass[i];
            l_[i] = p.length[i];
            by_l_[i] = 1 / p.length[i];
        }
        d1_ = w_[0] + w_[1];
        d2_ = w_[1] + w_[2];
        by_d0_ = 1 / w_[0];
        by_d2_ = 1 / d2_;
    }

    void operator()(const double* y, double* dydt) {
        ++evaluations;
        const double sin0 = std::sin(y[0]), cos0 = std::cos(y[0]);
        const double sin1 = std::sin(y[1]), cos1 = std::cos(y[1]);
        const double sin2 = std::sin(y[2]), cos2 = std::cos(y[2]);
        const double s0 = (sin1 * cos0 - cos1 * sin0) * w_[0], s1 = (sin2 * cos1 - cos2 * sin1) * w_[1];
        const double a = -(cos1 * cos0 + sin1 * sin0) * w_[0], b = -(cos2 * cos1 + sin2 * sin1) * w_[1];
        // | w0  a   0  |
        // | a   d1  b  | tension = pull
        // | 0   b   d2 |
        const double pull0 = l_[0] * y[3] * y[3] + g_ * cos0;
        const double pull1 = l_[1] * y[4] * y[4], pull2 = l_[2] * y[5] * y[5];
        const double t1 =
            (w_[0] * (d2_ * pull1 - b * pull2) - a * d2_ * pull0) / (w_[0] * (d1_ * d2_ - b * b) - a * a * d2_);
        const double t0 = (pull0 - a * t1) * by_d0_, t2 = (pull2 - b * t1) * by_d2_;
        dydt[0] = y[3];
        dydt[1] = y[4];
        dydt[2] = y[5];
        dydt[3] = (t1 * s0 - g_ * sin0) * by_l_[0];
        dydt[4] = (t2 * s1 - t0 * s0) * by_l_[1];
        dydt[5] = -(t1 * s1) * by_l_[2];
    }

    long evaluations = 0;

private:
    double g_, d1_, d2_, by_d0_, by_d2_;
    std::array<double, 3> w_{}, l_{}, by_l_{};  // 1/kg, m, 1/m
};

}  // namespace doppel
