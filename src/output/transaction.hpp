#pragma once

#include "output/journal.hpp"
#include "output/written.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace doppel {

class Error;

/// What a run may replace besides files of its own kind that are as Doppel wrote them.
struct Replacing {
    std::vector<std::filesystem::path> inputs = {};  // which it reads: never
    bool force = false;                              // files of Doppel's that somebody changed, or of another kind
};

/// The files of one run in one folder, which appear complete and together or not at all. Each is written as NAME.part;
/// publish() renames all. If the process is killed, the folder has all new files or all old ones, after the next run of
/// that name there at the latest, which also removes leftovers. Destroyed unpublished, it removes what was written, and
/// the folders it made if they are empty.
///
/// Replaces and removes only what Doppel made (see is_written()) and nobody changed since, and follows no symbolic link
/// in the folder, nor to it.
class Transaction {
public:
    /// Makes `folder` and its parents, and locks it for runs named `run`; runs of other names may write other files
    /// there at the same time. `kind` = "film", "figure" or "fit": files of another kind stay. Throws Error (exit 4)
    /// where that fails or another process has the lock.
    explicit Transaction(const std::filesystem::path& folder, const std::string& run = "run",
                         const std::string& kind = {}, Replacing replacing = {});
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;

    /// Where to write the file NAME until publish(): NAME.part. Throws Error (exit 4) where NAME is not Doppel's, or
    /// cannot be replaced.
    FilePlace file(const std::string& name);
    /// Throws the same for a file that is begun later.
    void demand(const std::string& name) const { refuse_foreign_files(name, false); }
    /// The same for a folder of files, made empty as NAME.part/. Publishing replaces an older folder NAME as a whole.
    const Folder& directory(const std::string& name);
    /// The caller writes NAME.part and renames it itself; if the run is killed, the next one removes NAME.part.
    void note_part(const std::string& name);
    /// Publishing removes the file NAME, where it is Doppel's.
    void remove(const std::string& name);

    /// The file or folder is complete.
    void finished(const std::string& name);
    /// Returns last(), the final steps of a run including publish(). Where it throws, finished files stay as NAME.part
    /// until the next run, and the error (exit 4 where it is not an Error) says so; an interrupted run leaves nothing.
    std::vector<std::filesystem::path> keeping_finished(
        const std::function<std::vector<std::filesystem::path>()>& last);

    /// Removes all parts but the file `name`, which will be published as `new_name`. Returns where it is now.
    FilePlace keep_only(const std::string& name, const std::string& new_name);

    /// The files that are finished, those in folders too: "frames/000000.png", and where each is now.
    std::vector<std::pair<std::string, FilePlace>> finished_files() const;
    /// Files of earlier runs that manifests name and that stay where they are when this run is published.
    WrittenFiles earlier_files() const;

    /// Gives all parts their names, durably; returns their paths in the order of their creation. Throws Error (exit 4),
    /// and then all older files are unchanged.
    std::vector<std::filesystem::path> publish();

    const Folder& folder() const { return folder_; }

private:
    struct Part {
        std::string name;
        std::unique_ptr<Folder> contents;  // where it is a folder
        bool finished = false;
    };
    void recover();
    std::string keep();
    Part& add_part(const std::string& name, bool is_folder);
    void refuse_foreign_files(const std::string& name, bool is_folder) const;
    void refuse_input(const Folder& folder, const std::string& name) const;
    void refuse_changed(const Folder& folder, const std::string& name, const std::string& within = {}) const;
    Publication publication();

    std::string kind_;
    Replacing replacing_;
    std::vector<std::filesystem::path> made_;  // folders, outermost first
    Folder folder_;
    WrittenFiles written_;
    std::optional<Journal> journal_;
    std::vector<Part> parts_;
    std::vector<std::string> removed_;
    bool keeps_finished_ = false;
};

}  // namespace doppel
