#pragma once

#include "figure/computation.hpp"

#include <atomic>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

struct FigureOptions {
    std::filesystem::path out = "out";  // the files go to OUT/NAME/
    int jobs = 0;                       // threads that compute; 0 = one per core
    std::optional<Shard> shard;         // compute only this part, into a file for a merge
    bool merge = false;                 // compute nothing: merge the shards
    bool tiles = false;                 // for maps: a pyramid of tiles instead of picture and table (figure/page.hpp)
    Replacing replacing = {};
};

/// Makes figures. Threads compute the trials, figure after figure; the one that completes a figure draws and writes it.
/// The numbers are identical for any number of threads and any register width. After an interruption the same command
/// resumes from the record of a Computation; with `shard`, this file becomes the shard. The files of a figure appear
/// complete or not at all; complete figures stay if a later one fails. Throws Error: exit 2 if shards belong to
/// something else, 75 if one is missing, 3, 4, or 130 soon after `stop` is set.
void run_figures(const std::vector<FigurePreset>& figures, const FigureOptions& options, const std::atomic<bool>& stop,
                 const FigureReport& report);

/// The files that run_figures() writes in OUT/NAME/; names of folders end with "/".
std::vector<std::string> figure_files(const FigurePreset& figure, const FigureOptions& options);

/// Lays out the picture of a figure without writing it.
Page compose_figure(const FigurePreset& figure, const KnownTrials& trials);

}  // namespace doppel
