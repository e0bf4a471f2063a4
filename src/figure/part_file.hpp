#pragma once

#include "figure/preset.hpp"
#include "output/output_file.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace doppel {

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

/// The trials whose numbers are known; others are empty.
using KnownTrials = std::vector<TrialNumbers>;

struct PartFile {
    PartHeader header;
    KnownTrials trials;  // all of the figure's; those in the file are not empty
};

/// Reads a file that PartWriter wrote; lines after the first that is not whole (the writer was killed) are left out.
/// Every number is the one that was written, to the bit. Throws Error (exit 4) where it cannot be read or is something
/// else.
PartFile read_part_file(const std::filesystem::path& path);

/// Writes trials as they are done, so that a run can go on from there: a line of JSON, then a line a trial.
/// Throws Error (exit 4).
class PartWriter {
public:
    /// Begins the file with what is known; one that is there is replaced when that is written.
    PartWriter(const FilePlace& place, const PartHeader& header, const KnownTrials& known);

    void add(std::size_t trial, const TrialNumbers& numbers);
    /// All so far can be read by others.
    void flush() { file_.flush(); }
    void close() { file_.close(); }

private:
    OutputFile file_;
};

}  // namespace doppel
