#pragma once

#include "physics/bob.hpp"

#include <cmath>
#include <optional>

namespace doppel {

/// Distance of two systems with the same number of masses in state space: the Euclidean norm of the difference of (m,
/// x, vx, y, vy) over all masses, in SI units. A difference in mass counts, too.
template <class Scalar>
Scalar state_space_distance(const Bobs<Scalar>& a, const Bobs<Scalar>& b) {
    using std::sqrt;
    Scalar sum(0);
    const auto add = [&](const Scalar& difference) { sum += difference * difference; };
    for (std::size_t i = 0; i < a.size(); ++i) {
        // in the order of memory: GCC 12 at -O3 sums in this order whatever is written, and the last bit depends on it
        add(a[i].mass - b[i].mass);
        add(a[i].x - b[i].x);
        add(a[i].y - b[i].y);
        add(a[i].vx - b[i].vx);
        add(a[i].vy - b[i].vy);
    }
    return sqrt(sum);
}

/// λ = ln(d / d0), the measure of divergence in Kao's study: dimensionless, not an exponent per second. Nothing if d0
/// or d is 0.
inline std::optional<double> log_ratio(double distance, double start) {
    if (start == 0 || distance == 0) return std::nullopt;
    return portable_log(distance / start);
}

/// The mean of λ over all samples of a pair except the first, from its distances in order (Kao 2022). Samples with
/// distance 0 are left out. NaN if no sample is left, or the motion failed.
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

/// Finds when a pair that starts nearly equal diverges: its distance stays above the limit for one second from then on.
class Divergence {
public:
    static constexpr double diverged_distance = 1;  // state-space distance from which the pair counts as diverged
    // only a pair that starts below this distance can diverge
    static constexpr double max_start_distance = 0.1 * diverged_distance;
    static constexpr double min_s = 1;

    /// Adds a sample; all are required in order, from time 0 on. s.
    void add(double time, double distance) {
        if (time == 0) starts_together_ = distance < max_start_distance;
        if (!starts_together_ || since_) return;
        if (!(distance >= diverged_distance)) return candidate_.reset();
        if (!candidate_) candidate_ = time;
        if (time - *candidate_ >= min_s) since_ = candidate_;
    }

    bool starts_together() const { return starts_together_; }
    /// The time of divergence, s; known one second later. Nothing if the pair does not diverge, comes back within a
    /// second, or starts apart.
    std::optional<double> since() const { return since_; }

private:
    bool starts_together_ = false;
    std::optional<double> candidate_{}, since_{};
};

}  // namespace doppel
