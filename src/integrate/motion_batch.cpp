#include "integrate/motion_batch.hpp"

#include "base/error.hpp"
#include "base/threads.hpp"
#include "integrate/batch.hpp"
#include "integrate/turns.hpp"

#include <algorithm>
#include <cmath>
#include <exception>

namespace doppel {

/// The motions of one part, integrated in a Batch from sample to sample.
class MotionBatch::SideBySide {
public:
    explicit SideBySide(std::span<const MotionSpec> specs)
        : spec_(specs.front()),
          pendulums_(pendulums_of(specs)),
          step_(spec_.sample_interval.value() / static_cast<double>(spec_.steps_per_sample)),
          batch_(pendulums_, spec_.model, spec_.method, step_),
          portion_(steps_in_one_go(batch_.state(0).size() * static_cast<Eigen::Index>(specs.size()))) {
        if (spec_.model != Model::constraints || !spec_.follows_turns) return;
        for (const auto& p : pendulums_) turns_.emplace_back(p.angle);
        follow_turns(0);
    }

    int width() const { return batch_.width(); }

    /// 1 = to the next sample.
    void advance(double share, const std::atomic<bool>& stop) {
        const long last = std::lround(share * static_cast<double>(spec_.steps_per_sample));
        for (long steps; taken_ < last; taken_ += steps) {
            throw_if_set(stop);
            steps = std::min(last - taken_, portion_);
            for (const auto& turns : turns_) steps = std::min(steps, steps_within(turns.longest_interval(), step_));
            batch_.advance(steps);
            follow_turns(static_cast<double>(steps) * step_);
        }
        if (share == 1) taken_ = 0;
    }

    Bobs<double> bobs(std::size_t k) const {
        const auto y = batch_.state(k);
        if (spec_.model == Model::angles) return bobs_of_angles(pendulums_[k], y);
        auto seen = bobs_of_particles(pendulums_[k], y);
        if (!turns_.empty()) turns_[k].add_to(seen);
        return seen;
    }

private:
    static std::vector<Pendulum<double>> pendulums_of(std::span<const MotionSpec> specs) {
        std::vector<Pendulum<double>> pendulums;
        for (const auto& spec : specs) pendulums.push_back(spec.chain->cast<double>());
        return pendulums;
    }

    void follow_turns(double seconds) {
        for (std::size_t k = 0; k < turns_.size(); ++k) {
            batch_.read(k, state_);
            turns_[k].update(state_, seconds);
        }
    }

    MotionSpec spec_;  // of the first motion; the others only differ in the numbers of their chains
    std::vector<Pendulum<double>> pendulums_;
    double step_;  // s
    Batch batch_;
    long portion_;              // steps at a time
    long taken_ = 0;            // steps since the last sample
    std::vector<Turns> turns_;  // of each; empty if turns are not counted
    State<double, Eigen::Dynamic> state_;
};

namespace {

/// Whether a Batch can integrate them together.
bool can_share_batch(std::span<const MotionSpec> specs) {
    const auto& one = specs.front();
    return one.chain && one.model != Model::mechanism && one.precision == Precision::in_double &&
           one.stabilise == Stabilise::none && Batch::supports(one.method, one.chain->links()) &&
           std::all_of(specs.begin(), specs.end(), [&](const MotionSpec& spec) {
               return spec.chain && spec.chain->links() == one.chain->links() && spec.model == one.model &&
                      spec.precision == one.precision && spec.stabilise == one.stabilise && spec.method == one.method &&
                      spec.sample_interval == one.sample_interval && spec.steps_per_sample == one.steps_per_sample &&
                      spec.follows_turns == one.follows_turns;
           });
}

/// The size of a part: one part for each of `threads` threads, in full registers and large enough to be worthwhile.
std::size_t part_of(std::size_t size, int threads) {
    constexpr std::size_t minimum = 64;
    const auto together = minimum * static_cast<std::size_t>(threads);
    return (size + together - 1) / together * minimum;
}

}  // namespace

MotionBatch::MotionBatch(std::span<const MotionSpec> specs, int jobs) : size_(specs.size()), jobs_(std::max(jobs, 1)) {
    if (specs.empty()) throw bad_input("a batch needs at least one motion");
    part_ = part_of(size_, jobs_);
    if (can_share_batch(specs))
        for (std::size_t first = 0; first < size_; first += part_)
            together_.push_back(std::make_unique<SideBySide>(specs.subspan(first, std::min(part_, size_ - first))));
    else
        for (std::size_t k = 0; k < size_; ++k) with_name(k, [&] { one_by_one_.push_back(make_motion(specs[k])); });
}

MotionBatch::~MotionBatch() = default;

int MotionBatch::width() const {
    return together_.empty() ? 1 : together_.front()->width();
}

/// Errors of `act` get the number of the motion as a prefix.
template <class Act>
void MotionBatch::with_name(std::size_t k, const Act& act) const {
    try {
        act();
    } catch (const Error& error) {
        if (error.code() == ExitCode::interrupted) throw;
        throw Error(error.code(), fmt::format("pendulum {} of {}: {}", k + 1, size_, error.what()));
    }
}

void MotionBatch::advance_part(std::size_t part, double share, const std::atomic<bool>& stop) {
    if (!together_.empty()) return together_[part]->advance(share, stop);
    for (std::size_t k = part * part_; k < std::min(size_, (part + 1) * part_); ++k)
        with_name(k, [&] { share == 1 ? one_by_one_[k]->advance(stop) : one_by_one_[k]->advance_within(share, stop); });
}

void MotionBatch::advance_all(double share, const std::atomic<bool>& stop) {
    // of several errors, always the same one is thrown, whichever came first
    std::vector<std::exception_ptr> errors((size_ + part_ - 1) / part_);
    parallel_for(errors.size(), jobs_, [&](std::size_t i) {
        try {
            advance_part(i, share, stop);
        } catch (...) {
            errors[i] = std::current_exception();
        }
    });
    for (const auto& error : errors)
        if (error) std::rethrow_exception(error);
}

Bobs<double> MotionBatch::bobs(std::size_t k) const {
    return together_.empty() ? one_by_one_[k]->observe().bobs : together_[k / part_]->bobs(k % part_);
}

}  // namespace doppel
