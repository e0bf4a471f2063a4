#include "output/publication.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <charconv>
#include <string_view>

namespace doppel {
namespace {

using Kind = Entry::Kind;

void put_in_place(const Folder& folder, const Publication::Step& step) {
    const auto part = part_name(step.name);
    if (!is_waiting(folder, step)) return;
    if (folder.entry(step.name).kind == Kind::none) return folder.rename(part, step.name);
    if (folder.exchange(part, step.name)) return;
    folder.rename(step.name, aside_name(step.name));
    folder.rename(part, step.name);
}

void take_back(const Folder& folder, const Publication::Step& step) {
    const auto part = part_name(step.name), aside = aside_name(step.name);
    const Entry placed = folder.entry(step.name);
    if (placed.kind != Kind::none && placed.inode == step.inode) {
        if (folder.entry(part).kind != Kind::none) {
            folder.exchange(part, step.name);
            return;
        }
        folder.rename(step.name, part);
    }
    if (folder.entry(aside).kind != Kind::none && folder.entry(step.name).kind == Kind::none)
        folder.rename(aside, step.name);
}

/// The names in a lock file are only believed where they are plain: no path out of the folder.
bool is_plain(std::string_view name) {
    return !name.empty() && name != "." && name != ".." && name.find('/') == std::string_view::npos;
}

}  // namespace

std::string part_name(const std::string& name) {
    return name + ".part";
}

std::string aside_name(const std::string& name) {
    return name + ".old.part";
}

bool is_waiting(const Folder& folder, const Publication::Step& step) {
    const Entry part = folder.entry(part_name(step.name));
    return part.kind != Kind::none && part.inode == step.inode;
}

void put_in_place(const Folder& folder, const Publication& publication) {
    for (const auto& step : publication.steps) put_in_place(folder, step);
    folder.sync();
}

void take_back(const Folder& folder, const Publication& publication) {
    for (const auto& step : publication.steps) take_back(folder, step);
    folder.sync();
}

void clear_away(const Folder& folder, const Publication& publication) {
    for (const auto& step : publication.steps) {
        remove_entry(folder, part_name(step.name));
        remove_entry(folder, aside_name(step.name));
    }
    if (publication.state == Publication::State::publish)
        for (const auto& name : publication.removed) remove_entry(folder, name);
}

void remove_entry(const Folder& folder, const std::string& name) {
    switch (folder.entry(name).kind) {
        case Kind::none:
            return;
        case Kind::file:
            return folder.remove_file(name);
        case Kind::folder:
            return folder.remove_folder(name);
        default:
            throw io_failed("{} is no file of Doppel's; remove it", (folder.path() / name).string());
    }
}

std::vector<std::string> journal_of(const Publication& publication) {
    std::vector<std::string> lines;
    for (const auto& name : publication.removed) lines.push_back("remove " + name);
    for (const auto& step : publication.steps) lines.push_back(fmt::format("place {} {}", step.inode, step.name));
    return lines;
}

Notes read_notes(const std::vector<std::string>& lines) {
    Notes notes;
    auto& [parts, publication] = notes;
    for (const std::string_view line : lines) {
        const auto space = line.find(' ');
        const auto word = line.substr(0, space), rest = space == line.npos ? "" : line.substr(space + 1);
        if (word == "publish") publication.state = Publication::State::publish;
        if (word == "withdraw") publication.state = Publication::State::withdraw;
        if (word == "withdrawn") publication = {};
        if (word == "part" && is_plain(rest)) parts.emplace_back(rest);
        if (word == "remove" && is_plain(rest)) publication.removed.emplace_back(rest);
        if (word == "place") {
            ino_t inode = 0;
            const auto [end, fault] = std::from_chars(rest.data(), rest.data() + rest.size(), inode);
            const auto name = rest.substr(std::min<std::size_t>(rest.size(), std::size_t(end - rest.data()) + 1));
            if (fault == std::errc() && is_plain(name)) publication.steps.push_back({std::string(name), inode});
        }
    }
    return notes;
}

}  // namespace doppel
