#pragma once

#include "figure/part_file.hpp"
#include "image/picture.hpp"
#include "output/folder.hpp"

#include <atomic>
#include <mutex>
#include <set>
#include <string>

namespace doppel {

/// A folder of tiles, which belongs to one preset and version: pyramid.json in it says to which. Its tiles appear whole,
/// and none is replaced. May be used by several threads, and by several processes for tiles of their own.
class TileFolder {
public:
    /// Makes the folder in `above`, or takes it where it is the same's. Throws Error (exit 4) where it is another's, not
    /// Doppel's, or a link.
    TileFolder(const Folder& above, const std::string& name, const PartHeader& header);

    std::filesystem::path path() const { return folder_.path(); }
    std::size_t count() const;
    bool has(const std::string& tile) const;
    Picture read(const std::string& tile) const;
    /// Nothing where it is there. Throws Error: exit 4; 130 where `stop` was set.
    void write(const std::string& tile, const Picture& picture, const std::atomic<bool>& stop);

private:
    Folder folder_;
    mutable std::mutex mutex_;
    std::set<std::string> there_;
};

}  // namespace doppel
