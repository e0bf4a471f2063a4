#include "figure/run.hpp"

#include "base/error.hpp"
#include "base/machine.hpp"
#include "base/text.hpp"
#include "base/threads.hpp"
#include "figure/page.hpp"
#include "integrate/widths.hpp"
#include "output/png.hpp"
#include "output/transaction.hpp"
#include "scene/captions.hpp"
#include "scene/resolved.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <mutex>

namespace doppel {
namespace {

namespace fs = std::filesystem;

Figure page_of(const FigurePreset& figure, const KnownTrials& trials) {
    if (const auto why = figure.experiment->nothing_to_draw(trials)) throw method_failed("{}: {}", figure.name, *why);
    Figure page{.title = figure.title, .subtitle = figure.subtitle};
    figure.experiment->draw(trials, page);
    page.captions.insert(page.captions.begin(), figure.captions.begin(), figure.captions.end());
    if (!figure.erratum.empty()) page.captions.push_back("Erratum: " + figure.erratum);
    const auto &title = figure.chart.title, &captions = figure.chart.captions;
    if (!title.shown || title.own) page.title = page.subtitle = "";
    if (title.own && !title.own->empty()) {
        page.title = title.own->front();
        page.subtitle = fmt::format("{}", fmt::join(title.own->begin() + 1, title.own->end(), " "));
    }
    if (!captions.shown) page.captions.clear();
    if (captions.own) page.captions = *captions.own;
    return page;
}

/// Throws Error if the map cells of the trials in `header` exceed the memory or what a page holds (exit 2), or the disk
/// space of `folder` (exit 75). Other figures need no check.
void require_room(const FigurePreset& figure, const PartHeader& header, bool tiles, const fs::path& folder) {
    const auto map = figure.experiment->map();
    if (!map) return;
    const double share = static_cast<double>(header.last() - header.first()) / static_cast<double>(header.trials);
    const auto numbers = static_cast<double>(map->numbers);
    constexpr double most_on_page = 1e6;
    const double all = 1.0 * map->columns * map->rows * static_cast<double>(map->panels);
    if (figure.chart.format == PictureFormat::html && !tiles && all > most_on_page)
        throw bad_input("{}: a page shows maps of at most {} cells; this one has {}; take fewer, or --tiles",
                        figure.name, grouped(std::lround(most_on_page)), grouped(std::lround(all)));
    const double cells = share * all;
    const auto refuse = [&](ExitCode code, const char* what, double needed, double there) {
        return Error(
            code, fmt::format("{}: {} × {} cells take {} of {}, and there are {}; take fewer", figure.name,
                              grouped(map->columns), grouped(map->rows), bytes_text(needed), what, bytes_text(there)));
    };
    // the numbers of all trials, and two floats for each drawn cell; for tiles also their pixels
    const double memory = cells * (8 * numbers + 8 + (tiles ? 6 : 0)),
                 owned = static_cast<double>(this_machine().memory);
    if (memory > 0.8 * owned) throw refuse(ExitCode::bad_input, "memory", memory, owned);
    std::error_code unknown;
    const auto space = fs::space(folder, unknown);
    const double table = cells * (30 + 18 * numbers), free = static_cast<double>(space.available);
    if (!unknown && table > free) throw refuse(ExitCode::try_again, "disk", table, free);
}

/// Times of the run for the manifest; those of computing may include other figures'.
struct FigureRecord {
    int jobs = 1;
    double compute_wall_s = 0, compute_cpu_s = 0, draw_cpu_s = 0;
};

/// `tiles` = the description of a pyramid, otherwise null.
void write_manifest(Transaction& parts, const FigurePreset& figure, const KnownTrials& trials,
                    const FigureRecord& record, const Json& tiles) {
    Json manifest = {
        {"doppel", program_json()},
        {"figure", figure.name},
        {"kind", figure.kind},
        {"title", figure.title},
        {"captions", figure.captions},
        {"erratum", figure.erratum},
        {"resolved_preset", json_of_toml(figure.resolved())},
        {"trials", trials.size()},
        {"threads", record.jobs},
        {"register_width", register_widths().back()},
        {"libraries", {{"drawing", page_library()}, {"compiler", __VERSION__}}},
        {"time",
         {{"compute_wall_s", record.compute_wall_s},
          {"compute_cpu_s", record.compute_cpu_s},
          {"draw_cpu_s", record.draw_cpu_s}}},
    };
    if (!tiles.is_null()) manifest["tiles"] = tiles;
    doppel::write_manifest(parts, figure.name + (tiles.is_null() ? ".json" : ".tiles.json"), std::move(manifest));
}

/// Returns what there was no room for.
std::vector<std::string> write_picture(const FigurePreset& figure, const KnownTrials& trials, Transaction& files,
                                       const std::atomic<bool>& stop) {
    const auto format = figure.chart.format;
    const auto name = fmt::format("{}.{}", figure.name, name_of(format));
    const auto place = files.file(name);
    std::vector<std::string> notes;
    if (format == PictureFormat::html) {
        write_file(place, figure_page(figure, page_of(figure, trials)));
    } else {
        const auto drawn = compose_figure(figure, trials);
        const double width_pt = layout_of(figure.chart).width_pt;
        const auto metadata = metadata_of(figure.title, figure.name);
        if (format == PictureFormat::png)
            write_png(place, picture_of(drawn, stop), {.metadata = metadata, .dpi = 72 * drawn.size.width / width_pt},
                      stop);
        else
            write_file(place, page_file(drawn, format, width_pt, metadata));
        notes = drawn.notes;
    }
    files.finished(name);
    return notes;
}

/// Draws and writes a figure whose trials are complete.
RunResult write_figure(const FigurePreset& figure, const KnownTrials& trials, FigureRecord record, bool as_tiles,
                       Transaction& files, const std::atomic<bool>& stop) {
    RunResult result;
    const auto finish = [&] {
        const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
        Json tiles;
        if (as_tiles) {
            tiles = write_tiles(figure, page_of(figure, trials), files, record.jobs, stop);
        } else {
            result.warnings = write_picture(figure, trials, files, stop);
            throw_if_set(stop);
            const auto csv = figure.name + ".csv";
            Csv table(files.file(csv), figure.experiment->columns());
            figure.experiment->write_rows(trials, table);
            table.finish();
            files.finished(csv);
        }
        record.draw_cpu_s = seconds_of(CLOCK_THREAD_CPUTIME_ID) - start;
        throw_if_set(stop);
        write_manifest(files, figure, trials, record, tiles);
        throw_if_set(stop);
        return files.publish();
    };
    result.files = files.keeping_finished(finish);
    return result;
}

}  // namespace

Page compose_figure(const FigurePreset& figure, const KnownTrials& trials) {
    return compose_chart(figure.chart, page_of(figure, trials));
}

std::vector<std::string> figure_files(const FigurePreset& figure, const FigureOptions& options) {
    const auto& name = figure.name;
    if (options.shard) return {shard_name(header_of(figure, *options.shard))};
    if (options.tiles) return {name + ".tiles/", name + ".html", name + ".tiles.json"};
    return {fmt::format("{}.{}", name, name_of(figure.chart.format)), name + ".csv", name + ".json"};
}

void run_figures(const std::vector<FigurePreset>& figures, const FigureOptions& options, const std::atomic<bool>& stop,
                 const FigureReport& report) {
    const int jobs = options.jobs > 0 ? options.jobs : cores();
    const std::string kind = options.tiles ? "map of tiles" : "figure";
    if (options.merge) {
        for (std::size_t k = 0; k < figures.size(); ++k) {
            const double start = seconds_of(CLOCK_MONOTONIC);
            const auto folder = options.out / figures[k].name;
            const auto trials = merged_parts(figures[k], folder, stop);
            Transaction files(folder, "run", kind, options.replacing);
            auto result = write_figure(figures[k], trials, {.jobs = jobs}, options.tiles, files, stop);
            result.wall_s = seconds_of(CLOCK_MONOTONIC) - start;
            report.done(k, result);
        }
        return;
    }
    using Trial = std::pair<std::size_t, std::size_t>;  // number of the figure, and of its trial
    std::vector<std::unique_ptr<Transaction>> files;    // opened first, so that errors are reported early
    std::vector<std::unique_ptr<Computation>> computations;
    std::vector<Trial> trials, timed_trials;
    const auto run = options.shard ? fmt::format("shard-{}-of-{}", options.shard->number, options.shard->of) : "run";
    for (const auto& figure : figures) {
        files.push_back(std::make_unique<Transaction>(options.out / figure.name, run, kind, options.replacing));
        for (const auto& name : figure_files(figure, options))
            if (!name.ends_with('/') && !options.shard) files.back()->require(name);
    }
    for (std::size_t k = 0; k < figures.size(); ++k) {
        const auto& figure = figures[k];
        const auto header = header_of(figure, options.shard.value_or(Shard{}));
        const auto& folder = files[k]->folder();
        require_room(figure, header, options.tiles, folder);
        if (const auto others = other_resumes(folder, header);
            !others.empty() && type_of(folder / resume_name(header)) == fs::file_type::not_found)
            report.note(k, fmt::format("ignoring {}{}, of another preset or version", others.front().string(),
                                       others.size() > 1 ? fmt::format(" and {} more", others.size() - 1) : ""));
        const auto kept = files[k]->is_temporary() ? std::nullopt : std::optional(folder);
        computations.push_back(std::make_unique<Computation>(figure, header, kept, report, k));
        auto& of_its_sort = figure.experiment->measures_time() ? timed_trials : trials;
        for (const auto trial : computations[k]->unknown()) of_its_sort.emplace_back(k, trial);
    }
    std::mutex writing;  // fonts are for one thread at a time
    const auto write = [&](std::size_t k) {
        const std::lock_guard lock(writing);
        auto& computation = *computations[k];
        const double now = seconds_of(CLOCK_MONOTONIC), start = computation.start_s() > 0 ? computation.start_s() : now;
        const FigureRecord record{.jobs = jobs, .compute_wall_s = now - start, .compute_cpu_s = computation.cpu_s()};
        RunResult result;
        try {
            if (options.shard)
                result.files = {computation.publish_shard()};
            else
                result = write_figure(figures[k], computation.take_all(), record, options.tiles, *files[k], stop);
        } catch (const Error& error) {
            // running the same command again could not draw more
            if (error.code() == ExitCode::method_failed) {
                fs::remove(computation.record());
                throw;
            }
            throw computation.with_record(error);
        }
        fs::remove(computation.record());
        result.samples = std::lround(computation.computed_units());
        result.wall_s = seconds_of(CLOCK_MONOTONIC) - start;
        report.done(k, result);
    };
    const auto compute = [&](const Trial& trial) {
        if (computations[trial.first]->compute(trial.second, stop)) write(trial.first);
    };
    for (std::size_t k = 0; k < figures.size(); ++k)
        if (computations[k]->unknown().empty()) write(k);
    parallel_for(trials.size(), jobs, [&](std::size_t i) { compute(trials[i]); });
    std::ranges::for_each(timed_trials, compute);
}

}  // namespace doppel
