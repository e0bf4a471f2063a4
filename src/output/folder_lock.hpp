#pragma once

#include <filesystem>
#include <string>

namespace doppel {

/// One run's hold on a folder: a locked file in it, with the number of the process and the names of what it is writing.
/// The file goes with the run. Where the run was killed it stays, but its lock does not, and the next run removes what
/// it names.
class FolderLock {
public:
    /// FOLDER/.RUN.lock, where `folder` exists; what a killed run left is gone then. Throws Error (exit 4) that names
    /// the folder and the other process where that is locked, or the reason why it cannot be written.
    FolderLock(const std::filesystem::path& folder, const std::string& run);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

    /// Writes down NAME.part, a file or folder in the folder, before that is made. Throws Error (exit 4).
    void note(const std::string& part);

private:
    std::filesystem::path path_;
    int file_ = -1;
};

}  // namespace doppel
