#include "figure/computation.hpp"

#include "base/embedded.hpp"
#include "base/threads.hpp"
#include "output/written.hpp"
#include "scene/resolved.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
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

constexpr double record_after_s = 2, flush_every_s = 0.5;

/// CPU time of this thread, s.
double cpu_now() {
    return seconds_of(CLOCK_THREAD_CPUTIME_ID);
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

Computation::Computation(const FigurePreset& figure, const PartHeader& header, std::optional<fs::path> folder,
                         FigureReport report, std::size_t number)
    : figure_(figure),
      header_(header),
      folder_(std::move(folder)),
      report_(std::move(report)),
      number_(number),
      known_(header.trials) {
    for (auto trial = header_.first(); trial < header_.last(); ++trial)
        total_units_ += figure_.experiment->units(trial);
    if (folder_) {
        record_ = *folder_ / resume_name(header_);
        if (header_.of == 1 || !take(shard(), false)) take(record_, true);
    }
    find_unknown();
}

/// Reads the trials of the file, if it exists and belongs to this figure.
bool Computation::take(const fs::path& path, bool must_be) {
    if (type_of(path) == fs::file_type::not_found) return false;
    auto part = read_part_file(path);
    if (part.header != header_ && !must_be) return false;
    if (part.header != header_)
        throw io_failed("{} belongs to another preset or version; remove it, or give another folder with --out",
                        path.string());
    part.take(*figure_.experiment, known_);
    has_record_ = true;
    is_whole_ = !part.is_damaged;
    for (std::size_t trial = 0; trial < known_.size(); ++trial)
        if (!known_[trial].empty()) done_units_ += figure_.experiment->units(trial);
    report_.note(number_,
                 fmt::format("resuming from {}: {:.0f} % is done{}", path.string(), percent(done_units_),
                             part.is_damaged ? "; the rest is damaged or incomplete, and computed again" : ""));
    return true;
}

fs::path Computation::publish_shard() {
    if (unknown_.empty() && type_of(record_) == fs::file_type::not_found && is_whole_) return shard();
    if (!writer_) writer_.emplace(record_, header_, known_);
    writer_->finish();
    rename_file(record_, shard());
    return shard();
}

/// Trials that others require come first. Any first ones of the others are spread evenly, for estimates.
void Computation::find_unknown() {
    for (std::size_t trial = header_.first(); trial < header_.last(); ++trial)
        if (known_[trial].empty()) unknown_.push_back(trial);
    std::ranges::stable_sort(unknown_, {}, [&](std::size_t trial) {
        constexpr double golden = 0.6180339887498949;
        const double place = golden * static_cast<double>(trial);
        return figure_.experiment->units(trial) == 0 ? -1 : place - std::floor(place);
    });
}

bool Computation::compute(std::size_t trial, const std::atomic<bool>& stop) {
    try {
        throw_if_set(stop);
        {
            const std::lock_guard lock(mutex_);
            if (start_s_ == 0) start_s_ = flushed_s_ = seconds_of(CLOCK_MONOTONIC);
        }
        const double cpu_start = cpu_now();
        auto numbers = figure_.experiment->compute(trial, stop);
        if (!figure_.experiment->fits(trial, numbers))
            throw method_failed("{}: the result of trial {} is infinite or NaN", figure_.name, trial);
        return keep(trial, std::move(numbers), cpu_now() - cpu_start);
    } catch (const Error& error) {
        throw with_record(error);
    }
}

Error Computation::with_record(const Error& error) {
    const std::lock_guard lock(mutex_);
    if (!has_record_) return error;
    if (writer_) writer_->flush();
    return {error.code(),
            fmt::format("{}; {:.0f} % is done and kept in {}: the same command resumes", error.what(),
                        percent(writer_ ? done_units_ : done_units_ - computed_units_), record_.string())};
}

bool Computation::keep(std::size_t trial, TrialNumbers numbers, double cpu_s) {
    const std::lock_guard lock(mutex_);
    known_[trial] = std::move(numbers);
    const double units = figure_.experiment->units(trial), time = seconds_of(CLOCK_MONOTONIC);
    cpu_s_ += cpu_s;
    const bool is_last = ++computed_ == unknown_.size();
    if (!writer_ && folder_ && !is_last && time - start_s_ > record_after_s) {
        writer_.emplace(record_, header_, known_);
        has_record_ = true;
    } else if (writer_) {
        writer_->add(trial, known_[trial]);
        if (is_last || time - flushed_s_ > flush_every_s) {
            writer_->flush();
            flushed_s_ = time;
        }
    }
    computed_units_ += units;
    done_units_ += units;
    report_.progress(number_, {done_units_, total_units_});
    return is_last;
}

namespace {

/// The CPU time of the whole, s, from a part of it that is computed soon; nothing if it has none. `numbers` becomes the
/// count of its numbers.
std::optional<double> extrapolated_s(const Experiment& whole, double& numbers, const std::atomic<bool>& stop) {
    constexpr double enough_s = 0.3, longer = 4;
    double spent_s = 0, all_s = 0;
    for (double share = 0x1p-10; share < 1 && spent_s < enough_s; share *= longer) {
        const auto part = whole.part(share);
        if (!part) return {};
        const double start = cpu_now();
        for (std::size_t trial = 0; trial < part->experiment->trials(); ++trial) part->experiment->compute(trial, stop);
        spent_s = cpu_now() - start;
        all_s = spent_s / part->share;
        numbers = static_cast<double>(part->numbers);
    }
    return all_s;
}

}  // namespace

Needs estimated_computation(const FigurePreset& figure, int threads, const std::atomic<bool>& stop) {
    constexpr double allowed_s = 1;
    Computation computation(figure, header_of(figure), std::nullopt, {});
    const auto& trials = computation.unknown();
    const auto units = [&](std::size_t trial) { return figure.experiment->units(trial); };
    auto trial = trials.begin();
    for (; trial != trials.end() && units(*trial) == 0; ++trial) computation.compute(*trial, stop);
    const double needed_s = computation.cpu_s();
    const auto parallel = static_cast<double>(trials.end() - trial);
    double numbers = 0;
    const auto all_s = trial == trials.end() ? std::nullopt : extrapolated_s(*figure.experiment, numbers, stop);
    const TimeLimit limit(allowed_s, stop);
    Needs estimate;
    double from = 0, cut_s = 0;
    try {
        for (; !all_s && trial != trials.end() && !limit.reached(); ++trial) {
            from = cpu_now();
            computation.compute(*trial, limit.reached());
        }
    } catch (const Error& error) {
        if (error.code() != ExitCode::interrupted || stop) throw;
        cut_s = cpu_now() - from;
    }
    double seconds = computation.cpu_s() - needed_s, done = computation.computed_units();
    estimate.at_least = cut_s > seconds;  // a trial that takes longer than all others before counts as done
    if (estimate.at_least) seconds += cut_s, done += units(*trial);
    estimate.cpu_s = needed_s + (done > 0 ? seconds * computation.total_units() / done : 0);
    if (all_s) estimate.cpu_s = *all_s;
    estimate.seconds = estimate.cpu_s / std::min(static_cast<double>(threads), parallel);
    double trials_done = 0, numbers_done = 0, needed_numbers = 0;
    const auto known = computation.take_all();
    for (std::size_t k = 0; k < known.size(); ++k) {
        const auto count = static_cast<double>(known[k].size());
        if (units(k) == 0)
            needed_numbers += count;  // not in the table
        else if (count > 0)
            trials_done += 1, numbers_done += count;
    }
    const auto map = figure.experiment->map();
    const double cells = map ? 1.0 * map->columns * map->rows * static_cast<double>(map->panels) : 0;
    if (map) numbers = cells * static_cast<double>(map->numbers);
    if (numbers == 0)
        numbers = parallel * numbers_done / std::max(trials_done, 1.0) / figure.experiment->merged_trials();
    const double rows = map ? cells : static_cast<double>(figure.experiment->trials());
    const auto size = layout_of(figure.chart).picture;
    const bool has_pixels = figure.chart.format == PictureFormat::png;
    const double pixels = has_pixels ? 1.0 * size.width * size.height : 0;
    constexpr double drawn_bytes = 8;  // of a pixel
    estimate.memory_bytes = peak_memory() + sizeof(TrialNumbers) * rows +
                            sizeof(double) * (numbers * figure.experiment->merged_trials() + needed_numbers) +
                            drawn_bytes * pixels;
    // of the table: a cell in rows of several numbers, a number of others; measured on the presets
    constexpr double cell_bytes = 11.5, text_bytes = 22;
    const double in_row = figure.experiment->numbers_in_row(), points = numbers / in_row;
    const double row_bytes = cell_bytes * static_cast<double>(figure.experiment->columns().size());
    const double table_bytes = map ? row_bytes * cells : in_row > 1 ? row_bytes * points : text_bytes * numbers;
    // of the picture and the manifest, with the table within 0.5 to 1.9 times; a map has no points but its pixels
    const bool is_pdf = figure.chart.format == PictureFormat::pdf;
    const double drawn_points = map ? 0 : points;
    const double paths_bytes = is_pdf ? 17e3 + 10 * drawn_points : 130e3 + 20 * drawn_points;
    estimate.disk_bytes = table_bytes + (has_pixels ? 0.11 * pixels : paths_bytes);
    if (numbers == 0) estimate.disk_bytes = std::numeric_limits<double>::quiet_NaN();  // no trial was completed
    estimate.most_shards = static_cast<long>(std::min<std::size_t>(trials.size(), max_parts));
    return estimate;
}

}  // namespace doppel
