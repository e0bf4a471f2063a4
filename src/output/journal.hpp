#pragma once

#include "output/folder.hpp"

#include <string>
#include <vector>

namespace doppel {

/// Files and folders that replace older ones together: all or none, whenever the process is killed. Each waits as
/// NAME.part, identified by its inode. If the process is killed after the journal's "publish" is on the disk, the next
/// run completes the publication; after "withdraw" it reverts it; "withdrawn": it is reverted.
struct Publication {
    struct Step {
        std::string name;
        ino_t inode = 0;  // of the new one, whatever its name
    };
    enum class State { none, publish, withdraw } state = State::none;
    std::vector<Step> steps;
    std::vector<std::string> removed;  // files to remove on publishing
    std::vector<std::string> parts;    // names of all files begun
};

/// "NAME.part"; "NAME.old.part", where the older one waits if the file system cannot exchange two names.
std::string part_name(const std::string& name);
std::string aside_name(const std::string& name);

/// Whether the new one still has the name NAME.part.
bool is_waiting(const Folder& folder, const Publication::Step& step);

/// Gives every new one that waits its name. Throws Error (exit 4) at the first failure.
void put_in_place(const Folder& folder, const Publication& publication);
/// The reverse: new ones are NAME.part again, old ones NAME. Throws Error (exit 4).
void take_back(const Folder& folder, const Publication& publication);
/// Removes NAME.part and NAME.old.part of every step (the old ones after publishing, the new ones after reverting) and,
/// after publishing, the files `removed`. Throws Error (exit 4).
void clear_away(const Folder& folder, const Publication& publication);

/// A run's lock on a folder, and its journal: a locked file .RUN.lock with the process id and the run's notes, removed
/// at the end. If the run is killed, the file stays unlocked and the next run reads the notes. Where the file system
/// has no locks, the file itself is the lock, void once its process is gone.
class Journal {
public:
    /// Throws Error (exit 4): another process holds it (which one), it cannot be taken (why), or another kind of file
    /// has its name.
    Journal(const Folder& folder, const std::string& run);
    ~Journal();
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    /// From the notes of an earlier run that was killed, or that left them on purpose.
    Publication left() const;
    /// Erases them: the notes of this run begin.
    void begin();
    /// Appends a line; flushed to the disk where `synced`. Throws Error (exit 4).
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
