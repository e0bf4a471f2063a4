#include "figure/merge.hpp"

#include "base/error.hpp"

#include <algorithm>

namespace doppel {
namespace {

namespace fs = std::filesystem;

/// The files NAME.I-of-N.shard of a folder, or what else begins and ends like them.
std::vector<fs::path> shards_in(const fs::path& folder, const std::string& name) {
    std::vector<fs::path> found;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
        const auto file = entry.path().filename().string();
        if (file.starts_with(name + ".") && file.ends_with(".shard")) found.push_back(entry.path());
    }
    std::sort(found.begin(), found.end());
    return found;
}

void refuse_strangers(const fs::path& path, const PartHeader& found, const PartHeader& wanted) {
    const auto refuse = [&](std::string_view what, const std::string& is, const std::string& ours) {
        throw bad_input("{} was made with another {}: {}, not {}; compute it again with --shard {}/{}", path.string(),
                        what, is, ours, found.shard, found.of);
    };
    const auto short_hash = [](const std::string& hash) { return hash.substr(0, 12); };
    if (found.figure != wanted.figure) refuse("figure", found.figure, wanted.figure);
    if (found.version != wanted.version) refuse("version", found.version, wanted.version);
    if (found.revision != wanted.revision) refuse("revision", found.revision, wanted.revision);
    if (found.preset != wanted.preset || found.trials != wanted.trials)
        refuse("preset, or other --set", short_hash(found.preset), short_hash(wanted.preset));
}

/// Those of the parts that are not there, as many as one can read.
void refuse_gaps(const std::vector<fs::path>& parts, const fs::path& folder) {
    constexpr std::size_t most_named = 5;
    const auto missing = static_cast<std::size_t>(std::count(parts.begin(), parts.end(), fs::path()));
    if (missing == 0) return;
    std::vector<std::string> named;
    for (std::size_t i = 0; named.size() < std::min(missing, most_named); ++i)
        if (parts[i].empty()) named.push_back(fmt::format("{}/{}", i + 1, parts.size()));
    throw bad_input("{}: missing parts: {}{}", folder.string(), fmt::join(named, ", "),
                    missing > most_named ? fmt::format(" … {} in all", missing) : "");
}

}  // namespace

KnownTrials merged_parts(const FigurePreset& figure, const fs::path& folder, const std::atomic<bool>& stop) {
    const auto files = shards_in(folder, figure.name);
    if (files.empty())
        throw bad_input("{} holds no part of {}; make them with the same command, --shard I/N in place of --merge",
                        folder.string(), figure.name);
    const auto wanted = header_of(figure);
    KnownTrials all(wanted.trials);
    std::vector<fs::path> parts;  // by their numbers; empty where not seen yet
    for (const auto& path : files) {
        if (stop) throw Error(ExitCode::interrupted, "interrupted");
        auto part = read_part_file(path);
        const auto& header = part.header;
        refuse_strangers(path, header, wanted);
        const auto of = static_cast<std::size_t>(header.of);
        if (parts.empty()) parts.resize(of);
        if (of != parts.size())
            throw bad_input("{} is one of {} parts and {} one of {}; remove those that do not belong", path.string(),
                            of, files.front().string(), parts.size());
        auto& seen = parts[static_cast<std::size_t>(header.shard) - 1];
        if (!seen.empty())
            throw bad_input("{} and {} are both part {}/{}; remove one of them", seen.string(), path.string(),
                            header.shard, of);
        seen = path;
        part.take(*figure.work, all);
        const auto refuse = [&](const std::string& why) {
            throw io_failed("{} {}; compute it again with --shard {}/{}", path.string(), why, header.shard, of);
        };
        if (part.damaged_line > 0) refuse(fmt::format("is damaged in line {}", part.damaged_line));
        for (std::size_t trial = header.first(); trial < header.last(); ++trial)
            if (all[trial].empty()) refuse(fmt::format("is not whole: trial {} is missing", trial));
    }
    refuse_gaps(parts, folder);
    return all;
}

}  // namespace doppel
