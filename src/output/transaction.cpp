#include "output/transaction.hpp"

#include "base/error.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <system_error>
#include <utility>

namespace doppel {
namespace {

namespace fs = std::filesystem;

using Kind = Entry::Kind;

/// Opens the folder; its parents may be links, it may not.
Folder open_last(const fs::path& folder, const std::vector<fs::path>& made) {
    try {
        if (!folder.has_filename() || folder.filename() == "." || folder.filename() == "..") return Folder::at(folder);
        const auto parent = folder.has_parent_path() ? folder.parent_path() : fs::path(".");
        if (fs::is_symlink(folder))
            throw io_failed("{} is a symbolic link; Doppel follows none there", folder.string());
        return Folder::at(parent).folder(folder.filename(), folder);
    } catch (...) {
        remove_folders(made);
        throw;
    }
}

/// "000000.png": a picture of a sequence.
bool is_numbered_picture(const std::string& name) {
    return name.ends_with(".png") && name.size() > 4 &&
           std::all_of(name.begin(), name.end() - 4, [](unsigned char c) { return std::isdigit(c); });
}

Error not_ours(const fs::path& path) {
    return io_failed("{} was not written by Doppel, as far as it knows; move it, or give another folder with --out",
                     path.string());
}

void remove_quietly(const Folder& folder, const std::string& name) {
    try {
        folder.remove(name);
    } catch (const Error&) {
        // something foreign there stays
    }
}

}  // namespace

Transaction::Transaction(const fs::path& folder, const std::string& run, const std::string& kind, Replacing replacing)
    : kind_(kind), replacing_(std::move(replacing)), made_(make_folders(folder)), folder_(open_last(folder, made_)) {
    try {
        journal_.emplace(folder_, run);
        recover();
        written_ = written_files(folder_);
    } catch (...) {
        journal_.reset();
        remove_folders(made_);
        throw;
    }
}

Transaction::~Transaction() {
    for (const Part& part : parts_)
        if (!keeps_finished_ || !part.finished) remove_quietly(folder_, part_name(part.name));
    journal_.reset();
    remove_folders(made_);
}

/// Completes or reverts what a killed run had begun, and removes what it left.
void Transaction::recover() {
    const auto left = journal_->left();
    journal_->leave();  // for the next run, where this fails
    if (left.state == Publication::State::publish) {
        written_ = written_files(folder_);
        for (const auto& step : left.steps)
            if (is_waiting(folder_, step))
                refuse_foreign_files(step.name, folder_.entry(part_name(step.name)).kind == Kind::folder);
        put_in_place(folder_, left);
    }
    if (left.state == Publication::State::withdraw) take_back(folder_, left);
    clear_away(folder_, left);
    for (const auto& name : left.parts) {
        folder_.remove(part_name(name));
        folder_.remove(aside_name(name));
    }
    journal_->begin();
    journal_->leave(false);
}

/// By the file, not the path: links and hard links are the same.
void Transaction::refuse_input(const Folder& folder, const std::string& name) const {
    std::error_code error;
    for (const auto& input : replacing_.inputs)
        if (fs::equivalent(input, folder.path() / name, error) && !error)
            throw io_failed("{} is read by this run and would be replaced; give another folder with --out",
                            (folder.path() / name).string());
}

void Transaction::refuse_changed(const Folder& folder, const std::string& name, const std::string& within) const {
    if (!replacing_.force && is_changed(folder, name, written_, within))
        throw io_failed(
            "{} is not as Doppel wrote it: somebody changed it; move it, give another folder with --out, or replace it "
            "with --force",
            (folder.path() / name).string());
}

void Transaction::refuse_foreign_files(const std::string& name, bool is_folder) const {
    const auto path = folder_.path() / name;
    switch (folder_.entry(name).kind) {
        case Kind::none:
            return;
        case Kind::link:
            throw io_failed("{} is a symbolic link; Doppel follows none there", path.string());
        case Kind::other:
            throw io_failed("{} is neither a file nor a folder; remove it", path.string());
        case Kind::file:
            if (is_folder) throw io_failed("{} is a file; Doppel would make a folder there", path.string());
            refuse_input(folder_, name);
            if (!is_written(folder_, name, written_)) throw not_ours(path);
            if (const auto kind = kind_of_file(folder_, name, written_);
                !replacing_.force && !kind_.empty() && !kind.empty() && kind != kind_)
                throw io_failed(
                    "{} is of a {}, and this is a {}; give another folder with --out, or replace it with --force",
                    path.string(), kind, kind_);
            refuse_changed(folder_, name);
            // an immutable file (chattr +i) cannot be renamed, a read-only one can: say so before work starts
            if (faccessat(folder_.descriptor(), name.c_str(), W_OK, 0) != 0 && errno == EPERM)
                throw cannot(path, "replaced");
            return;
        case Kind::folder:
            break;
    }
    if (!is_folder) throw io_failed("{} is a folder; Doppel would write a file there", path.string());
    const Folder inside = folder_.folder(name);
    for (const auto& file : inside.names()) {
        const bool ours =
            inside.entry(file).kind == Kind::file &&
            (written_.contains(name + "/" + file) || (is_numbered_picture(file) && is_written(inside, file, written_)));
        if (inside.entry(file).kind == Kind::file) refuse_input(inside, file);
        if (!ours) throw not_ours(path / file);
        refuse_changed(inside, file, name + "/");
    }
}

Transaction::Part& Transaction::add_part(const std::string& name, bool is_folder) {
    refuse_foreign_files(name, is_folder);
    const auto part = part_name(name);
    for (const auto& taken : {part, aside_name(name)})
        if (folder_.entry(taken).kind != Kind::none) throw not_ours(folder_.path() / taken);
    note_part(name);
    return parts_.emplace_back(Part{name, nullptr});
}

FilePlace Transaction::file(const std::string& name) {
    add_part(name, false);
    return {folder_, part_name(name)};
}

const Folder& Transaction::directory(const std::string& name) {
    Part& part = add_part(name, true);
    folder_.make_folder(part_name(name));
    part.contents = std::make_unique<Folder>(folder_.folder(part_name(name)));
    return *part.contents;
}

void Transaction::note_part(const std::string& name) {
    journal_->note("part " + name);
}

void Transaction::remove(const std::string& name) {
    if (folder_.entry(name).kind == Kind::file && is_written(folder_, name, written_) &&
        !is_changed(folder_, name, written_))
        removed_.push_back(name);
}

void Transaction::finished(const std::string& name) {
    for (Part& part : parts_) part.finished = part.finished || part.name == name;
}

std::vector<fs::path> Transaction::keeping_finished(const std::function<std::vector<fs::path>()>& last) {
    try {
        return last();
    } catch (const Error& error) {
        if (error.code() == ExitCode::interrupted) throw;
        throw Error(error.code(), error.what() + keep());
    } catch (const std::exception& error) {
        throw io_failed("{}{}", error.what(), keep());
    }
}

/// Keeps what is finished; returns the sentence that says so.
std::string Transaction::keep() {
    std::string names;
    for (const Part& part : parts_)
        if (part.finished) names += (names.empty() ? "" : ", ") + (folder_.path() / part_name(part.name)).string();
    if (names.empty()) return "";
    keeps_finished_ = true;
    journal_->leave();
    return "; what is finished stays until the next run: " + names;
}

FilePlace Transaction::keep_only(const std::string& name, const std::string& new_name) {
    refuse_foreign_files(new_name, false);
    note_part(new_name);
    std::erase_if(parts_, [&](const Part& part) {
        if (part.name == name) return false;
        remove_quietly(folder_, part_name(part.name));
        return true;
    });
    folder_.rename(part_name(name), part_name(new_name));
    for (Part& part : parts_) part.name = new_name;
    return {folder_, part_name(new_name)};
}

std::vector<std::pair<std::string, FilePlace>> Transaction::finished_files() const {
    std::vector<std::pair<std::string, FilePlace>> files;
    for (const Part& part : parts_) {
        if (!part.finished) continue;
        if (!part.contents) files.emplace_back(part.name, FilePlace(folder_, part_name(part.name)));
        for (const auto& name : part.contents ? part.contents->names() : std::vector<std::string>())
            files.emplace_back(part.name + "/" + name, FilePlace(*part.contents, name));
    }
    return files;
}

WrittenFiles Transaction::earlier_files() const {
    WrittenFiles earlier;
    for (const auto& [name, about] : written_) {
        const auto slash = name.find('/');
        const auto first = name.substr(0, slash);
        const auto is_first = [&](const std::string& other) { return other == first; };
        if (std::ranges::any_of(parts_, is_first, &Part::name) || std::ranges::any_of(removed_, is_first)) continue;
        const auto kind = folder_.entry(first).kind;
        const bool stands =
            slash == std::string::npos
                ? kind == Kind::file
                : kind == Kind::folder && folder_.folder(first).entry(name.substr(slash + 1)).kind == Kind::file;
        if (stands && !earlier.contains(name)) earlier.emplace(name, about);
    }
    return earlier;
}

/// What is to be published; all flushed to the disk.
Publication Transaction::publication() {
    Publication publication{.state = Publication::State::publish};
    for (const Part& part : parts_) {
        const FilePlace place{folder_, part_name(part.name)};
        refuse_foreign_files(part.name, part.contents != nullptr);
        const Entry entry = folder_.entry(place.name);
        if (entry.kind == Kind::none) throw cannot(place.path, "published", ENOENT);
        if (part.contents)
            part.contents->sync(true);
        else if (const auto file = open_file(place); fsync(file.number()) != 0 && errno != EINVAL)
            throw cannot(place.path, "written");
        publication.steps.push_back({part.name, entry.inode});
    }
    publication.removed = removed_;
    return publication;
}

std::vector<fs::path> Transaction::publish() {
    std::vector<fs::path> files;
    for (const Part& part : parts_) files.push_back(folder_.path() / part.name);
    const auto published = publication();
    for (const auto& name : published.removed) journal_->note("remove " + name);
    for (const auto& step : published.steps) journal_->note(fmt::format("place {} {}", step.inode, step.name));
    folder_.sync();
    try {
        journal_->note("publish", true);
        put_in_place(folder_, published);
    } catch (...) {
        // where this fails too, the next run reverts
        auto parts = std::exchange(parts_, {});
        journal_->leave();
        journal_->note("withdraw", true);
        take_back(folder_, published);
        journal_->note("withdrawn", true);
        journal_->leave(false);
        parts_ = std::move(parts);
        throw;
    }
    parts_.clear();
    removed_.clear();
    try {
        clear_away(folder_, published);
    } catch (const Error&) {
        journal_->leave();  // something foreign is there: the next run reports it
    }
    return files;
}

}  // namespace doppel
