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

/// Progress of a figure. Called by any thread, one at a time for one figure.
struct ComputationReport {
    std::function<void(const FigureProgress&)> progress;
    std::function<void(const std::string& sentence)> note;  // what it will take; what it resumes from
};

/// The unknown trials of a part of a figure, in groups for threads to take, and the file that records them once the
/// computation takes some seconds (resume_name). Destroyed before it is complete, it leaves that file.
class Computation {
public:
    /// `folder` = where the files are. The trials of a finished shard there, or else of the record, are known, up to the
    /// first damaged one. `threads` is for messages. Throws Error (exit 4) where the record is another file, which is
    /// left alone.
    Computation(const FigurePreset& figure, const PartHeader& header, std::optional<std::filesystem::path> folder,
                int threads, ComputationReport report);

    std::size_t groups() const { return groups_.size(); }
    /// Computes a group, each once, on any thread. True for the last one: then all trials are known. Throws Error: what
    /// a trial throws, with the place of the record; exit 3 where its numbers do not fit.
    bool compute(std::size_t group, const std::atomic<bool>& stop);
    KnownTrials take_all() { return std::move(known_); }
    /// The same fault, with the share that is kept in the record, and its path.
    Error with_record(const Error& fault);

    /// The record of all trials becomes the shard. Throws Error (exit 4).
    std::filesystem::path publish_shard();
    const std::filesystem::path& record() const { return record_; }
    double computed_units() const { return computed_units_; }  // without those read
    double cpu_s() const { return cpu_s_; }                    // of the threads while they computed
    double start_s() const { return start_s_; }                // of the first group, by CLOCK_MONOTONIC

private:
    using Group = std::pair<std::size_t, std::size_t>;  // trials first … last − 1

    bool take(const std::filesystem::path& path, bool must_be);
    std::filesystem::path shard() const { return *folder_ / shard_name(header_); }
    void find_groups();
    bool keep(const Group& group, std::vector<TrialNumbers> numbers, double cpu_s);
    void tell_estimate(double time);
    double percent(double units) const { return total_units_ > 0 ? 100 * units / total_units_ : 100; }

    const FigurePreset& figure_;
    PartHeader header_;
    std::optional<std::filesystem::path> folder_;
    std::filesystem::path record_;
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
