#include "figure/part_file.hpp"

#include "base/embedded.hpp"
#include "base/error.hpp"
#include "output/written.hpp"
#include "scene/resolved.hpp"

#include <utility>

namespace doppel {
namespace {

namespace fs = std::filesystem;

constexpr BlockKind trials_file{R"({"file":"doppel trials","format":3,)",
                                "is no file of trials of this version, or its first line is damaged; remove it, or "
                                "give another folder with --out",
                                "is damaged or incomplete"};
constexpr std::size_t max_trials = 100'000'000, name_digits = 12;

/// What all parts of a figure agree on.
Json identity(const PartHeader& header) {
    return {{"figure", header.figure},
            {"version", header.version},
            {"revision", header.revision},
            {"preset_sha256", header.preset},
            {"trials", header.trials}};
}

Json json_of(const PartHeader& header) {
    Json json{{"file", "doppel trials"}, {"format", 3}};
    json.update(identity(header));
    json.update({{"shard", header.shard}, {"of", header.of}});
    return json;
}

/// Throws Error (exit 4) if it is invalid.
PartHeader read_header(const BlockFile& file) {
    try {
        const auto json = Json::parse(file.header());
        const auto shard = shard_of(json);
        const auto& trials = json.at("trials");
        if (!shard || !trials.is_number_unsigned() || trials < 1 || trials > max_trials) throw file.other();
        return {json.at("figure"), json.at("version"), json.at("revision"), json.at("preset_sha256"), trials,
                shard->number,     shard->of};
    } catch (const nlohmann::json::exception&) {
        throw file.other();
    }
}

/// "fig8." or "fig8.3-of-8."
std::string stem(const PartHeader& header) {
    return header.of == 1 ? header.figure + "." : fmt::format("{}.{}-of-{}.", header.figure, header.shard, header.of);
}

/// The path "PATH.part". A file there is removed: it belongs to a run that was killed.
fs::path new_part_path(fs::path path) {
    path += ".part";
    fs::remove(path);
    return path;
}

}  // namespace

PartHeader header_of(const FigurePreset& figure, const Shard& shard) {
    return {figure.name,
            std::string(version()),
            std::string(revision()),
            sha256_of_text(figure.resolved_work()),
            figure.experiment->trials(),
            shard.number,
            shard.of};
}

std::string shard_name(const PartHeader& header) {
    return stem(header) + "shard";
}

std::string resume_name(const PartHeader& header) {
    return stem(header) + sha256_of_text(json_of(header).dump()).substr(0, name_digits) + ".resume";
}

std::vector<fs::path> other_resumes(const fs::path& folder, const PartHeader& header) {
    const auto own = resume_name(header);
    std::vector<fs::path> found;
    for (const auto& name : names_in(folder))
        if (name != own && name.size() == own.size() && name.starts_with(stem(header)) && name.ends_with(".resume"))
            found.push_back(folder / name);
    return found;
}

void PartFile::take(const Experiment& experiment, KnownTrials& into) {
    for (auto& [number, numbers] : trials) {
        if (number < header.first() || number >= header.last() || !experiment.fits(number, numbers)) {
            is_damaged = true;
            break;
        }
        into[number] = std::move(numbers);
    }
    trials.clear();
}

PartFile read_part_file(const fs::path& path) {
    if (type_of(path) == fs::file_type::symlink)
        throw io_failed("{} is a symbolic link; remove it, or give another folder with --out", path.string());
    BlockFile file(path, trials_file);
    PartFile part{.header = read_header(file)};
    try {
        for (PartFile::Trial trial{}; !file.is_read() && file.next(); part.trials.push_back(trial))
            file(trial.number, trial.numbers);
    } catch (const DamagedFile&) {
        part.is_damaged = true;
    }
    return part;
}

PartWriter::PartWriter(const fs::path& path, const PartHeader& header, const KnownTrials& known)
    : file_(new_part_path(path), json_of(header).dump()) {
    for (std::size_t trial = 0; trial < known.size(); ++trial)
        if (!known[trial].empty()) add(trial, known[trial]);
    flush();
    rename_file(path.string() + ".part", path);
}

void PartWriter::add(std::size_t trial, TrialNumbers numbers) {
    file_(trial, numbers);
    file_.end_block();
}

KnownTrials merged_parts(const FigurePreset& figure, const fs::path& folder, const std::atomic<bool>& stop) {
    const auto wanted = header_of(figure);
    KnownTrials all(wanted.trials);
    all_parts(folder, figure.name, [&](const fs::path& path) {
        throw_if_set(stop);
        auto part = read_part_file(path);
        const auto& header = part.header;
        const Shard shard{header.shard, header.of};
        check_identity(path, identity(header), identity(wanted), shard, "compute");
        part.take(*figure.experiment, all);
        for (std::size_t trial = header.first(); trial < header.last(); ++trial)
            part.is_damaged = part.is_damaged || all[trial].empty();
        if (part.is_damaged)
            throw io_failed("{} is damaged or incomplete; compute it again with --shard {}/{}", path.string(),
                            shard.number, shard.of);
        return shard;
    });
    return all;
}

}  // namespace doppel
