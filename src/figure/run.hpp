#pragma once

#include "figure/computation.hpp"
#include "film/run.hpp"

#include <functional>
#include <optional>

namespace doppel {

/// Part `number`, from 1, of `of`.
struct Shard {
    int number = 1, of = 1;
};

struct FigureOptions {
    std::filesystem::path out = "out";  // the files go to OUT/NAME/
    int jobs = 0;                       // threads that compute; 0 = one a core
    std::optional<Shard> shard;         // compute this part alone, into a file for a merge
    bool merge = false;                 // compute nothing: merge the parts
    bool tiles = false;                 // of maps: a pyramid of tiles in place of picture and table (figure/tiles.hpp)
    Replacing replacing = {};
};

/// Progress of the figures, which are numbered as given. Called by any thread, one at a time for one figure.
struct FigureReport {
    std::function<void(std::size_t figure, const FigureProgress&)> progress;
    std::function<void(std::size_t figure, const std::string& sentence)> note;
    std::function<void(std::size_t figure, const RunResult&)> done;
};

/// Makes figures. Threads compute the trials, figure after figure, while the caller's thread draws and writes what is
/// complete. The numbers, and so the tables, are the same to the byte for any number of threads and any register width.
/// A figure that takes more than some seconds records its trials in a file (part_file.hpp, resume_name), from which the
/// same command goes on after an interruption. Of a shard that is the file for the merge; where it is whole, nothing is done.
///
/// Files of a figure appear complete or not at all; those that are complete stay where a later one fails. Throws Error:
/// exit 2 where parts belong to something else, 75 where one is missing, 3, 4 or, soon after `stop` is set, 130.
void run_figures(const std::vector<FigurePreset>& figures, const FigureOptions& options, const std::atomic<bool>& stop,
                 const FigureReport& report);

/// The picture of a figure, without files.
Page compose_figure(const FigurePreset& figure, const KnownTrials& trials);

}  // namespace doppel
