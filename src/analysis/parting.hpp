#pragma once

#include <optional>

namespace doppel {

/// Finds when a pair that starts as one parts: from when on it is apart for a second of motion without a break.
class Parting {
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
