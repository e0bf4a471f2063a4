#pragma once

#include "figure/preset.hpp"
#include "output/files.hpp"

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

namespace doppel {

/// The most parts that a figure is shared out to.
inline constexpr int most_parts = 100'000;

/// What a file of trials' numbers belongs to. Files go together where all of it agrees.
struct PartHeader {
    std::string figure, version, revision;
    std::string preset;  // SHA-256 of all that the numbers depend on
    std::size_t trials = 0;
    int shard = 1, of = 1;  // which part, from 1, of how many

    friend bool operator==(const PartHeader&, const PartHeader&) = default;
    /// The trials of this part, first … last − 1: the parts are equal but for one trial.
    std::size_t first() const { return trials * static_cast<std::size_t>(shard - 1) / static_cast<std::size_t>(of); }
    std::size_t last() const { return trials * static_cast<std::size_t>(shard) / static_cast<std::size_t>(of); }
};

PartHeader header_of(const FigurePreset& figure, int shard = 1, int of = 1);

/// "fig8.3-of-8.shard": the file of a part's numbers, for a merge.
std::string shard_name(const PartHeader& header);
/// "fig8.3-of-8.c0ffee123456.resume": the file from which an interrupted run resumes; other headers have other names.
std::string resume_name(const PartHeader& header);
/// The files in the folder that are named like it but are of other presets or versions.
std::vector<std::filesystem::path> other_resumes(const std::filesystem::path& folder, const PartHeader& header);

/// The trials whose numbers are known; others are empty.
using KnownTrials = std::vector<TrialNumbers>;

struct PartFile {
    struct Trial {
        std::size_t number;
        TrialNumbers numbers;
    };
    PartHeader header;
    std::vector<Trial> trials;     // a line each, up to the first that is damaged
    std::size_t damaged_line = 0;  // that line, the header being 1: not as it was written; 0 = none

    /// Moves the numbers to where they belong. A trial whose numbers cannot be its own (Experiment::fits) is a damaged
    /// line. `into` has room for all trials of the experiment, whose file this is.
    void take(const Experiment& experiment, KnownTrials& into);
};

/// Reads a file that PartWriter wrote; a last line without an end (the writer was killed) is left out. Every number is
/// the one that was written, to the bit: each line has a checksum. Throws Error (exit 4) where it cannot be read or is
/// something else than such a file.
PartFile read_part_file(const std::filesystem::path& path);

/// Writes trials as they are done, so that a run can go on from there: a line of JSON, then a line a trial, "TRIAL,
/// NUMBERS;CHECKSUM". Throws Error (exit 4).
class PartWriter {
public:
    /// Begins the file with what is known; one that is there is replaced when that is written.
    PartWriter(const std::filesystem::path& path, const PartHeader& header, const KnownTrials& known);

    void add(std::size_t trial, const TrialNumbers& numbers);
    /// All so far can be read by others.
    void flush() { file_.flush(); }
    void close() { file_.close(); }

private:
    OutputFile file_;
    std::string header_;
};

/// The numbers of a figure from its shards in `folder`, each of which must be there once, whole and of this figure.
/// Throws Error: exit 75 where parts are missing, exit 2 where they are there twice or belong to something else, exit 4
/// where one cannot be
/// read or is damaged, exit 130 soon after `stop` is set.
KnownTrials merged_parts(const FigurePreset& figure, const std::filesystem::path& folder,
                         const std::atomic<bool>& stop);

}  // namespace doppel
