#pragma once

#include "integrate/motion.hpp"

#include <atomic>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace doppel {

/// Many motions that advance together from sample to sample, each with the same bits as alone. Chains of two or three
/// links that only differ in masses, lengths, gravity and release are integrated side by side by Euler or RK4
/// (integrate/batch.hpp). All others are integrated one by one.
class MotionBatch {
public:
    /// On `jobs` threads; the results do not depend on their number. Throws as make_motion() does.
    explicit MotionBatch(std::span<const MotionSpec> specs, int jobs);
    ~MotionBatch();

    /// Advances all to the next sample. Throws as Motion::advance() does, for the first that fails; the message
    /// contains its number. After an error the batch is invalid.
    void advance(const std::atomic<bool>& stop) { advance_all(1, stop); }
    /// Advances all as Motion::advance_within() does.
    void advance_within(double share, const std::atomic<bool>& stop) { advance_all(share, stop); }

    std::size_t size() const { return size_; }

    /// The bobs that Motion::observe() gives for motion k, with unwrapped angles.
    Bobs<double> bobs(std::size_t k) const;

    /// Doubles per register; 1 if the motions are integrated one by one.
    int width() const;

private:
    class SideBySide;

    /// 1 = to the next sample.
    void advance_all(double share, const std::atomic<bool>& stop);
    void advance_part(std::size_t part, double share, const std::atomic<bool>& stop);
    template <class Act>
    void with_name(std::size_t k, const Act& act) const;

    std::size_t size_, part_;  // number of motions, and of motions per thread at a time
    int jobs_;
    std::vector<std::unique_ptr<SideBySide>> together_;  // one for each part; or
    std::vector<std::unique_ptr<Motion>> one_by_one_;
};

}  // namespace doppel
