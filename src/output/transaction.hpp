#pragma once

#include "output/written.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace doppel {

/// What a run may replace besides files of its own kind that are as Doppel wrote them.
struct Replacing {
    std::vector<std::filesystem::path> inputs = {};  // which it reads: never
    bool force = false;                              // files of Doppel's that somebody changed, or of another kind
};

/// The files of one run in one folder, which appear complete and together or not at all. They are written into a hidden
/// folder there, .doppel-RUN, locked by .lock in it, and publish() moves them to their places. If the process is killed
/// before it begins to, the next run of that name removes them; after that, it moves in what is left. Destroyed
/// unpublished, it removes what was written, and the folders it made if they are empty.
///
/// Replaces and removes only what Doppel made (see origin_of()) and nobody changed since, and follows no symbolic link
/// in the folder, nor to it.
class Transaction {
public:
    /// Makes `folder` and its parents, and locks it for runs named `run`; runs of other names may write other files
    /// there at the same time. `kind` = "film", "figure" or "fit": files of another kind stay. Throws Error (exit 4)
    /// where that fails or another process has the lock.
    explicit Transaction(std::filesystem::path folder, const std::string& run = "run", std::string kind = {},
                         Replacing replacing = {});
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;

    /// Where to write the file NAME until publish(). Throws Error (exit 4) where NAME is not Doppel's, or cannot be
    /// replaced.
    std::filesystem::path file(const std::string& name);
    /// The same for a folder of files, made empty. Publishing replaces an older folder NAME as a whole.
    std::filesystem::path directory(const std::string& name);
    /// Throws as file() does, for a file that is begun later.
    void require(const std::string& name) const { refuse_foreign_files(name, false); }
    /// Publishing removes the file NAME, where it is Doppel's.
    void remove(const std::string& name);

    /// The file or folder is complete.
    void finished(const std::string& name);
    /// Returns last(), the final steps of a run including publish(). Where it throws, finished files stay in the hidden
    /// folder until the next run, and the error (exit 4 where it is not an Error) says so; an interrupted run leaves
    /// nothing.
    std::vector<std::filesystem::path> keeping_finished(
        const std::function<std::vector<std::filesystem::path>()>& last);

    /// Removes all files of the run but `name`, which is complete and will be published as `new_name`.
    void keep_only(const std::string& name, const std::string& new_name);

    /// The files that are finished, those in folders too: "frames/000000.png".
    std::vector<std::pair<std::string, WrittenFile>> finished_files() const;
    /// Files of earlier runs that manifests name and that stay where they are when this run is published.
    std::map<std::string, WrittenFile> earlier_files() const;

    /// Gives all files their places, in the order in which they were begun: the manifest comes last. Returns their paths.
    /// Throws Error (exit 4): then either all older files are unchanged, or the next run moves in what is left.
    std::vector<std::filesystem::path> publish();

    const std::filesystem::path& folder() const { return folder_; }

private:
    struct Part {
        std::string name;
        bool finished = false;
    };
    Transaction(std::filesystem::path folder, std::string kind, Replacing replacing);
    std::filesystem::path hidden(const std::string& name) const { return hidden_ / name; }
    void make_folders();
    bool lock();
    void recover();
    void clear() const;
    void begin();
    void refuse_foreign_files(const std::string& name, bool is_folder) const;
    void refuse_foreign_file(const std::string& name) const;
    void commit();
    void move_in(const std::string& name) const;

    std::filesystem::path folder_, hidden_;
    std::string kind_;
    Replacing replacing_;
    std::vector<std::filesystem::path> made_;  // folders, outermost first
    Stream lock_;
    bool keeps_hidden_ = false;
    WrittenFiles written_;
    std::vector<Part> parts_;
    std::vector<std::string> removed_;
};

}  // namespace doppel
