#pragma once

#include "integrate/dormand_prince.hpp"
#include "track/model.hpp"

#include <concepts>
#include <utility>

namespace doppel {

/// The coefficients of Dormand & Prince's order 5: six stages, then the weights of the step.
inline constexpr auto fifth_order = [] {
    std::array<std::array<double, 6>, 7> a{};
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < 6; ++j) {
            const auto& fraction = Dopri5::pair.a[i][j];
            a[i][j] = static_cast<double>(fraction.numerator) / static_cast<double>(fraction.denominator);
        }
    return a;
}();

/// y + h Σ a_j k_j over the stages j of a row.
template <std::size_t row, std::size_t... j>
double stage_sum(std::index_sequence<j...>, double h, double y, const std::same_as<double> auto&... k) {
    return (y + ... + ((h * fifth_order[row][j]) * k));
}
template <std::size_t row, std::size_t... j, int N>
Dual<double, N> stage_sum(std::index_sequence<j...>, double h, const Dual<double, N>& y,
                          const std::same_as<Dual<double, N>> auto&... k) {
    return {(y.value + ... + ((h * fifth_order[row][j]) * k.value)),
            (y.tangent + ... + ((h * fifth_order[row][j]) * k.tangent))};
}
template <std::size_t row, class Stages, class Scalar>
ArmState<Scalar> stage_sums(Stages stages, double h, const ArmState<Scalar>& y, const auto&... k) {
    const auto of = [&](std::size_t q) { return stage_sum<row>(stages, h, y[q], k[q]...); };
    return {of(0), of(1), of(2), of(3)};
}

/// One fixed step of h seconds: the state and its slope, which is the first stage of the next step. Steps are fixed so
/// that derivatives are those of what is computed.
template <class Model, class Scalar>
void take_step(const Model& arms, double h, ArmState<Scalar>& y, ArmState<Scalar>& slope) {
    const auto& k0 = slope;
    const auto k1 = arms.rate(stage_sums<1>(std::index_sequence<0>(), h, y, k0));
    const auto k2 = arms.rate(stage_sums<2>(std::index_sequence<0, 1>(), h, y, k0, k1));
    const auto k3 = arms.rate(stage_sums<3>(std::index_sequence<0, 1, 2>(), h, y, k0, k1, k2));
    const auto k4 = arms.rate(stage_sums<4>(std::index_sequence<0, 1, 2, 3>(), h, y, k0, k1, k2, k3));
    const auto k5 = arms.rate(stage_sums<5>(std::index_sequence<0, 1, 2, 3, 4>(), h, y, k0, k1, k2, k3, k4));
    static_assert(fifth_order[6][1] == 0);
    y = stage_sums<6>(std::index_sequence<0, 2, 3, 4, 5>(), h, y, k0, k2, k3, k4, k5);
    slope = arms.rate(y);
}

/// The angle at t seconds into a step of h: the polynomial of degree 5 through angle, rate and acceleration at both
/// ends (error h⁶ θ⁽⁶⁾/46080). Weights of these six, in that order.
struct AngleWeights {
    std::array<double, 6> angle;

    AngleWeights(double t, double h) {
        const double s = t / h, s2 = s * s, s3 = s2 * s, s4 = s3 * s, s5 = s4 * s;
        angle = {1 - 10 * s3 + 15 * s4 - 6 * s5,
                 h * (s - 6 * s3 + 8 * s4 - 3 * s5),
                 h * h * (0.5 * s2 - 1.5 * s3 + 1.5 * s4 - 0.5 * s5),
                 10 * s3 - 15 * s4 + 6 * s5,
                 h * (-4 * s3 + 7 * s4 - 3 * s5),
                 h * h * (0.5 * s3 - s4 + 0.5 * s5)};
    }
};

/// Those of its rate.
inline std::array<double, 6> rate_weights(double t, double h) {
    const double s = t / h, s2 = s * s, s3 = s2 * s, s4 = s3 * s;
    return {(-30 * s2 + 60 * s3 - 30 * s4) / h, 1 - 18 * s2 + 32 * s3 - 15 * s4, h * (s - 4.5 * s2 + 6 * s3 - 2.5 * s4),
            (30 * s2 - 60 * s3 + 30 * s4) / h,  -12 * s2 + 28 * s3 - 15 * s4,    h * (1.5 * s2 - 4 * s3 + 2.5 * s4)};
}

/// The motion from one start, step after step, to be asked for angles at ascending times.
template <class Scalar, class Model = Arms<Scalar>>
class Flow {
public:
    Flow(const Model& arms, const ArmState<Scalar>& start, double step)
        : arms_(arms), step_(step), before_(start), slope_before_(arms.rate(start)) {
        go_on();
    }

    /// Steps on until `t` (s from the start) is in the last step. False where the motion left what is finite.
    bool reach(double t) {
        while (t > static_cast<double>(done_) * step_) {
            std::swap(before_, after_);
            std::swap(slope_before_, slope_after_);
            if (!go_on()) return false;
        }
        return true;
    }

    /// For a time in the last step, or a little outside.
    AngleWeights weights(double t) const { return {t - static_cast<double>(done_ - 1) * step_, step_}; }
    /// What these weights weigh, of one arm, 0 or 1.
    std::array<const Scalar*, 6> nodes(std::size_t arm) const {
        return {&before_[arm], &before_[arm + 2], &slope_before_[arm + 2],
                &after_[arm],  &after_[arm + 2],  &slope_after_[arm + 2]};
    }
    Scalar angle(std::size_t arm, double t) const {
        const auto of = weights(t);
        const auto values = nodes(arm);
        Scalar sum(0);
        for (std::size_t k = 0; k < 6; ++k) sum += of.angle[k] * *values[k];
        return sum;
    }

    /// The values alone of a Scalar with derivatives.
    double angle_value(std::size_t arm, double t) const {
        const auto of = weights(t);
        const auto values = nodes(arm);
        double sum = 0;
        for (std::size_t k = 0; k < 6; ++k) sum += of.angle[k] * values[k]->value;
        return sum;
    }
    double angle_rate(std::size_t arm, double t) const {
        const auto of = rate_weights(t - static_cast<double>(done_ - 1) * step_, step_);
        const auto values = nodes(arm);
        double sum = 0;
        for (std::size_t k = 0; k < 6; ++k) sum += of[k] * values[k]->value;
        return sum;
    }

    /// Its state at the end of the last step, at `time()` s.
    const ArmState<Scalar>& state() const { return after_; }
    double time() const { return static_cast<double>(done_) * step_; }

private:
    bool go_on() {
        after_ = before_;
        slope_after_ = slope_before_;
        take_step(arms_, step_, after_, slope_after_);
        ++done_;
        constexpr double fastest = 1e4;  // rad/s
        return after_[2] < Scalar(fastest) && after_[2] > Scalar(-fastest) && after_[3] < Scalar(fastest) &&
               after_[3] > Scalar(-fastest);
    }

    Model arms_;
    double step_;
    long done_ = 0;
    ArmState<Scalar> before_, slope_before_, after_, slope_after_;
};

}  // namespace doppel
