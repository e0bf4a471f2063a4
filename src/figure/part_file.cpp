#include "figure/part_file.hpp"

#include "base/error.hpp"
#include "figure/line_reader.hpp"
#include "output/sha256.hpp"
#include "scene/manifest_json.hpp"
#include "scene/version.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

namespace doppel {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view mark = "doppel trials";  // what such a file calls itself
constexpr int format = 2;                           // of its lines; 1 had no checksums
constexpr std::size_t longest_header = 1 << 16, longest_line = std::size_t{1} << 32;
constexpr std::size_t checksum_digits = 16, name_digits = 12;

Json json_of(const PartHeader& header) {
    return {{"file", mark},
            {"format", format},
            {"figure", header.figure},
            {"version", header.version},
            {"revision", header.revision},
            {"preset_sha256", header.preset},
            {"trials", header.trials},
            {"shard", header.shard},
            {"of", header.of}};
}

/// Of a line, in the file with this header.
std::string checksum(const std::string& header, std::string_view line) {
    return sha256_of_text(fmt::format("{}\n{}", header, line)).substr(0, checksum_digits);
}

/// "TRIAL,a,b,c;CHECKSUM" → its numbers; false where the line is none.
bool read_line(std::string_view line, const std::string& header, PartFile::Trial& trial) {
    if (line.size() <= checksum_digits) return false;
    const auto text = line.substr(0, line.size() - checksum_digits - 1);
    if (line[text.size()] != ';' || line.substr(text.size() + 1) != checksum(header, text)) return false;
    const char *at = text.data(), *const end = at + text.size();
    auto result = std::from_chars(at, end, trial.number);
    if (result.ec != std::errc()) return false;
    while (result.ptr != end) {
        if (*result.ptr != ',') return false;
        double value = 0;
        result = std::from_chars(result.ptr + 1, end, value);
        if (result.ec != std::errc()) return false;
        trial.numbers.push_back(value);
    }
    return true;
}

/// A whole number from 1 to `most`. Throws what the library does where it is none.
std::size_t count(const Json& json, const char* key, std::size_t most) {
    const auto& value = json.at(key);
    if (!value.is_number_unsigned() || value.get<std::size_t>() < 1 || value.get<std::size_t>() > most)
        throw Json::other_error::create(0, "out of range", nullptr);
    return value.get<std::size_t>();
}

PartHeader header_from(const Json& json) {
    constexpr std::size_t most_trials = 100'000'000, most_parts = 100'000;
    const auto of = count(json, "of", most_parts);
    return {json.at("figure"),
            json.at("version"),
            json.at("revision"),
            json.at("preset_sha256"),
            count(json, "trials", most_trials),
            static_cast<int>(count(json, "shard", of)),
            static_cast<int>(of)};
}

PartHeader read_header(const std::string& line, const LineReader& file) {
    try {
        const auto json = Json::parse(line);
        if (json.at("file") != mark) throw Json::other_error::create(0, "another file", nullptr);
        if (json.value("format", Json(1)) != format) throw file.fault("was written by another version of Doppel");
        return header_from(json);
    } catch (const nlohmann::json::exception&) {
        throw file.fault("is no file of trials, or its first line is damaged");
    }
}

/// "fig8." or "fig8.3-of-8."
std::string stem(const PartHeader& header) {
    return header.of == 1 ? header.figure + "." : fmt::format("{}.{}-of-{}.", header.figure, header.shard, header.of);
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

std::string shard_name(const PartHeader& header) {
    return stem(header) + "shard";
}

std::string resume_name(const PartHeader& header) {
    return stem(header) + sha256_of_text(json_of(header).dump()).substr(0, name_digits) + ".resume";
}

std::vector<fs::path> other_resumes(const fs::path& folder, const PartHeader& header) {
    const auto start = stem(header), own = resume_name(header);
    const auto is_hexadecimal = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
    std::vector<fs::path> found;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
        const auto name = entry.path().filename().string();
        const auto digits = name.begin() + static_cast<std::ptrdiff_t>(start.size());
        if (name != own && name.size() == own.size() && name.starts_with(start) && name.ends_with(".resume") &&
            std::all_of(digits, digits + name_digits, is_hexadecimal))
            found.push_back(entry.path());
    }
    std::sort(found.begin(), found.end());
    return found;
}

void PartFile::take(const FigureWork& work, KnownTrials& into) {
    for (std::size_t i = 0; i < trials.size(); ++i) {
        auto& [number, numbers] = trials[i];
        if (number < header.first() || number >= header.last() || !work.fits(number, numbers)) {
            damaged_line = i + 2;
            break;
        }
        into[number] = std::move(numbers);
    }
    trials.clear();
}

PartFile read_part_file(const fs::path& path) {
    LineReader file(path, "remove it, or give another folder with --out");
    PartFile part;
    std::string header, line;
    if (!file.next(header, longest_header)) header = file.rest();
    part.header = read_header(header, file);
    for (std::size_t number = 2; file.next(line, longest_line); ++number) {
        PartFile::Trial trial{};
        if (!read_line(line, header, trial)) {
            part.damaged_line = number;
            break;
        }
        part.trials.push_back(std::move(trial));
    }
    return part;
}

PartWriter::PartWriter(const FilePlace& place, const PartHeader& header, const KnownTrials& known)
    : file_(part_of(place)), header_(json_of(header).dump()) {
    file_.write(header_ + "\n");
    for (std::size_t trial = 0; trial < known.size(); ++trial)
        if (!known[trial].empty()) add(trial, known[trial]);
    flush();
    rename_file(part_of(place), place);
}

void PartWriter::add(std::size_t trial, const TrialNumbers& numbers) {
    auto line = fmt::format("{}", trial);
    for (const double x : numbers) fmt::format_to(std::back_inserter(line), ",{}", x);
    file_.write(fmt::format("{};{}\n", line, checksum(header_, line)));
}

}  // namespace doppel
