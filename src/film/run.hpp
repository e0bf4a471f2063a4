#pragma once

#include "film/recording.hpp"
#include "output/transaction.hpp"
#include "render/renderer.hpp"
#include "scene/scene.hpp"

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace doppel {

/// What a run writes, and where.
struct RunOptions {
    std::filesystem::path out = "out";               // the files go to OUT/NAME/
    bool pictures = true;                            // false: the table and the manifest alone; no GL
    long first = 0, last = -1;                       // frames first … last − 1; all where last < 0
    std::optional<Rational> from_s = {}, to_s = {};  // in their place: times, up to before to_s; to the end without it
    int jobs = 0;                                    // threads that compress PNGs; 0 = one a core
    Gl gl = Gl::automatic;                           // what draws
    std::vector<std::string> columns = {};           // of the table (film/pair_table.hpp); all where there is none
    Replacing replacing = {};
};

/// What came of a run.
struct RunResult {
    std::vector<std::filesystem::path> files;
    long frames = 0;   // pictures written
    long samples = 0;  // rows of the table
    double wall_s = 0;
    std::vector<std::string> warnings = {};  // sentences; the manifest has them, too
};

/// One picture, OUT/NAME/NAME.14s.png (or .pdf, .svg): that of any `time`, s. `options` say where to, and what draws.
/// Throws Error as run(), and exit 2 where the scene ends before.
RunResult draw_still(const Scene& scene, const Rational& time, PictureFormat format, const RunOptions& options,
                     const std::atomic<bool>& stop, const Report& report);
/// That of such a picture. Throws Error (exit 2) where the scene ends before.
Moment still_moment(const Scene& scene, const Rational& time);
/// "NAME.14s.png", of such a picture.
std::string still_name(const Scene& scene, const Moment& moment, PictureFormat format);

/// Throws Error (exit 2) where the scene has not all of the frames, or of the columns, that `options` ask for.
void check_run(const Scene& scene, const RunOptions& options);

/// What run() writes into OUT/NAME/, folders with "/".
std::vector<std::string> run_files(const Scene& scene, bool pictures);

/// Simulates, then draws and writes, which overlap. Files appear complete or not at all.
/// Throws Error: exit 2, 3, 4 or, soon after `stop` is set, 130.
RunResult run(const Scene& scene, const RunOptions& options, const std::atomic<bool>& stop, const Report& report);

}  // namespace doppel
