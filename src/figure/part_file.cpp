#include "figure/part_file.hpp"

#include "base/embedded.hpp"
#include "base/error.hpp"
#include "output/written.hpp"
#include "scene/resolved.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <memory>
#include <string_view>

namespace doppel {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view mark = "doppel trials";  // the kind of file
constexpr int format = 2;                           // of the lines; format 1 had no checksums
constexpr std::size_t longest_header = 1 << 16, longest_line = std::size_t{1} << 32;
constexpr std::size_t max_trials = 100'000'000;
constexpr std::size_t checksum_digits = 16, name_digits = 12;

/// Reads a regular file line by line; follows no link.
class LineReader {
public:
    explicit LineReader(const fs::path& path) : path_(path) {
        const auto type = type_of(path);
        if (type == fs::file_type::symlink) throw error("is a symbolic link");
        if (type != fs::file_type::regular && type != fs::file_type::not_found) throw error("is no regular file");
        file_ = open_file(path);
    }

    /// Reads the next line, without its end. Returns false after the last line, and for an incomplete line (its writer
    /// was killed) or one longer than `maximum` bytes; `line` then contains its beginning. Throws Error (exit 4).
    bool next(std::string& line, std::size_t maximum) {
        line.clear();
        for (int c = 0; (c = getc_unlocked(file_.get())) != EOF && line.size() <= maximum;) {
            if (c == '\n') return true;
            line += static_cast<char>(c);
        }
        if (std::ferror(file_.get())) throw cannot(path_, "read");
        return false;
    }

    /// "PATH: WHY; what to do about it" (exit 4).
    Error error(std::string_view why) const {
        return io_failed("{}: {}; remove it, or give another folder with --out", path_.string(), why);
    }

private:
    fs::path path_;
    Stream file_;
};

/// What all parts of a figure agree on.
Json identity(const PartHeader& header) {
    return {{"figure", header.figure},
            {"version", header.version},
            {"revision", header.revision},
            {"preset_sha256", header.preset},
            {"trials", header.trials}};
}

Json json_of(const PartHeader& header) {
    Json json{{"file", mark}, {"format", format}};
    json.update(identity(header));
    json.update({{"shard", header.shard}, {"of", header.of}});
    return json;
}

/// The checksum of a line in the file with this header.
std::string checksum(const std::string& header, std::string_view line) {
    return sha256_of_text(fmt::format("{}\n{}", header, line)).substr(0, checksum_digits);
}

/// Parses "TRIAL,a,b,c;CHECKSUM"; returns false if the line is invalid.
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

/// A whole number from 1 to `maximum`; otherwise throws as the JSON library does.
std::size_t count(const Json& json, const char* key, std::size_t maximum) {
    const auto& value = json.at(key);
    if (!value.is_number_unsigned() || value.get<std::size_t>() < 1 || value.get<std::size_t>() > maximum)
        throw Json::other_error::create(0, "out of range", nullptr);
    return value.get<std::size_t>();
}

PartHeader header_from(const Json& json) {
    const auto of = count(json, "of", max_parts);
    return {json.at("figure"),
            json.at("version"),
            json.at("revision"),
            json.at("preset_sha256"),
            count(json, "trials", max_trials),
            static_cast<int>(count(json, "shard", of)),
            static_cast<int>(of)};
}

PartHeader read_header(const std::string& line, const LineReader& file) {
    try {
        const auto json = Json::parse(line);
        if (json.at("file") != mark) throw Json::other_error::create(0, "another file", nullptr);
        if (json.value("format", Json(1)) != format) throw file.error("was written by another version of Doppel");
        return header_from(json);
    } catch (const nlohmann::json::exception&) {
        throw file.error("is no file of trials, or its first line is damaged");
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
    for (std::size_t i = 0; i < trials.size(); ++i) {
        auto& [number, numbers] = trials[i];
        if (number < header.first() || number >= header.last() || !experiment.fits(number, numbers)) {
            damaged_line = i + 2;
            break;
        }
        into[number] = std::move(numbers);
    }
    trials.clear();
}

PartFile read_part_file(const fs::path& path) {
    LineReader file(path);
    PartFile part;
    std::string header, line;
    file.next(header, longest_header);
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

PartWriter::PartWriter(const fs::path& path, const PartHeader& header, const KnownTrials& known)
    : file_(new_part_path(path)), header_(json_of(header).dump()) {
    file_.write(header_ + "\n");
    for (std::size_t trial = 0; trial < known.size(); ++trial)
        if (!known[trial].empty()) add(trial, known[trial]);
    flush();
    rename_file(file_.path(), path);
}

void PartWriter::add(std::size_t trial, const TrialNumbers& numbers) {
    auto line = fmt::format("{}", trial);
    for (const double x : numbers) fmt::format_to(std::back_inserter(line), ",{}", x);
    file_.write(fmt::format("{};{}\n", line, checksum(header_, line)));
}

KnownTrials merged_parts(const FigurePreset& figure, const fs::path& folder, const std::atomic<bool>& stop) {
    const auto wanted = header_of(figure);
    KnownTrials all(wanted.trials);
    all_parts(folder, figure.name, ExitCode::bad_input, [&](const fs::path& path) {
        throw_if_set(stop);
        auto part = read_part_file(path);
        const auto& header = part.header;
        const Shard shard{header.shard, header.of};
        check_identity(path, identity(header), identity(wanted), shard, "compute");
        part.take(*figure.experiment, all);
        const auto refuse = [&](const std::string& why) {
            throw io_failed("{} {}; compute it again with --shard {}/{}", path.string(), why, shard.number, shard.of);
        };
        if (part.damaged_line > 0) refuse(fmt::format("is damaged in line {}", part.damaged_line));
        for (std::size_t trial = header.first(); trial < header.last(); ++trial)
            if (all[trial].empty()) refuse(fmt::format("is not whole: trial {} is missing", trial));
        return shard;
    });
    return all;
}

}  // namespace doppel
