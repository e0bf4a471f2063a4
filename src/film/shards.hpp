#pragma once

#include "base/error.hpp"
#include "scene/resolved.hpp"

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

/// The largest number of parts that a run can be split into.
inline constexpr int max_parts = 100'000;

/// The keys "shard" and "of" of a header, if they are valid.
std::optional<Shard> shard_of(const Json& header);

/// Throws Error (exit 2) if a part belongs to another film, figure, preset or version: if its header differs from
/// `wanted` in one of these keys. `verb` = how a part is made, "render".
void check_identity(const std::filesystem::path& path, const Json& header, const Json& wanted, const Shard& shard,
                    std::string_view verb);

/// The files NAME.*.shard in a folder, one of each part, in order. take(path) reads one, throws if it does not belong,
/// and returns which part it is. Throws Error: exit 75 if parts are missing, exit 2 if some are of another number of
/// parts, or two are the same part.
std::vector<std::filesystem::path> all_parts(const std::filesystem::path& folder, const std::string& name,
                                             const std::function<Shard(const std::filesystem::path&)>& take);

}  // namespace doppel
