#pragma once

#include "integrate/motion.hpp"

#include <atomic>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace doppel {

/// Many motions that are integrated together from sample to sample, each as it would be alone, to the last bit.
///
/// Chains of two or three links that differ in their masses, lengths, gravity and release only, by Euler's or the classical
/// Runge–Kutta method, are integrated side by side (integrate/batch.hpp), all others one by one.
class MotionBatch {
public:
    /// On `jobs` threads; what comes of it does not depend on them. Throws what make_motion() does.
    explicit MotionBatch(std::span<const MotionSpec> specs, int jobs);
    ~MotionBatch();

    /// All on to the next sample. Throws what Motion::advance() does, of the first that cannot go on; the message says
    /// which one that is. The batch is lost then.
    void advance(const std::atomic<bool>& stop) { advance_all(1, stop); }
    /// All as Motion::advance_within().
    void advance_within(double share, const std::atomic<bool>& stop) { advance_all(share, stop); }

    std::size_t size() const { return size_; }

    /// What Motion::observe() says of motion k: angles unwrapped.
    Bobs<double> bobs(std::size_t k) const;

    /// How many doubles to a register the motions are integrated in; 1 where they are integrated one by one.
    int width() const;

private:
    class SideBySide;

    /// 1 = to the next sample.
    void advance_all(double share, const std::atomic<bool>& stop);
    void advance_part(std::size_t part, double share, const std::atomic<bool>& stop);
    template <class Act>
    void with_name(std::size_t k, const Act& act) const;

    std::size_t size_, part_;  // motions, and how many are integrated on one thread at a time
    int jobs_;
    std::vector<std::unique_ptr<SideBySide>> together_;  // a part each; or
    std::vector<std::unique_ptr<Motion>> one_by_one_;
};

}  // namespace doppel
