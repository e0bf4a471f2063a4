#include "integrate/crowd.hpp"

#include "base/error.hpp"
#include "base/parallel_for.hpp"
#include "integrate/ensemble.hpp"
#include "integrate/turns.hpp"

#include <algorithm>
#include <exception>

namespace doppel {

/// Neighbours of a crowd, stepped on one thread at a time.
class Crowd::Part {
public:
    virtual ~Part() = default;
    virtual void advance(const std::atomic<bool>& stop) = 0;
    virtual Bobs<double> bobs(std::size_t k) const = 0;

    class OneByOne;
    class SideBySide;
};

class Crowd::Part::OneByOne final : public Part {
public:
    /// The motions of `specs` from `first` of `all`.
    OneByOne(std::span<const MotionSpec> specs, std::size_t first, std::size_t all) : first_(first), all_(all) {
        for (const auto& spec : specs) with_name(motions_.size(), [&] { motions_.push_back(make_motion(spec)); });
    }

    void advance(const std::atomic<bool>& stop) override {
        for (std::size_t k = 0; k < motions_.size(); ++k) with_name(k, [&] { motions_[k]->advance(stop); });
    }
    Bobs<double> bobs(std::size_t k) const override { return motions_[k]->observe().bobs; }

private:
    /// Its errors say which motion they befell.
    template <class Act>
    void with_name(std::size_t k, const Act& act) const {
        try {
            act();
        } catch (const Error& fault) {
            if (fault.code() == ExitCode::interrupted) throw;
            throw Error(fault.code(), fmt::format("pendulum {} of {}: {}", first_ + k + 1, all_, fault.what()));
        }
    }

    std::size_t first_, all_;
    std::vector<std::unique_ptr<Motion>> motions_;
};

class Crowd::Part::SideBySide final : public Part {
public:
    explicit SideBySide(std::span<const MotionSpec> specs)
        : in_angles_(specs.front().model == Model::angles),
          pendulums_(pendulums_of(specs)),
          ensemble_(pendulums_, in_angles_ ? EnsembleModel::angles : EnsembleModel::constraints, specs.front().method,
                    specs.front().sample_interval.value() / static_cast<double>(specs.front().steps_per_sample)),
          steps_(specs.front().steps_per_sample),
          step_(specs.front().sample_interval.value() / static_cast<double>(steps_)),
          portion_(steps_in_one_go(ensemble_.state(0).size() * static_cast<Eigen::Index>(specs.size()))) {
        if (!follows_turns(specs.front())) return;
        for (const auto& p : pendulums_) turns_.emplace_back(p.angle);
        follow_turns(0);
    }

    int width() const { return ensemble_.width(); }

    void advance(const std::atomic<bool>& stop) override {
        for (long left = steps_, steps; left > 0; left -= steps) {
            if (stop) throw Error(ExitCode::interrupted, "interrupted");
            steps = std::min(left, portion_);
            for (const auto& turns : turns_) steps = std::min(steps, steps_within(turns.patience(), step_));
            ensemble_.advance(steps);
            follow_turns(static_cast<double>(steps) * step_);
        }
    }

    Bobs<double> bobs(std::size_t k) const override {
        const auto y = ensemble_.state(k);
        if (in_angles_) return bobs_of_angles(pendulums_[k], y);
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

    static bool follows_turns(const MotionSpec& spec) { return spec.model == Model::constraints && spec.follows_turns; }

    void follow_turns(double seconds) {
        for (std::size_t k = 0; k < turns_.size(); ++k) {
            ensemble_.read(k, state_);
            turns_[k].look(state_, seconds);
        }
    }

    bool in_angles_;
    std::vector<Pendulum<double>> pendulums_;
    Ensemble ensemble_;
    long steps_;                // a sample
    double step_;               // s
    long portion_;              // steps in one go
    std::vector<Turns> turns_;  // of each; none where they are not followed
    State<double, Eigen::Dynamic> state_;
};

namespace {

/// Whether they are stepped alike, so that an Ensemble serves.
bool march_in_step(std::span<const MotionSpec> specs) {
    const auto& one = specs.front();
    return one.chain && one.model != Model::mechanism && one.precision == Precision::in_double &&
           one.stabilise == Stabilise::none && Ensemble::serves(one.method) &&
           std::all_of(specs.begin(), specs.end(), [&](const MotionSpec& spec) {
               return spec.chain && spec.chain->links() == one.chain->links() && spec.model == one.model &&
                      spec.precision == one.precision && spec.stabilise == one.stabilise && spec.method == one.method &&
                      spec.sample_interval == one.sample_interval && spec.steps_per_sample == one.steps_per_sample &&
                      spec.follows_turns == one.follows_turns;
           });
}

}  // namespace

Crowd::Crowd(std::span<const MotionSpec> specs, int jobs) : size_(specs.size()), jobs_(std::max(jobs, 1)) {
    if (specs.empty()) throw bad_input("a crowd needs at least one motion");
    // parts that are worth a thread, and fill their registers
    constexpr std::size_t least = 64;
    const auto threads = static_cast<std::size_t>(jobs_);
    part_ = std::max((size_ + threads - 1) / threads, std::size_t(1));
    part_ = (part_ + least - 1) / least * least;
    const bool together = march_in_step(specs);
    for (std::size_t first = 0; first < size_; first += part_) {
        const auto some = specs.subspan(first, std::min(part_, size_ - first));
        if (together) {
            auto part = std::make_unique<Part::SideBySide>(some);
            width_ = part->width();
            parts_.push_back(std::move(part));
        } else {
            parts_.push_back(std::make_unique<Part::OneByOne>(some, first, size_));
        }
    }
}

Crowd::~Crowd() = default;
Crowd::Crowd(Crowd&&) noexcept = default;
Crowd& Crowd::operator=(Crowd&&) noexcept = default;

void Crowd::advance(const std::atomic<bool>& stop) {
    // of several errors always the same one, whoever came first
    std::vector<std::exception_ptr> errors(parts_.size());
    parallel_for(parts_.size(), jobs_, [&](std::size_t i) {
        try {
            parts_[i]->advance(stop);
        } catch (...) {
            errors[i] = std::current_exception();
        }
    });
    for (const auto& error : errors)
        if (error) std::rethrow_exception(error);
}

Bobs<double> Crowd::bobs(std::size_t k) const {
    return parts_[k / part_]->bobs(k % part_);
}

}  // namespace doppel
