#pragma once

#include "output/folder_lock.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// The files of one run, which appear complete or not at all. Each is written as NAME.part; publish() gives all of them
/// their names once every one is whole. Destroyed unpublished, it removes what was written, and the folders it made if
/// they are empty. What a run leaves that was killed, the next one of its name in the folder removes.
class PartFiles {
public:
    /// Makes `folder` (and what leads to it) and takes it for this `run`; runs of other names may write other files
    /// there at the same time. Throws Error (exit 4) where that fails, something else is in its place, or another
    /// process has such a run there.
    explicit PartFiles(std::filesystem::path folder, const std::string& run = "run");
    ~PartFiles();
    PartFiles(const PartFiles&) = delete;
    PartFiles& operator=(const PartFiles&) = delete;

    /// The path FOLDER/NAME.part to write to; a stale one is removed. Throws Error (exit 4) where FOLDER/NAME is taken
    /// by something of another kind (a folder in place of the file).
    std::filesystem::path file(const std::string& name);
    /// The same for a folder NAME, made empty as NAME.part/. Publishing replaces an older folder NAME as a whole: at
    /// any time it holds the files of one run.
    std::filesystem::path directory(const std::string& name);

    /// Of the parts so far only `name` is kept, and will be published as `new_name`; the others are removed.
    void keep_only(const std::string& name, const std::string& new_name);

    /// Gives every part its name, in the order they were asked for. Throws Error (exit 4); then nothing of this run
    /// stays.
    void publish();

    const std::filesystem::path& folder() const { return folder_; }

private:
    struct Part {
        std::filesystem::path target;
        std::filesystem::path written;  // where it is now: NAME.part, then target
    };
    std::filesystem::path add_part(const std::string& name);

    std::filesystem::path folder_;
    std::vector<std::filesystem::path> made_;  // folders, outermost first
    std::optional<FolderLock> lock_;
    std::vector<Part> parts_;
};

}  // namespace doppel
