#pragma once

#include "integrate/dormand_prince.hpp"
#include "track/model.hpp"

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

/// One fixed step of h seconds: the state and its slope, which is the first stage of the next step. Steps are fixed so
/// that derivatives are those of what is computed.
template <class Scalar>
void take_step(const Arms<Scalar>& arms, double h, ArmState<Scalar>& y, ArmState<Scalar>& slope) {
    std::array<ArmState<Scalar>, 6> slopes;
    slopes[0] = slope;
    const auto sum_to = [&](std::size_t row) {
        auto sum = y;
        for (std::size_t j = 0; j < std::min<std::size_t>(row, 6); ++j) {
            if (fifth_order[row][j] == 0) continue;
            const Scalar weight = h * fifth_order[row][j];
            for (std::size_t q = 0; q < 4; ++q) sum[q] += weight * slopes[j][q];
        }
        return sum;
    };
    for (std::size_t i = 1; i < 6; ++i) slopes[i] = arms.rate(sum_to(i));
    y = sum_to(6);
    slope = arms.rate(y);
}

/// The angle at t seconds into a step of h: the polynomial of degree 5 through angle, rate and acceleration at both
/// ends (error h⁶ θ⁽⁶⁾/46080). Weights of these six, in that order; and of its rate.
struct AngleWeights {
    std::array<double, 6> angle, rate;

    AngleWeights(double t, double h) {
        const double s = t / h, s2 = s * s, s3 = s2 * s, s4 = s3 * s, s5 = s4 * s;
        angle = {1 - 10 * s3 + 15 * s4 - 6 * s5,
                 h * (s - 6 * s3 + 8 * s4 - 3 * s5),
                 h * h * (0.5 * s2 - 1.5 * s3 + 1.5 * s4 - 0.5 * s5),
                 10 * s3 - 15 * s4 + 6 * s5,
                 h * (-4 * s3 + 7 * s4 - 3 * s5),
                 h * h * (0.5 * s3 - s4 + 0.5 * s5)};
        rate = {(-30 * s2 + 60 * s3 - 30 * s4) / h,     1 - 18 * s2 + 32 * s3 - 15 * s4,
                h * (s - 4.5 * s2 + 6 * s3 - 2.5 * s4), (30 * s2 - 60 * s3 + 30 * s4) / h,
                -12 * s2 + 28 * s3 - 15 * s4,           h * (1.5 * s2 - 4 * s3 + 2.5 * s4)};
    }
};

/// The motion from one start, step after step, to be asked for angles at ascending times.
template <class Scalar>
class Flow {
public:
    Flow(const Arms<Scalar>& arms, const ArmState<Scalar>& start, double step)
        : arms_(arms), step_(step), before_(start), slope_before_(arms.rate(start)) {
        go_on();
    }

    /// Steps on until `t` (s from the start) is in the last step. False where the motion left what is finite.
    bool reach(double t) {
        while (t > static_cast<double>(done_) * step_) {
            before_ = after_;
            slope_before_ = slope_after_;
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

    Arms<Scalar> arms_;
    double step_;
    long done_ = 0;
    ArmState<Scalar> before_, slope_before_, after_, slope_after_;
};

}  // namespace doppel
