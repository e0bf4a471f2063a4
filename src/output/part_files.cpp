#include "output/part_files.hpp"

#include "numeric/error.hpp"

#include <fcntl.h>

#include <cstdio>
#include <system_error>

namespace doppel {
namespace {

namespace fs = std::filesystem;

fs::path with_suffix(fs::path path, const char* suffix) {
    return path += suffix;
}

void remove_quietly(const fs::path& path) {
    std::error_code ignored;
    fs::remove_all(path, ignored);
}

/// Only those that are empty.
void remove_folders(const std::vector<fs::path>& folders) {
    std::error_code ignored;
    for (auto folder = folders.rbegin(); folder != folders.rend(); ++folder) fs::remove(*folder, ignored);
}

/// Makes what is missing of the way to `folder`, and returns what it made, outermost first: other runs may make the
/// same folders meanwhile.
std::vector<fs::path> make_folders(const fs::path& folder) {
    std::vector<fs::path> made;
    fs::path way;
    for (const fs::path& step : folder) {
        way /= step;
        std::error_code error, ignored;
        while (!fs::is_directory(way, ignored)) {
            if (fs::create_directory(way, error)) made.push_back(way);
            if (!error) continue;
            remove_folders(made);
            if (fs::exists(fs::symlink_status(way, ignored)))
                throw io_failed("{} is no folder; Doppel would write into a folder there", way.string());
            throw io_failed("{}: the folder cannot be made: {}", way.string(), error.message());
        }
    }
    return made;
}

void move_to(const fs::path& from, const fs::path& to) {
    std::error_code error;
    fs::rename(from, to, error);
    if (error) throw io_failed("{}: cannot be renamed to {}: {}", from.string(), to.string(), error.message());
}

/// Puts the folder `from` in the place of the folder `to`, whose files never mix with the new ones; what stays of those
/// has the name `from` or `aside`.
void replace_folder(const fs::path& from, const fs::path& to, const fs::path& aside) {
    // at once, where the file system can: whoever is killed then leaves the one or the other
    if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) == 0) return remove_quietly(from);
    remove_quietly(aside);
    move_to(to, aside);
    try {
        move_to(from, to);
    } catch (...) {
        std::error_code ignored;
        fs::rename(aside, to, ignored);
        throw;
    }
    remove_quietly(aside);
}

/// Where an older folder stands while a new one takes its place.
fs::path aside_of(const fs::path& target) {
    return with_suffix(target, ".old.part");
}

}  // namespace

PartFiles::PartFiles(fs::path folder, const std::string& run)
    : folder_(std::move(folder)), made_(make_folders(folder_)) {
    try {
        lock_.emplace(folder_, run);
    } catch (...) {
        remove_folders(made_);
        throw;
    }
}

PartFiles::~PartFiles() {
    for (const Part& part : parts_) remove_quietly(part.written);
    lock_.reset();
    remove_folders(made_);
}

fs::path PartFiles::file(const std::string& name) {
    if (fs::is_directory(folder_ / name))
        throw io_failed("{} is a folder; Doppel would write a file there", (folder_ / name).string());
    return add_part(name);
}

fs::path PartFiles::directory(const std::string& name) {
    const fs::path target = folder_ / name;
    if (fs::exists(target) && !fs::is_directory(target))
        throw io_failed("{} is a file; Doppel would make a folder there", target.string());
    fs::path part = add_part(name);
    lock_->note(aside_of(target).filename().string());
    std::error_code error;
    if (!fs::create_directory(part, error))
        throw io_failed("{}: the folder cannot be made: {}", part.string(), error.message());
    return part;
}

fs::path PartFiles::add_part(const std::string& name) {
    const fs::path target = folder_ / name;
    fs::path part = with_suffix(target, ".part");
    std::error_code error;
    fs::remove_all(part, error);
    if (error) throw io_failed("{}: a stale part cannot be removed: {}", part.string(), error.message());
    lock_->note(part.filename().string());
    parts_.push_back({target, part});
    return part;
}

void PartFiles::keep_only(const std::string& name, const std::string& new_name) {
    std::erase_if(parts_, [&](const Part& part) {
        if (part.target == folder_ / name) return false;
        remove_quietly(part.written);
        return true;
    });
    for (Part& part : parts_) part.target = folder_ / new_name;
}

void PartFiles::publish() {
    for (Part& part : parts_) {
        if (fs::is_directory(part.written) && fs::is_directory(part.target))
            replace_folder(part.written, part.target, aside_of(part.target));
        else
            move_to(part.written, part.target);
        part.written = part.target;
    }
    parts_.clear();
}

}  // namespace doppel
