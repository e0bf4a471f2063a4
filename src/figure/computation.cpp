#include "figure/computation.hpp"

#include "base/clock.hpp"
#include "base/threads.hpp"
#include "figure/map_figure.hpp"
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

std::string duration_words(double seconds) {
    return seconds < 100 ? fmt::format("{:.2g} s", seconds) : fmt::format("{:.0f} min", std::ceil(seconds / 60));
}

}  // namespace

Computation::Computation(const FigurePreset& figure, const PartHeader& header,
                         std::optional<std::filesystem::path> record, int threads, ComputationReport report)
    : figure_(figure),
      header_(header),
      record_(std::move(record)),
      threads_(threads),
      report_(std::move(report)),
      known_(header.trials) {
    for (std::size_t trial = header_.first(); trial < header_.last(); ++trial)
        total_units_ += figure_.experiment->units(trial);
    take_record();
    find_groups();
}

void Computation::take_record() {
    std::error_code ignored;
    if (!record_ || !std::filesystem::exists(std::filesystem::symlink_status(*record_, ignored))) return;
    auto part = read_part_file(*record_);
    if (part.header != header_)
        throw io_failed("{} belongs to another preset or version; remove it, or give another folder with --out",
                        record_->string());
    part.take(*figure_.experiment, known_);
    has_record_ = true;
    for (std::size_t trial = 0; trial < known_.size(); ++trial)
        if (!known_[trial].empty()) done_units_ += figure_.experiment->units(trial);
    kept_units_ = done_units_;
    report_.note(fmt::format(
        "goes on from {}: {:.0f} % is done{}", record_->string(), percent(done_units_),
        part.damaged_line == 0
            ? ""
            : fmt::format("; line {} is damaged, and what follows it is computed anew", part.damaged_line)));
}

/// Runs of unknown trials, cut to what is best computed together. Of many groups, some evenly spaced ones come first, to
/// estimate the time of the rest.
void Computation::find_groups() {
    const std::size_t most = figure_.experiment->together();
    for (std::size_t trial = header_.first(); trial < header_.last(); ++trial) {
        if (!known_[trial].empty()) continue;
        if (!groups_.empty() && groups_.back().second == trial && trial - groups_.back().first < most)
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
            const std::lock_guard hold(mutex_);
            if (start_s_ == 0) start_s_ = flushed_s_ = now();
        }
        const auto [first, last] = groups_[group];
        const double cpu_start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
        std::vector<TrialNumbers> numbers(last - first);
        figure_.experiment->compute(first, numbers, stop);
        for (std::size_t i = 0; i < numbers.size(); ++i)
            if (!figure_.experiment->fits(first + i, numbers[i]))
                throw method_failed("{}: trial {} came to a number that is infinite or NaN", figure_.name, first + i);
        return keep(groups_[group], std::move(numbers), seconds_of(CLOCK_THREAD_CPUTIME_ID) - cpu_start);
    } catch (const Error& fault) {
        throw with_record(fault);
    }
}

Error Computation::with_record(const Error& fault) {
    const std::lock_guard hold(mutex_);
    if (!has_record_) return fault;
    if (writer_) writer_->flush();
    return {fault.code(), fmt::format("{}; {:.0f} % is done and kept in {}: the same command goes on from there",
                                      fault.what(), percent(kept_units_), record_->string())};
}

bool Computation::keep(const Group& group, std::vector<TrialNumbers> numbers, double cpu_s) {
    const std::lock_guard hold(mutex_);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        known_[group.first + i] = std::move(numbers[i]);
        const double units = figure_.experiment->units(group.first + i);
        computed_units_ += units;
        done_units_ += units;
    }
    cpu_s_ += cpu_s;
    ++groups_done_;
    const double time = now();
    const bool is_last = groups_done_ == groups_.size();
    const bool pays = time - start_s_ > record_after_s && !is_last;
    if (!writer_ && pays && record_) {
        writer_.emplace(*record_, header_, known_);
        has_record_ = true;
    } else if (writer_) {
        for (std::size_t trial = group.first; trial < group.second; ++trial) writer_->add(trial, known_[trial]);
        if (is_last || time - flushed_s_ > flush_every_s) {
            writer_->flush();
            flushed_s_ = time;
        }
    }
    if (writer_) kept_units_ = done_units_;
    if (groups_done_ == groups_ahead && groups_.size() >= many_groups) tell_estimate(time);
    report_.progress({done_units_, total_units_});
    return is_last;
}

