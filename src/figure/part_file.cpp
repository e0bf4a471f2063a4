#include "figure/part_file.hpp"

#include "numeric/error.hpp"
#include "output/sha256.hpp"
#include "scene/manifest_json.hpp"
#include "scene/version.hpp"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>

namespace doppel {
namespace {

constexpr std::string_view mark = "doppel trials";  // what such a file calls itself

Error unreadable(const std::filesystem::path& path, std::string_view why) {
    return io_failed("{}: {}; remove it, or give another folder with --out", path.string(), why);
}

/// "trial,a,b,c" → its numbers; false where the line is none.
bool read_line(std::string_view line, KnownTrials& trials) {
    const char *at = line.data(), *const end = at + line.size();
    std::size_t trial = 0;
    auto result = std::from_chars(at, end, trial);
    if (result.ec != std::errc() || trial >= trials.size()) return false;
    TrialNumbers numbers;
    while (result.ptr != end) {
        if (*result.ptr != ',') return false;
        double value = 0;
        result = std::from_chars(result.ptr + 1, end, value);
        if (result.ec != std::errc()) return false;
        numbers.push_back(value);
    }
    trials[trial] = std::move(numbers);
    return true;
}

/// Throws what the library does where the keys are not there.
PartHeader header_from(const Json& json) {
    if (json.at("file") != mark) throw Json::other_error::create(0, "another file", nullptr);
    return {json.at("figure"), json.at("version"), json.at("revision"), json.at("preset_sha256"),
            json.at("trials"), json.at("shard"),   json.at("of")};
}

bool possible(const PartHeader& header) {
    constexpr std::size_t most_trials = 100'000'000;
    return header.trials > 0 && header.trials <= most_trials && header.shard >= 1 && header.shard <= header.of;
}

}  // namespace

PartHeader header_of(const FigurePreset& figure, int shard, int of) {
    return {figure.name,
            std::string(version()),
            std::string(revision()),
            sha256_of_text(figure.resolved_work()),
            figure.work->trials(),
            shard,
            of};
}

PartFile read_part_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw unreadable(path, std::strerror(errno));
    PartFile part;
    std::string line;
    std::getline(file, line);
    try {
        part.header = header_from(Json::parse(line));
    } catch (const nlohmann::json::exception&) {
        throw unreadable(path, "is no file of trials");
    }
    if (!possible(part.header)) throw unreadable(path, "speaks of parts that cannot be");
    part.trials.resize(part.header.trials);
    // a last line without an end was being written
    while (std::getline(file, line) && !file.eof())
        if (!read_line(line, part.trials)) break;
    if (file.bad()) throw unreadable(path, "cannot be read");
    return part;
}

PartWriter::PartWriter(const FilePlace& place, const PartHeader& header, const KnownTrials& known) : file_(part_of(place)) {
    const Json json{{"file", mark},
                    {"figure", header.figure},
                    {"version", header.version},
                    {"revision", header.revision},
                    {"preset_sha256", header.preset},
                    {"trials", header.trials},
                    {"shard", header.shard},
                    {"of", header.of}};
    file_.write(json.dump() + "\n");
    for (std::size_t trial = 0; trial < known.size(); ++trial)
        if (!known[trial].empty()) add(trial, known[trial]);
    flush();
    rename_file(part_of(place), place);
}

void PartWriter::add(std::size_t trial, const TrialNumbers& numbers) {
    auto line = fmt::format("{}", trial);
    for (const double x : numbers) fmt::format_to(std::back_inserter(line), ",{}", x);
    file_.write(line + "\n");
}

}  // namespace doppel
