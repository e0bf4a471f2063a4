#pragma once

#include "output/folder.hpp"

#include <string>
#include <vector>

namespace doppel {

/// Some files and folders that take their places in a folder together: all new ones or all old ones, whenever the
/// process is killed. Each waits as NAME.part and is known by its inode. The lock file of the run is the journal: once
/// it says "publish" on the disk the next run goes on with it, or, where it says "withdraw", takes it back
/// ("withdrawn": it is taken back).
struct Publication {
    struct Step {
        std::string name;
        ino_t inode = 0;  // of the new one, wherever it stands
    };
    enum class State { none, publish, withdraw } state = State::none;
    std::vector<Step> steps;
    std::vector<std::string> removed;  // files that go with it
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

/// A file, or a folder of files; nothing where it is not there. Throws Error (exit 4), where it is of another kind too.
void remove_entry(const Folder& folder, const std::string& name);

/// The journal's lines of it, without the last, which says the state.
std::vector<std::string> journal_of(const Publication& publication);
/// What the notes of a run that was killed say: the names of its parts, and the publication it was at.
struct Notes {
    std::vector<std::string> parts;
    Publication publication;
};
Notes read_notes(const std::vector<std::string>& lines);

}  // namespace doppel