void Computation::tell_estimate(double time) {
    const double rate = computed_units_ / (time - start_s_), left = total_units_ - done_units_;
    report_.note(fmt::format("{} {} to go, about {} a second on {} threads: {}", grouped(std::lround(left)),
                             figure_.experiment->unit(), roughly(rate), threads_, duration_words(left / rate)));
}

namespace {

/// Some of a figure's trials, or of a map's cells, and what they took.
struct Sampled {
    double done = 0, seconds = 0;
};

/// Calls sample(place, seen) with places 0…1 that are spread evenly, however many there are, until the time is over or it
/// returns false; it adds to `seen` what it has done.
template <class Sample>
Sampled sampled(const TimeLimit& limit, const std::atomic<bool>& stop, const Sample& sample) {
    constexpr double golden = 0.6180339887498949;
    Sampled seen;
    const double start = now();
    try {
        for (double place = 0.5; !limit.reached() && sample(place, seen);
             place += golden - std::floor(place + golden)) {
        }
    } catch (const Error& fault) {
        if (fault.code() != ExitCode::interrupted || stop) throw;
    }
    if (seen.done == 0) seen.seconds = now() - start;
    return seen;
}

/// Cells of a map: a row of slow ones would take too long, and neighbours may be computed together. Pieces of rows,
/// longer ones as long as they take little; the longest count.
Sampled sampled_cells(const MapFigure& map, std::size_t rows, const TimeLimit& limit, const std::atomic<bool>& stop) {
    constexpr double brief_s = 0.05;
    constexpr std::size_t longest = 512;
    const auto columns = static_cast<std::size_t>(map.frame().x.count);
    std::size_t length = 1;
    bool is_longer = true;
    return sampled(limit, stop, [&](double place, Sampled& seen) {
        const double row = place * static_cast<double>(rows), in_row = row - std::floor(row);
        std::vector<TrialNumbers> cells(length);
        const double start = now();
        map.find(static_cast<int>(row), static_cast<int>(in_row * static_cast<double>(columns - length)), cells,
                 limit.reached());
        const double seconds = now() - start;
        if (is_longer) seen = {};
        seen = {seen.done + static_cast<double>(length), seen.seconds + seconds};
        is_longer = seconds < brief_s && length < std::min(longest, columns);
        if (is_longer) length = std::min({4 * length, longest, columns});
        return true;
    });
}

Sampled sampled_trials(const Experiment& experiment, const TimeLimit& limit, const std::atomic<bool>& stop) {
    const std::size_t trials = experiment.trials(), together = experiment.together();
    const std::size_t groups = (trials + together - 1) / together;
    std::size_t calls = 0;
    return sampled(limit, stop, [&](double place, Sampled& seen) {
        if (calls++ == groups) return false;
        const auto first = static_cast<std::size_t>(place * static_cast<double>(groups)) * together;
        if (experiment.units(first) == 0) return true;
        std::vector<TrialNumbers> numbers(std::min(together, trials - first));
        const double start = now();
        experiment.compute(first, numbers, limit.reached());
        seen.seconds += now() - start;
        for (std::size_t k = 0; k < numbers.size(); ++k) seen.done += experiment.units(first + k);
        return true;
    });
}

}  // namespace

ComputationEstimate estimated_computation(const FigurePreset& figure, int threads, const std::atomic<bool>& stop) {
    constexpr double allowed_s = 1;
    const auto& experiment = *figure.experiment;
    const auto* map = experiment.map();
    double total = 0;
    std::size_t counted = 0;
    const double before = now();
    for (std::size_t trial = 0; trial < experiment.trials(); ++trial) {
        const double units = experiment.units(trial);
        // trials of 0 units are what others need: computed first, outside the estimate
        TrialNumbers numbers;
        if (units == 0) experiment.compute(trial, {&numbers, 1}, stop);
        if (units > 0) ++counted;
        total += map && units > 0 ? map->frame().x.count : units;
    }
    const double needed_s = now() - before;
    const TimeLimit limit(allowed_s, stop);
    const auto seen = map ? sampled_cells(*map, counted, limit, stop) : sampled_trials(experiment, limit, stop);
    const std::size_t groups = (counted + experiment.together() - 1) / experiment.together();
    const double of_all = seen.done > 0 ? total / seen.done : map ? total : static_cast<double>(groups);
    const double shared = std::min(static_cast<double>(threads), static_cast<double>(groups));
    return {(needed_s + seen.seconds * of_all) / shared, seen.done == 0};
}

}  // namespace doppel
