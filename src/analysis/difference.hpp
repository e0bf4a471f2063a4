#pragma once

#include "physics/bob.hpp"

#include <cmath>
#include <optional>

namespace doppel {

/// How far apart two systems of as many masses are in state space: the Euclidean norm of the difference of
/// (m, x, vx, y, vy) over all masses, in SI numbers, so that a difference in mass counts.
template <class Scalar>
Scalar state_space_distance(const Bobs<Scalar>& a, const Bobs<Scalar>& b) {
    using std::sqrt;
    Scalar sum(0);
    const auto add = [&](const Scalar& difference) { sum += difference * difference; };
    for (std::size_t i = 0; i < a.size(); ++i) {
        // in the order of memory: GCC 12 at -O3 sums in that order whatever stands here, and the last bit depends on it
        add(a[i].mass - b[i].mass);
        add(a[i].x - b[i].x);
        add(a[i].y - b[i].y);
        add(a[i].vx - b[i].vx);
        add(a[i].vy - b[i].vy);
    }
    return sqrt(sum);
}

/// λ = ln(d / d0), the study's measure of divergence: dimensionless, not an exponent per second. Nothing where d0 or d
/// is 0.
inline std::optional<double> log_ratio(double distance, double start) {
    if (start == 0 || distance == 0) return std::nullopt;
    return portable_log(distance / start);
}

/// The mean of λ over all samples but the first of a pair, from its distances in their order (Kao 2022). Samples at which
/// the two are one are left out; NaN where none is left, or the motion failed.
class AverageLogRatio {
public:
    void add(double distance) {
        if (is_first_) {
            start_ = distance;
        } else if (const auto ratio = log_ratio(distance, start_)) {
            sum_ += *ratio;
            ++counted_;
        }
        is_first_ = false;
    }
    double value() const {
        const double mean = sum_ / static_cast<double>(counted_);
        return std::isfinite(mean) ? mean : NAN;
    }

private:
    bool is_first_ = true;
    double start_ = 0, sum_ = 0;
    long counted_ = 0;
};

/// Finds when a pair that starts as one parts: from when on it is apart for a second of motion without a break.
class Divergence {
public:
    static constexpr double apart_at = 1;                  // state-space distance from which the two count as apart
    static constexpr double together_at = 0.1 * apart_at;  // below it a pair starts as one, and can part
    static constexpr double least_s = 1;

    /// Every sample in order, from that at time 0 on; s.
    void add(double time, double distance) {
        if (time == 0) start_as_one_ = distance < together_at;
        if (!start_as_one_ || since_) return;
        if (!(distance >= apart_at)) return apart_from_.reset();
        if (!apart_from_) apart_from_ = time;
        if (time - *apart_from_ >= least_s) since_ = apart_from_;
    }

    bool start_as_one() const { return start_as_one_; }
    /// s; known a second later. Nothing where the two stay together, come back within a second, or start apart.
    std::optional<double> since() const { return since_; }

private:
    bool start_as_one_ = false;
    std::optional<double> apart_from_{}, since_{};
};

}  // namespace doppel
