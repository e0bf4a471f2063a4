#pragma once

#include "output/folder.hpp"

#include <string>
#include <vector>

namespace doppel {

/// One run's hold on a folder: a locked file .RUN.lock in it, with the number of the process and the notes of the run.
/// The file goes with the run. Where the run was killed it stays, but its lock does not, and the next run takes the
/// notes over. Where the file system knows no locks the file itself is the hold, and that of a killed run is known by
/// its process being gone.
class FolderLock {
public:
    /// Throws Error (exit 4) that names the folder and the other process where that holds it, or the reason why it
    /// cannot be taken; what is in the place of the file and no lock of Doppel's stays as it is.
    FolderLock(const Folder& folder, const std::string& run);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

    /// The notes of a run that was killed, or that left some on purpose.
    const std::vector<std::string>& left() const { return left_; }
    /// They are done with: the notes of this run begin.
    void begin();
    /// A line, on the disk where `synced`. Throws Error (exit 4).
    void note(const std::string& line, bool synced = false);
    /// Whether the file and its notes stay for the next run.
    void leave(bool leaves = true) { leaves_ = leaves; }

private:
    void take();
    void read_notes();

    const Folder& folder_;
    const std::string name_;
    Descriptor file_;
    std::vector<std::string> left_;
    bool leaves_ = false;
};

}  // namespace doppel
