#include "figure/computation.hpp"

#include "base/text.hpp"
#include "base/threads.hpp"
#include "scene/captions.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

constexpr double record_after_s = 2, flush_every_s = 0.5;
constexpr std::size_t many_groups = 200, groups_ahead = 16;

double now() {
    return seconds_of(CLOCK_MONOTONIC);
}
/// CPU time of this thread, s.
double cpu_now() {
    return seconds_of(CLOCK_THREAD_CPUTIME_ID);
}

}  // namespace

Computation::Computation(const FigurePreset& figure, const PartHeader& header,
                         std::optional<std::filesystem::path> folder, int threads, FigureReport report,
                         std::size_t number)
    : figure_(figure),
      header_(header),
      folder_(std::move(folder)),
      threads_(threads),
      report_(std::move(report)),
      number_(number),
      known_(header.trials) {
    for (std::size_t trial = header_.first(); trial < header_.last(); ++trial)
        total_units_ += figure_.experiment->units(trial);
    if (folder_) {
        record_ = *folder_ / resume_name(header_);
        if (header_.of == 1 || !take(shard(), false)) take(record_, true);
    }
    find_groups();
}

/// Reads the trials of the file, if it exists and belongs to this figure.
bool Computation::take(const std::filesystem::path& path, bool must_be) {
    if (type_of(path) == std::filesystem::file_type::not_found) return false;
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

std::filesystem::path Computation::publish_shard() {
    if (groups_.empty() && type_of(record_) == std::filesystem::file_type::not_found && is_whole_) return shard();
    if (!writer_) writer_.emplace(record_, header_, known_);
    writer_->finish();
    rename_file(record_, shard());
    return shard();
}

/// Groups of unknown trials that are best computed together. If there are many, some evenly spaced ones come first, so
/// that the time of the rest can be estimated.
void Computation::find_groups() {
    const std::size_t maximum = figure_.experiment->together();
    for (std::size_t trial = header_.first(); trial < header_.last(); ++trial) {
        if (!known_[trial].empty()) continue;
        if (!groups_.empty() && groups_.back().second == trial && trial - groups_.back().first < maximum)
            ++groups_.back().second;
        else
            groups_.emplace_back(trial, trial + 1);
    }
    if (groups_.size() < many_groups) return;
    for (std::size_t i = 0; i < groups_ahead; ++i) {
        const auto from =
            groups_.begin() + static_cast<std::ptrdiff_t>((2 * i + 1) * groups_.size() / (2 * groups_ahead + 1));
        std::rotate(groups_.begin() + static_cast<std::ptrdiff_t>(i), from, from + 1);
    }
}

bool Computation::compute(std::size_t group, const std::atomic<bool>& stop) {
    try {
        throw_if_set(stop);
        {
            const std::lock_guard lock(mutex_);
            if (start_s_ == 0) start_s_ = flushed_s_ = now();
        }
        const auto [first, last] = groups_[group];
        const double cpu_start = cpu_now();
        std::vector<TrialNumbers> numbers(last - first);
        figure_.experiment->compute(first, numbers, stop);
        for (std::size_t i = 0; i < numbers.size(); ++i)
            if (!figure_.experiment->fits(first + i, numbers[i]))
                throw method_failed("{}: the result of trial {} is infinite or NaN", figure_.name, first + i);
        return keep(groups_[group], std::move(numbers), cpu_now() - cpu_start);
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

bool Computation::keep(const Group& group, std::vector<TrialNumbers> numbers, double cpu_s) {
    const std::lock_guard lock(mutex_);
    double units = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        known_[group.first + i] = std::move(numbers[i]);
        units += figure_.experiment->units(group.first + i);
    }
    cpu_s_ += cpu_s;
    ++groups_done_;
    const double time = now();
    const bool is_last = groups_done_ == groups_.size();
    const bool pays = time - start_s_ > record_after_s && !is_last;
    if (!writer_ && pays && folder_) {
        writer_.emplace(record_, header_, known_);
        has_record_ = true;
    } else if (writer_) {
        for (std::size_t trial = group.first; trial < group.second; ++trial) writer_->add(trial, known_[trial]);
        if (is_last || time - flushed_s_ > flush_every_s) {
            writer_->flush();
            flushed_s_ = time;
        }
    }
    computed_units_ += units;
    done_units_ += units;
    if (groups_done_ == groups_ahead && groups_.size() >= many_groups) report_estimate(time);
    report_.progress(number_, {done_units_, total_units_});
    return is_last;
}

void Computation::report_estimate(double time) {
    const double rate = computed_units_ / (time - start_s_), left = total_units_ - done_units_;
    report_.note(number_,
                 fmt::format("{} {} to go, about {} a second on {} threads: {}", grouped(std::lround(left)),
                             figure_.experiment->unit(), two_digits(rate), threads_, duration_text(left / rate)));
}

Needs estimated_computation(const FigurePreset& figure, int threads, const std::atomic<bool>& stop) {
    constexpr double allowed_s = 1, golden = 0.6180339887498949;
    const auto& experiment = *figure.experiment;
    const std::size_t trials = experiment.trials(), together = experiment.together();
    double total = 0;
    std::size_t counted = 0;
    const double before = cpu_now();
    for (std::size_t trial = 0; trial < trials; ++trial) {
        const double units = experiment.units(trial);
        // trials of 0 units are prerequisites: computed first and not timed
        TrialNumbers numbers;
        if (units == 0) experiment.compute(trial, {&numbers, 1}, stop);
        if (units > 0) ++counted;
        total += units;
    }
    const double needed_s = cpu_now() - before;
    // evenly spaced groups, until the time is over
    const TimeLimit limit(allowed_s, stop);
    const std::size_t all_groups = (trials + together - 1) / together;
    double done = 0, seconds = 0, place = 0.5, from = 0;
    std::size_t first = 0, trials_done = 0, numbers_done = 0;
    Needs estimate;
    try {
        for (std::size_t calls = 0; calls < all_groups && !limit.reached(); ++calls) {
            first = static_cast<std::size_t>(place * static_cast<double>(all_groups)) * together;
            place += golden - std::floor(place + golden);
            if (experiment.units(first) == 0) continue;
            std::vector<TrialNumbers> numbers(std::min(together, trials - first));
            from = cpu_now();
            experiment.compute(first, numbers, limit.reached());
            seconds += cpu_now() - from;
            for (std::size_t k = 0; k < numbers.size(); ++k) {
                done += experiment.units(first + k);
                numbers_done += numbers[k].size();
            }
            trials_done += numbers.size();
        }
    } catch (const Error& error) {
        if (error.code() != ExitCode::interrupted || stop) throw;
        // a group that takes longer than all others before counts as done
        const double cut_s = cpu_now() - from;
        estimate.at_least = cut_s > seconds;
        if (estimate.at_least) {
            seconds += cut_s;
            for (std::size_t k = first; k < std::min(first + together, trials); ++k) done += experiment.units(k);
        }
    }
    const auto groups = static_cast<double>((counted + together - 1) / together);
    estimate.cpu_s = needed_s + (done > 0 ? seconds * total / done : 0);
    estimate.seconds = estimate.cpu_s / std::min(static_cast<double>(threads), groups);
    // of a row of the table, of a number in it, and of a pixel drawn and as PNG; measured
    constexpr double row_bytes = 6, text_bytes = 18, drawn_bytes = 8, png_bytes = 0.15;
    const auto size = layout_of(figure.chart).picture;
    const auto map = experiment.map();
    const double pixels = 1.0 * size.width * size.height;
    const double rows =
        map ? 1.0 * map->columns * map->rows * static_cast<double>(map->panels) : static_cast<double>(trials);
    const auto counted_numbers =
        static_cast<double>(numbers_done) / static_cast<double>(std::max<std::size_t>(trials_done, 1));
    const double numbers = rows * (map ? static_cast<double>(map->numbers) : counted_numbers);
    estimate.memory_bytes =
        peak_memory() + sizeof(TrialNumbers) * rows + sizeof(double) * numbers + drawn_bytes * pixels;
    estimate.disk_bytes = row_bytes * rows + text_bytes * numbers + png_bytes * pixels;
    estimate.most_shards = static_cast<long>(std::min<std::size_t>(all_groups, max_parts));
    return estimate;
}

}  // namespace doppel
