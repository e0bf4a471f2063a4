#pragma once

#include "image/picture.hpp"
#include "output/files.hpp"
#include "scene/resolved.hpp"

#include <atomic>
#include <mutex>
#include <set>
#include <string>

namespace doppel {

/// A folder of tiles, which belongs to one preset and version: pyramid.json in it says to which. Its tiles are regular
/// files, PNGs of Pyramid::tile pixels a side; they appear whole, and none is replaced. May be used by several threads, and by several processes for tiles of their own.
class TileFolder {
public:
    /// Makes the folder, or takes it where its pyramid.json is `owner`. Throws Error (exit 4) where it is
    /// another's, not Doppel's, or a link, or a tile in it is not as above.
    TileFolder(const std::filesystem::path& folder, const Json& owner);

    const std::filesystem::path& path() const { return folder_; }
    std::size_t count() const;
    bool has(const std::string& tile) const;
    Picture read(const std::string& tile) const;
    /// Nothing where it is there. Throws Error: exit 4; 130 where `stop` was set.
    void write(const std::string& tile, const Picture& picture, const std::atomic<bool>& stop);

private:
    std::filesystem::path folder_;
    mutable std::mutex mutex_;
    std::set<std::string> there_;
};

}  // namespace doppel
