#pragma once

#include "base/error.hpp"
#include "scene/resolved.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

/// Part `number`, from 1, of `of`.
struct Shard {
    int number = 1, of = 1;
};

inline constexpr int max_parts = 100'000;

/// The keys "shard" and "of" of a header, if they are valid.
std::optional<Shard> shard_of(const Json& header);

/// Throws Error (exit 2) if the header of a part differs from `wanted` in one of these keys. `verb`: "render".
void check_identity(const std::filesystem::path& path, const Json& header, const Json& wanted, const Shard& shard,
                    std::string_view verb);

/// The files NAME.*.shard in a folder, one of each part, in order. take(path) reads one, throws if it does not belong,
/// and returns which part it is. Throws Error: exit 75 if parts are missing, exit 2 if some are of another number of
/// parts, or two are the same part.
std::vector<std::filesystem::path> all_parts(const std::filesystem::path& folder, const std::string& name,
                                             const std::function<Shard(const std::filesystem::path&)>& take);

/// The largest number of parts into which a film can be split: one for each segment; 1 if its format has none.
long max_shards(const Scene& scene);

/// Frames first … last − 1 of the whole film with its cards; if `only` is not empty, these of them, in order.
struct FrameRange {
    long first, last;
    std::vector<long> only = {};

    bool contains(long frame) const {
        return only.empty() ? first <= frame && frame < last : std::ranges::binary_search(only, frame);
    }
    long count() const { return only.empty() ? last - first : static_cast<long>(only.size()); }
    /// The number of its frame k.
    long at(long k) const { return only.empty() ? first + k : only[static_cast<std::size_t>(k)]; }
};

/// A part consists of whole segments (VideoOptions::segment). Throws Error (exit 2) if the film has too few of them.
FrameRange frames_of(const Scene& scene, const Shard& shard);

/// "butterfly.3-of-8.shard"
std::string part_name(const Scene& scene, const Shard& shard);

/// The header of a part, a line of JSON; `gl` = the library that draws it.
std::string part_header(const Scene& scene, const Shard& shard, const std::string& gl);

/// Whether the folder contains this part, complete.
bool is_part_complete(const Scene& scene, const Shard& shard, const std::filesystem::path& folder);

/// The parts of a film in a folder, in order. Throws Error as all_parts(), and exit 4 if one cannot be read.
std::vector<std::filesystem::path> parts_in(const Scene& scene, const std::filesystem::path& folder);

}  // namespace doppel
