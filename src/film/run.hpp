#pragma once

#include "film/parts.hpp"
#include "film/recording.hpp"
#include "output/transaction.hpp"
#include "render/renderer.hpp"
#include "scene/scene.hpp"

#include <array>
#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

template <>
inline constexpr auto names_of<Gl> = std::to_array<std::string_view>({"auto", "osmesa", "egl"});

/// What a run writes, and to which folder.
struct RunOptions {
    std::filesystem::path out = "out";               // the files go to OUT/NAME/
    bool pictures = true;                            // false: only the table and the manifest; no OpenGL
    long first = 0, last = -1;                       // frames first … last − 1; all if last < 0
    std::optional<Rational> from_s = {}, to_s = {};  // instead of frames, a period: up to before to_s, or to the end
    int jobs = 0;                                    // threads that compress PNGs; 0 = one per core
    Gl gl = Gl::automatic;                           // which OpenGL draws
    std::vector<std::string> columns = {};           // of the table (film/pair_table.hpp); all if empty
    Replacing replacing = {};
    bool checks_accuracy = true;           // false: without the warnings of add_warnings()
    std::optional<Shard> shard = {};       // only this part of the film, into a file for a merge
    std::vector<long> only = {};           // only these pictures of the film, counted with its cards, without a table
    bool merge = false;                    // draw nothing: join the parts in OUT/NAME/
    bool to_stream = false;                // the film goes to standard output while it is made
    std::filesystem::path recording = {};  // read the motion from this file
    std::filesystem::path record_to = {};  // also write the motion to this file

    /// Whether no table and no manifest are written.
    bool is_part() const { return shard || !only.empty(); }
    bool is_partial() const { return first != 0 || last >= 0 || from_s || to_s; }
};

struct RunResult {
    std::vector<std::filesystem::path> files;
    long frames = 0;   // pictures written
    long samples = 0;  // rows of the table
    double wall_s = 0;
    std::vector<std::string> warnings = {};  // also in the manifest
};

/// Draws one picture at any `time`, s, as OUT/NAME/NAME.14s.png (or .pdf, .svg). Of `options`, `out` and `gl` apply.
/// Throws Error as run(), and exit 2 if the scene ends earlier.
RunResult draw_still(const Scene& scene, const Rational& time, PictureFormat format, const RunOptions& options,
                     const std::atomic<bool>& stop, const Report& report);
/// The file name of such a picture: "NAME.14s.png". Throws Error (exit 2) if the scene ends earlier.
std::string still_name(const Scene& scene, const Rational& time, PictureFormat format);

/// Throws Error (exit 2) if the scene lacks some of the frames or columns in `options`, or cannot be split as they say.
void check_run(const Scene& scene, const RunOptions& options);

/// The files that run() writes in OUT/NAME/; names of folders end with "/".
std::vector<std::string> run_files(const Scene& scene, const RunOptions& options);

/// Simulates, draws and writes, in parallel. A part of a film that is complete is not made again. Throws Error: exit 2,
/// 3, 4, 75 if parts are missing, or 130 soon after `stop` is set.
RunResult run(const Scene& scene, const RunOptions& options, const std::atomic<bool>& stop, const Report& report);

}  // namespace doppel
