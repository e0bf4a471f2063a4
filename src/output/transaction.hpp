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

/// The files of one run in one folder, which appear complete and together or not at all. Each is written as NAME.part;
/// publish() gives all of them their names once every one is whole: whenever the process is killed, the new ones stand
/// there or the old ones, after the next run at the latest. Destroyed unpublished, it removes what was written, and the
/// folders it made if they are empty. What a run leaves that was killed, the next one of its name in the folder
/// removes.
///
/// Only what Doppel made is replaced or removed (see is_written()), and no symbolic link in the folder, nor the folder
/// if it is one, is followed.
class Transaction {
public:
    /// Makes `folder` (and what leads to it) and takes it for this `run`; runs of other names may write other files
    /// there at the same time. Throws Error (exit 4) where that fails, something else is in its place, or another
    /// process has such a run there.
    explicit Transaction(const std::filesystem::path& folder, const std::string& run = "run");
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;

    /// Where to write the file NAME for now: NAME.part. Throws Error (exit 4) where NAME is taken by something that is
    /// not Doppel's, or cannot be replaced.
    FilePlace file(const std::string& name);
    /// The same for a folder of files, made empty as NAME.part/. Publishing replaces an older folder NAME as a whole:
    /// at any time it holds the files of one run.
    const Folder& directory(const std::string& name);
    /// The caller writes NAME.part and renames it on its own: what a killed run leaves of it goes with the next.
    void note_part(const std::string& name);
    /// The file NAME, where it is Doppel's, goes when this run is published.
    void remove(const std::string& name);

    /// The file or folder is whole.
    void finished(const std::string& name);
    /// What `last` returns: the last steps of a run, its publishing included. Where it throws, what is finished by then
    /// stays as NAME.part until the next run, and the error (exit 4 where it was none of ours) says so; but an
    /// interrupted run leaves nothing.
    std::vector<std::filesystem::path> keeping_finished(
        const std::function<std::vector<std::filesystem::path>()>& last);

    /// Of the parts so far only the file `name` is kept, and will be published as `new_name`; the others are removed.
    /// Where it is now.
    FilePlace keep_only(const std::string& name, const std::string& new_name);

    /// The files that are finished, those in folders too: "frames/000000.png", and where each is now.
    std::vector<std::pair<std::string, FilePlace>> finished_files() const;
    /// Files of earlier runs that manifests name and that stay where they are when this run is published.
    WrittenFiles earlier_files() const;

    /// Gives all parts their names, on the disk, and returns where they are now, in the order in which they were asked
    /// for. Throws Error (exit 4); then all older files stand where they stood.
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
    Publication publication();

    std::vector<std::filesystem::path> made_;  // folders, outermost first
    Folder folder_;
    WrittenFiles written_;
    std::optional<Journal> journal_;
    std::vector<Part> parts_;
    std::vector<std::string> removed_;
    bool keeps_finished_ = false;
};

}  // namespace doppel
