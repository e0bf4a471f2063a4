#pragma once

#include "base/error.hpp"
#include "figure/part_file.hpp"

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>

namespace doppel {

/// How far a figure is, in its units.
struct FigureProgress {
    double done = 0, total = 0;
};

/// How a figure gets on, for the person who waits. Called by any thread, one at a time for one figure.
struct ComputationReport {
    std::function<void(const FigureProgress&)> progress;
    std::function<void(const std::string& sentence)> note;  // what it will take; what it goes on from
};

/// The trials of a part of a figure that are not known yet, in groups for threads to take; and the record of them in a
/// file, once that pays. Destroyed before it is complete, it leaves that file.
class Computation {
public:
    /// `record` = the file, where there is to be one; where it is there its trials are known, up to the first
    /// that is damaged. `threads` is for the words. Throws Error (exit 4) where the record is something else, which
    /// stays.
    Computation(const FigurePreset& figure, const PartHeader& header, std::optional<FilePlace> record, int threads,
                ComputationReport report);

    std::size_t groups() const { return groups_.size(); }
    /// One of the groups, each once; any thread. True for the one that was the last to be done: then all is known.
    /// Throws Error: what a trial throws, with where the rest is kept; exit 3 where its numbers cannot be.
    bool compute(std::size_t group, const std::atomic<bool>& stop);
    KnownTrials take() { return std::move(known_); }
    /// The same fault, with how much is kept in the record, and where.
    Error with_record(const Error& fault);

    const PartHeader& header() const { return header_; }
    const std::optional<FilePlace>& record() const { return record_; }
    double computed_units() const { return computed_units_; }  // not read
    double cpu_s() const { return cpu_s_; }                    // of the threads while they computed
    double start_s() const { return start_s_; }                // of the first group, by CLOCK_MONOTONIC

private:
    using Group = std::pair<std::size_t, std::size_t>;  // trials first … last − 1

    void take_record();
    void find_groups();
    bool keep(const Group& group, std::vector<TrialNumbers> numbers, double cpu_s);
    void tell_estimate(double time);
    double percent(double units) const { return total_units_ > 0 ? 100 * units / total_units_ : 100; }

    const FigurePreset& figure_;
    PartHeader header_;
    std::optional<FilePlace> record_;
    int threads_;
    ComputationReport report_;
    std::vector<Group> groups_;
    std::mutex mutex_;  // of all below
    KnownTrials known_;
    std::optional<PartWriter> writer_;
    bool has_record_ = false;
    std::size_t groups_done_ = 0;
    double start_s_ = 0, flushed_s_ = 0, cpu_s_ = 0;
    double done_units_ = 0, kept_units_ = 0, total_units_ = 0, computed_units_ = 0;
};

/// What computing a figure takes, from some of its trials. Throws what a trial throws; exit 130 soon after `stop` is
/// set.
struct ComputationEstimate {
    double seconds;  // on as many threads
    bool at_least;   // where not even one trial was done in the time allowed
};
ComputationEstimate estimated_computation(const FigurePreset& figure, int threads, const std::atomic<bool>& stop);

}  // namespace doppel
