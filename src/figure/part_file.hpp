#pragma once

#include "figure/preset.hpp"
#include "film/parts.hpp"
#include "output/blocks.hpp"

#include <atomic>
#include <filesystem>
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

/// Merges the results of a figure's shards in `folder`. Each must exist once, complete and of this figure. Throws
/// Error: exit 75 if shards are missing, exit 2 for duplicates or shards of other figures, exit 4 if one is unreadable
/// or damaged, exit 130 soon after `stop` is set.
KnownTrials merged_parts(const FigurePreset& figure, const std::filesystem::path& folder,
                         const std::atomic<bool>& stop);

}  // namespace doppel
