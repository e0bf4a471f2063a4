#pragma once

#include "base/error.hpp"
#include "base/machine.hpp"
#include "figure/preset.hpp"
#include "film/parts.hpp"
#include "film/run.hpp"
#include "output/blocks.hpp"

#include <atomic>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// Identifies the run that a file of results belongs to. Files belong together if all members agree.
struct PartHeader {
    std::string figure, version, revision;
    std::string preset;  // SHA-256 of all settings that the numbers depend on
    std::size_t trials = 0;
    int shard = 1, of = 1;  // number of the part, from 1, and number of parts

    friend bool operator==(const PartHeader&, const PartHeader&) = default;
    /// The trials of this part, first … last − 1. The sizes of parts differ by at most one trial.
    std::size_t first() const { return trials * static_cast<std::size_t>(shard - 1) / static_cast<std::size_t>(of); }
    std::size_t last() const { return trials * static_cast<std::size_t>(shard) / static_cast<std::size_t>(of); }
};

PartHeader header_of(const FigurePreset& figure, const Shard& shard = {});

/// "fig8.3-of-8.shard": the file with the results of a part, for a merge.
std::string shard_name(const PartHeader& header);
/// "fig8.3-of-8.c0ffee123456.resume": the file from which an interrupted run resumes; its name depends on the header.
std::string resume_name(const PartHeader& header);
/// Files in the folder with such names, but of other presets or versions.
std::vector<std::filesystem::path> other_resumes(const std::filesystem::path& folder, const PartHeader& header);

/// The numbers of each trial; empty if they are unknown.
using KnownTrials = std::vector<TrialNumbers>;

struct PartFile {
    struct Trial {
        std::size_t number;
        TrialNumbers numbers;
    };
    PartHeader header;
    std::vector<Trial> trials = {};  // in the file's order, up to a damaged or incomplete one
    bool is_damaged = false;         // or incomplete: its writer was killed

    /// Moves the numbers to their trials. A trial with invalid numbers (Experiment::fits) counts as damaged.
    /// `into` must have the size of all trials.
    void take(const Experiment& experiment, KnownTrials& into);
};

/// Reads a file that PartWriter wrote, or is writing. Throws Error (exit 4) if it cannot be read or is something else.
PartFile read_part_file(const std::filesystem::path& path);

/// Writes trials when they are done, each a block, so that a run can be resumed. Throws Error (exit 4).
class PartWriter {
public:
    /// Begins the file with the known trials. An older file is replaced once these are written.
    PartWriter(const std::filesystem::path& path, const PartHeader& header, const KnownTrials& known);

    void add(std::size_t trial, TrialNumbers numbers);
    /// Makes all trials up to now readable for others.
    void flush() { file_.flush(); }
    void finish() { file_.finish(); }

private:
    BlockFile file_;
};

/// The results of a figure's shards in `folder`. Throws Error: exit 75 if shards are missing, exit 2 for duplicates or
/// shards of other figures, exit 4 if one is unreadable or damaged, exit 130 soon after `stop` is set.
KnownTrials merged_parts(const FigurePreset& figure, const std::filesystem::path& folder,
                         const std::atomic<bool>& stop);

struct FigureProgress {
    double done = 0, total = 0;
};

/// Reports progress of the figures, numbered as given, and notes: the record that one resumes from.
/// Called by any thread, by one at a time for one figure.
struct FigureReport {
    std::function<void(std::size_t figure, const FigureProgress&)> progress = [](auto, const auto&) {};
    std::function<void(std::size_t figure, const std::string& sentence)> note = [](auto, const auto&) {};
    std::function<void(std::size_t figure, const RunResult&)> done = [](auto, const auto&) {};
};

/// Computes the unknown trials of a part of a figure, which threads take. After some seconds it records results in a
/// file (resume_name). If it is destroyed before it is complete, the file stays.
class Computation {
public:
    /// Reads the known trials from a finished shard in `folder`, or else from the record, up to a damaged one. `number`
    /// = the figure's in `report`. Throws Error (exit 4) if the record is something else; it is then left unchanged.
    Computation(const FigurePreset& figure, const PartHeader& header, std::optional<std::filesystem::path> folder,
                FigureReport report, std::size_t number = 0);

    /// The unknown trials, in the order in which they are best computed.
    const std::vector<std::size_t>& unknown() const { return unknown_; }
    double total_units() const { return total_units_; }
    /// Computes an unknown trial, each once; whether it was the last. Throws Error: that of the trial, with_record();
    /// exit 3 if its numbers are invalid.
    bool compute(std::size_t trial, const std::atomic<bool>& stop);
    KnownTrials take_all() { return std::move(known_); }
    /// The same error, with the share of results kept in the record and its path.
    Error with_record(const Error& error);

    /// Turns the record of all trials into the shard. Throws Error (exit 4).
    std::filesystem::path publish_shard();
    const std::filesystem::path& record() const { return record_; }
    double computed_units() const { return computed_units_; }  // without those read from files
    double cpu_s() const { return cpu_s_; }
    double start_s() const { return start_s_; }  // of the first trial, by CLOCK_MONOTONIC

private:
    bool take(const std::filesystem::path& path, bool must_be);
    std::filesystem::path shard() const { return *folder_ / shard_name(header_); }
    void find_unknown();
    bool keep(std::size_t trial, TrialNumbers numbers, double cpu_s);
    double percent(double units) const { return total_units_ > 0 ? 100 * units / total_units_ : 100; }

    const FigurePreset& figure_;
    PartHeader header_;
    std::optional<std::filesystem::path> folder_;
    std::filesystem::path record_;
    FigureReport report_;
    std::size_t number_;
    std::vector<std::size_t> unknown_;
    std::mutex mutex_;  // guards all members below
    KnownTrials known_;
    std::optional<PartWriter> writer_;
    bool has_record_ = false, is_whole_ = false;  // results in a file, and that file is not damaged
    std::size_t computed_ = 0;                    // trials
    double start_s_ = 0, flushed_s_ = 0, cpu_s_ = 0;
    double done_units_ = 0, total_units_ = 0, computed_units_ = 0;
};

/// What a figure takes with so many threads, extrapolated from some trials. The process's memory counts from
/// reset_peak_memory() on. Throws the error of a trial; exit 130 soon after `stop` is set.
Needs estimated_computation(const FigurePreset& figure, int threads, const std::atomic<bool>& stop);

}  // namespace doppel
