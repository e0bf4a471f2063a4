#pragma once

#include "output/folder.hpp"

#include <string>
#include <vector>

namespace doppel {

/// Some files and folders that take their places in a folder together: all new ones or all old ones, whenever the
/// process is killed. Each waits as NAME.part and is known by its inode. Once the journal says "publish" on the disk the
/// next run goes on with it, or, where it says "withdraw", takes it back ("withdrawn": it is taken back).
struct Publication {
    struct Step {
        std::string name;
        ino_t inode = 0;  // of the new one, wherever it stands
    };
    enum class State { none, publish, withdraw } state = State::none;
    std::vector<Step> steps;
    std::vector<std::string> removed;  // files that go with it
    std::vector<std::string> parts;    // names of all that the run began
};

/// "NAME.part"; and where an older one stands meanwhile where the file system cannot exchange two names.
std::string part_name(const std::string& name);
std::string aside_name(const std::string& name);

/// Whether the new one still has the name NAME.part.
bool is_waiting(const Folder& folder, const Publication::Step& step);

/// Gives every new one that waits its place. Throws Error (exit 4) at the first that cannot have it.
void put_in_place(const Folder& folder, const Publication& publication);
/// Gives every new one that has it its name NAME.part back, and the old ones their places. Throws Error (exit 4).
void take_back(const Folder& folder, const Publication& publication);
/// What has the names NAME.part and NAME.old.part goes: the old ones where all is in place, the new ones where all was
/// taken back; so does what is `removed` where all is in place. Throws Error (exit 4).
void clear_away(const Folder& folder, const Publication& publication);

/// One run's lock on a folder and its journal: a locked file .RUN.lock, with the process's number and the run's notes.
/// The file goes with the run. Where the run was killed it stays, but its lock does not, and the next run takes the
/// notes over. Where the file system knows no locks the file itself is the lock, and that of a killed run is known by
/// its process being gone.
class Journal {
public:
    /// Throws Error (exit 4) that names the folder and the other process where that holds it, or the reason why it
    /// cannot be taken; what is in the place of the file and no lock of Doppel's stays as it is.
    Journal(const Folder& folder, const std::string& run);
    ~Journal();
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    /// By the notes of a run that was killed, or that left some on purpose.
    Publication left() const;
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
