#pragma once

#include "output/written.hpp"

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace doppel {

/// What a run may replace, besides unchanged files that Doppel made for the same kind of run; and whether what it
/// writes stays.
struct Replacing {
    std::vector<std::filesystem::path> inputs = {};  // files that the run reads: never replaced
    bool force = false;         // also replace Doppel's files that were changed since, or belong to another kind of run
    bool is_temporary = false;  // the folder is removed after the run: nothing in it is kept or named
    bool reads_manifests = true;  // false: Doppel's files are known by their contents alone
};

/// What the writer of FILE keeps beside it until it is complete: FILE.frames.
inline constexpr std::string_view kept_beside = ".frames";

/// The files of one run in one folder, which appear complete and together, or not at all. They are written to a hidden
/// folder in it, .doppel-RUN, locked by the file .lock. publish() moves them to their places. If the process is killed
/// before that, the next run of that name removes them; if it is killed during that, the next run moves in the
/// remaining ones. A run refuses to start while anything else is in its hidden folder. The destructor removes the files
/// that are not published, and the folders it made if they are empty.
/// Only unchanged files that Doppel made (see origin_of()) are replaced or removed. No symbolic link to or in the
/// folder is followed.
class Transaction {
public:
    /// Makes `folder` and its parents, and locks it for runs named `run`. Runs of other names may write other files
    /// there at the same time. `kind` = "film", "figure" or "fit": files of another kind are not replaced. Throws Error
    /// (exit 4) on failure or if another process has the lock.
    explicit Transaction(const std::filesystem::path& folder, const std::string& run = "run", std::string kind = {},
                         Replacing replacing = {});
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;

    /// The path to write the file NAME to, until publish(). Throws Error (exit 4) if NAME exists and may not be
    /// replaced.
    std::filesystem::path file(const std::string& name);
    /// The same for a new empty folder. Publishing replaces an older folder NAME as a whole.
    std::filesystem::path directory(const std::string& name);
    /// Throws as file() and directory() do, for a file or a folder "NAME/" that is written later.
    void require(const std::string& name) const;
    /// Publishing removes the file NAME if Doppel made it.
    void remove(const std::string& name);

    /// Marks the file or folder as complete.
    void finished(const std::string& name);
    /// Returns last(), the final steps of a run including publish(). If it throws, complete files stay in the hidden
    /// folder until the next run, and the error says so (exit 4 for other exceptions). After an interruption nothing
    /// stays.
    std::vector<std::filesystem::path> keeping_finished(
        const std::function<std::vector<std::filesystem::path>()>& last);

    /// Removes all files of the run except the complete file `name`, which will be published as `new_name`.
    void keep_only(const std::string& name, const std::string& new_name);

    /// The complete files, including those in folders: "frames/000000.png".
    std::vector<std::pair<std::string, WrittenFile>> finished_files() const;
    /// Files of earlier runs, listed in manifests, that stay in place when this run is published.
    std::map<std::string, WrittenFile> earlier_files() const;

    /// Moves all files to their places, in the order in which they were begun, the manifest last. Returns their paths.
    /// Throws Error (exit 4): then either all older files are unchanged, or the next run moves in the remaining files.
    std::vector<std::filesystem::path> publish();

    const std::filesystem::path& folder() const { return folder_; }
    bool is_temporary() const { return replacing_.is_temporary; }

private:
    struct Part {
        std::string name;
        bool finished = false;
    };
    Transaction(const std::filesystem::path& folder, std::string kind, Replacing replacing);
    std::filesystem::path hidden(const std::string& name) const { return hidden_ / name; }
    void make_folders();
    bool lock();
    void recover();
    void clear() const;
    void begin();
    void refuse_foreign_file(const std::string& name) const;
    void move_in(const std::string& name);
    std::filesystem::path used(const std::string& name);
    bool is_used(std::string_view name) const;

    std::filesystem::path folder_, hidden_;
    std::string kind_;
    Replacing replacing_;
    std::vector<std::filesystem::path> made_;  // folders that this run made, outermost first
    Stream lock_;
    bool keeps_hidden_ = false;
    WrittenFiles written_;
    std::vector<Part> parts_;
    std::vector<std::string> removed_;
    std::set<std::string, std::less<>>
        used_;  // names of this run's and, at first, an earlier run's files in the hidden folder
};

}  // namespace doppel
