#pragma once

#include "film/run.hpp"
#include "scene/scene.hpp"

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

namespace doppel {

/// Frames first … last − 1.
struct FrameRange {
    long first, last;

    bool contains(long frame) const { return first <= frame && frame < last; }
};

/// The frames of a part, counted in the whole film with its cards. A part consists of whole segments
/// (VideoOptions::segment). Throws Error (exit 2) if the film has fewer segments than parts, or cannot be split.
FrameRange frames_of(const Scene& scene, const Shard& shard);

/// "butterfly.3-of-8.shard"
std::string part_name(const Scene& scene, const Shard& shard);

/// The header of a part, a line of JSON; `gl` = the library that draws it.
std::string part_header(const Scene& scene, const Shard& shard, const std::string& gl);

/// Whether the folder contains this part, complete.
bool is_part_complete(const Scene& scene, const Shard& shard, const std::filesystem::path& folder);

/// The parts of a film in a folder, in order.
struct FilmParts {
    std::vector<std::filesystem::path> files;
    std::string gl;  // the libraries that drew them
};
/// Throws Error: exit 75 if parts are missing, exit 2 if there are parts of another film or number, exit 4 if one
/// cannot be read.
FilmParts parts_in(const Scene& scene, const std::filesystem::path& folder);

/// Writes the pictures of parts to `folder` as 000000.png …
void join_pictures(const FilmParts& parts, const std::filesystem::path& folder, const std::atomic<bool>& stop);

}  // namespace doppel
