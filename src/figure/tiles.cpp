#include "figure/tiles.hpp"

#include "base/clock.hpp"
#include "base/machine.hpp"
#include "base/text.hpp"
#include "base/threads.hpp"
#include "figure/map_figure.hpp"
#include "figure/tile_folder.hpp"
#include "figure/tile_page.hpp"
#include "output/transaction.hpp"
#include "scene/captions.hpp"
#include "scene/resolved.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

namespace doppel {
namespace {

constexpr double bytes_a_cell = 1;  // of PNGs; of the flip map 0.6

/// What the pixels of all tiles depend on.
Json owner_of(const FigurePreset& figure, const MapFigure& map) {
    const auto header = header_of(figure);
    const auto& look = map.frame().look;
    Json range;  // null: by the numbers
    if (look.low && look.high) range = {*look.low, *look.high};
    return {{"doppel", program_json()},       {"figure", header.figure},     {"preset_sha256", header.preset},
            {"version", header.version},      {"revision", header.revision}, {"theme", figure.chart.theme},
            {"color_range", std::move(range)}};
}

/// Makes the tiles of one figure.
class TileMaker {
public:
    TileMaker(const FigurePreset& figure, const std::filesystem::path& above, int jobs, const std::atomic<bool>& stop,
              ComputationReport report)
        : figure_(figure),
          map_(*figure.experiment->map()),
          pyramid_(map_.frame().x.count, map_.frame().y.count),
          theme_(*std::find_if(themes.begin(), themes.end(),
                               [&](const Theme& theme) { return theme.name == figure.chart.theme; })),
          folder_(above / (figure.name + ".tiles"), owner_of(figure, *figure.experiment->map())),
          stop_(stop),
          report_(std::move(report)),
          jobs_(jobs) {
        const auto& frame = map_.frame();
        constexpr int tile = Pyramid::tile;
        mirrors_ = frame.is_mirrored && frame.x.count % tile == 0 && frame.y.count % tile == 0;
    }

    /// Colours by the numbers of 64 rows of 64 cells, or of as many as there are, if the preset does not say; of a row
    /// some stand side by side, as they are found fastest together.
    void fit_colors() {
        look_ = map_.frame().look;
        if (look_.low && look_.high) return;
        constexpr int most_rows = 64, most_groups = 8, together = 8;
        const auto &x = map_.frame().x, &y = map_.frame().y;
        const int side_by_side = std::min(together, x.count);
        const int rows = std::min(most_rows, y.count), groups = std::min(most_groups, x.count / side_by_side);
        std::vector<std::vector<float>> numbers(static_cast<std::size_t>(rows));
        parallel_for(numbers.size(), jobs_, [&](std::size_t row) {
            for (int group = 0; group < groups; ++group) {
                std::vector<TrialNumbers> cells(static_cast<std::size_t>(side_by_side));
                map_.find(spread(static_cast<int>(row), rows, y.count),
                          spread(group, groups, x.count - side_by_side + 1), cells, stop_);
                for (const auto& cell : cells) numbers[row].push_back(static_cast<float>(cell[0]));
            }
        });
        auto sample = look_;
        for (const auto& row : numbers) sample.values.insert(sample.values.end(), row.begin(), row.end());
        const auto [low, high] = color_range(sample);
        look_.low = low;
        look_.high = high;
    }

    void demand_space() const {
        const double cells = static_cast<double>(pyramid_.columns) * pyramid_.rows;
        std::error_code unknown;
        const auto space = std::filesystem::space(folder_.path(), unknown);
        const double needed = bytes_a_cell * cells * 4 / 3 * (1 - share_there());
        if (unknown || needed < static_cast<double>(space.available)) return;
        throw bad_input("{}: the tiles of {} × {} cells take some {}, and {} has {} free", figure_.name,
                        grouped(pyramid_.columns), grouped(pyramid_.rows), bytes_text(needed), folder_.path().string(),
                        bytes_text(static_cast<double>(space.available)));
    }

    /// The finest tiles of a part that are missing.
    void compute(const Shard& shard) {
        const int across = pyramid_.across(pyramid_.levels), down = pyramid_.down(pyramid_.levels);
        const long all = static_cast<long>(across) * down, computed = mirrors_ ? (all + 1) / 2 : all;
        const long first = computed * (shard.number - 1) / shard.of, last = computed * shard.number / shard.of;
        std::vector<long> missing;
        for (long i = first; i < last; ++i) {
            const int row = static_cast<int>(i / across), column = static_cast<int>(i % across);
            if (!is_there(pyramid_.levels, row, column) ||
                (mirrors_ && !is_there(pyramid_.levels, down - 1 - row, across - 1 - column)))
                missing.push_back(i);
            else
                done_ += cells_by(i);
            total_ += cells_by(i);
        }
        if (done_ > 0)
            report_.note(
                fmt::format("goes on: {:.0f} % of the finest tiles are there",
                            100 * (1 - static_cast<double>(missing.size()) / static_cast<double>(last - first))));
        if (!missing.empty()) fit_colors();
        start_s_ = seconds_of(CLOCK_MONOTONIC);
        parallel_for(missing.size(), jobs_, [&](std::size_t i) {
            throw_if_set(stop_);
            const int row = static_cast<int>(missing[i] / across), column = static_cast<int>(missing[i] % across);
            auto picture = finest(row, column);
            write(picture, pyramid_.levels, row, column);
            const int other_row = down - 1 - row, other_column = across - 1 - column;
            if (mirrors_ && (other_row != row || other_column != column)) {
                turn(picture);
                write(picture, pyramid_.levels, other_row, other_column);
            }
            progress(cells_by(missing[i]));
        });
    }

    /// The coarser ones, from those below them.
    void combine() {
        for (int level = pyramid_.levels - 1; level >= 0; --level) {
            const int across = pyramid_.across(level), down = pyramid_.down(level);
            parallel_for(static_cast<std::size_t>(across) * static_cast<std::size_t>(down), jobs_, [&](std::size_t i) {
                throw_if_set(stop_);
                const int row = static_cast<int>(i) / across, column = static_cast<int>(i) % across;
                if (!is_there(level, row, column)) write(combined(level, row, column), level, row, column);
            });
        }
    }

    /// Throws where a part of the finest tiles is missing.
    void demand_finest() const {
        for (int row = 0; row < pyramid_.down(pyramid_.levels); ++row)
            for (int column = 0; column < pyramid_.across(pyramid_.levels); ++column)
                if (!is_there(pyramid_.levels, row, column))
                    throw try_again("{}: the tile {} is missing; compute all parts before the merge", figure_.name,
                                    (folder_.path() / Pyramid::name(pyramid_.levels, row, column)).string());
    }

    TilePage page() {
        if (!look_.low || !look_.high) fit_colors();
        return {figure_.title, figure_.subtitle, folder_.path().filename().string(), pyramid_, map_.frame(), look_,
                theme_};
    }
    /// Whether no cell has a number; of tiles from an earlier run, by the one that shows all.
    bool is_empty() {
        if (drawn_) return false;
        auto none = page().look;
        none.columns = none.rows = 1;
        none.values = {NAN};
        const auto nothing = cell_picture(none, theme_), all = folder_.read(Pyramid::name(0, 0, 0));
        for (std::size_t i = 0; i < all.rgba.size(); i += 4)
            if (all.rgba[i + 3] == 255 && !std::equal(&all.rgba[i], &all.rgba[i] + 3, nothing.rgba.begin()))
                return false;
        return true;
    }
    const Pyramid& pyramid() const { return pyramid_; }
    double cells_computed() const { return computed_; }
    double seconds() const { return seconds_of(CLOCK_MONOTONIC) - start_s_; }

private:
    static int spread(int i, int of, int cells) { return static_cast<int>((2L * i + 1) * cells / (2L * of)); }
    /// How many cells are known with finest tile i, counted row by row; of a mirrored map its image's too.
    double cells_by(long i) const {
        constexpr int tile = Pyramid::tile;
        const int across = pyramid_.across(pyramid_.levels);
        const int row = static_cast<int>(i / across), column = static_cast<int>(i % across);
        const double cells = std::min(tile, pyramid_.columns - column * tile) *
                             static_cast<double>(std::min(tile, pyramid_.rows - row * tile));
        const bool is_own_image = 2 * i + 1 == static_cast<long>(across) * pyramid_.down(pyramid_.levels);
        return cells * (mirrors_ && !is_own_image ? 2 : 1);
    }
    double share_there() const {
        const double all = static_cast<double>(pyramid_.across(pyramid_.levels)) * pyramid_.down(pyramid_.levels);
        return std::min(1.0, static_cast<double>(folder_.count()) / (all * 4 / 3));
    }

    bool is_there(int level, int row, int column) const { return folder_.has(Pyramid::name(level, row, column)); }

    Picture finest(int row, int column) const {
        constexpr int tile = Pyramid::tile;
        const int left = column * tile, width = std::min(tile, pyramid_.columns - left);
        HeatMap cells = look_;
        cells.columns = static_cast<std::size_t>(width);
        const int top = row * tile, height = std::min(tile, pyramid_.rows - top);
        cells.rows = static_cast<std::size_t>(height);
        for (int y = height - 1; y >= 0; --y) {  // from the bottom up
            throw_if_set(stop_);
            std::vector<TrialNumbers> numbers(cells.columns);
            map_.find(pyramid_.rows - 1 - top - y, left, numbers, stop_);
            for (const auto& cell : numbers) {
                cells.values.push_back(static_cast<float>(cell[0]));
                if (std::isfinite(cell[0])) drawn_ = true;
            }
        }
        Picture picture({tile, tile});
        paste(cell_picture(cells, theme_), 0, 0, picture);
        return picture;
    }

    Picture combined(int level, int row, int column) const {
        Picture four({2 * Pyramid::tile, 2 * Pyramid::tile});
        for (int below = 0; below < 2; ++below)
            for (int right = 0; right < 2; ++right) {
                const int r = 2 * row + below, c = 2 * column + right;
                if (r < pyramid_.down(level + 1) && c < pyramid_.across(level + 1))
                    paste(folder_.read(Pyramid::name(level + 1, r, c)), right * Pyramid::tile, below * Pyramid::tile,
                          four);
            }
        return downscaled(four, {Pyramid::tile, Pyramid::tile});
    }

    static void paste(const Picture& from, int left, int top, Picture& into) {
        for (int y = 0; y < from.size.height; ++y)
            std::copy_n(from.at(0, y), 4 * static_cast<std::size_t>(from.size.width), into.at(left, top + y));
    }
    /// By half a turn.
    static void turn(Picture& picture) {
        const auto count = picture.rgba.size() / 4;
        for (std::size_t i = 0; i < count / 2; ++i)
            std::swap_ranges(&picture.rgba[4 * i], &picture.rgba[4 * i] + 4, &picture.rgba[4 * (count - 1 - i)]);
    }

    void write(const Picture& picture, int level, int row, int column) {
        folder_.write(Pyramid::name(level, row, column), picture, stop_);
    }

    void progress(double cells) {
        const std::lock_guard hold(mutex_);
        done_ += cells;
        computed_ += cells;
        report_.progress({done_, total_});
        const double seconds = seconds_of(CLOCK_MONOTONIC) - start_s_;
        if (told_ || seconds < 5) return;
        told_ = true;
        const double rate = computed_ / seconds, left = (total_ - done_) / rate;
        report_.note(fmt::format("{} cells to go, about {} a second: {}", grouped(std::lround(total_ - done_)),
                                 roughly(rate),
                                 left < 100 ? fmt::format("{:.0f} s", left) : fmt::format("{:.0f} min", left / 60)));
    }

    const FigurePreset& figure_;
    const MapFigure& map_;
    Pyramid pyramid_;
    const Theme& theme_;
    TileFolder folder_;
    const std::atomic<bool>& stop_;
    ComputationReport report_;
    int jobs_;
    HeatMap look_;
    bool mirrors_ = false;
    mutable std::atomic<bool> drawn_ = false;                   // a number, by this run
    mutable std::mutex mutex_;                                  // of all below
    double total_ = 0, done_ = 0, computed_ = 0, start_s_ = 0;  // cells, s
    bool told_ = false;
};

}  // namespace

Pyramid::Pyramid(int across_cells, int down_cells) : columns(across_cells), rows(down_cells), levels(0) {
    while ((static_cast<long>(tile) << levels) < std::max(columns, rows)) ++levels;
}

int Pyramid::tiles(int cells, int level) const {
    const long side = static_cast<long>(tile) << (levels - level);
    return static_cast<int>((cells + side - 1) / side);
}

std::string Pyramid::name(int level, int row, int column) {
    return fmt::format("{}-{}-{}.png", level, row, column);
}

void demand_map(const FigurePreset& figure) {
    const auto* map = figure.experiment->map();
    if (!map || map->frame().panels > 1)
        throw bad_input("{}: --tiles are of one map, kind = \"grid\" with [grid.x] and [grid.y] alone", figure.name);
}

void make_tiles(const FigurePreset& figure, const FigureOptions& options, const std::atomic<bool>& stop,
                const ComputationReport& report, const std::function<void(const RunResult&)>& done) {
    demand_map(figure);
    const double start = seconds_of(CLOCK_MONOTONIC);
    const int jobs = options.jobs > 0 ? options.jobs : cores();
    const auto run = options.shard ? fmt::format("tiles-{}-of-{}", options.shard->number, options.shard->of) : "tiles";
    Transaction files(options.out / figure.name, run, "figure", options.replacing);
    for (const char* ending : {".html", ".tiles.json"}) files.demand(figure.name + ending);
    TileMaker tiles(figure, files.folder(), jobs, stop, report);
    RunResult result;
    if (!options.merge) {
        tiles.demand_space();
        tiles.compute(options.shard.value_or(Shard{}));
    }
    if (!options.shard) {
        if (options.merge) tiles.demand_finest();
        const double computed_s = tiles.seconds();
        tiles.combine();
        if (tiles.is_empty())
            throw method_failed("{}: none of the {} × {} cells has a number: there is nothing to draw", figure.name,
                                grouped(tiles.pyramid().columns), grouped(tiles.pyramid().rows));
        const auto html = figure.name + ".html";
        write_tile_page(files.file(html), tiles.page());
        files.finished(html);
        const auto& pyramid = tiles.pyramid();
        write_manifest(files, figure.name + ".tiles.json",
                       {{"doppel", program_json()},
                        {"figure", figure.name},
                        {"title", figure.title},
                        {"resolved_preset", json_of_toml(figure.resolved())},
                        {"tiles",
                         {
                             {"folder", figure.name + ".tiles"},
                             {"size_px", Pyramid::tile},
                             {"levels", pyramid.levels + 1},
                             {"cells", {pyramid.columns, pyramid.rows}},
                         }},
                        {"threads", jobs},
                        {"time", {{"compute_wall_s", computed_s}, {"cells_computed", tiles.cells_computed()}}}});
        result.files = files.publish();
    }
    result.samples = std::lround(tiles.cells_computed());
    result.wall_s = seconds_of(CLOCK_MONOTONIC) - start;
    done(result);
}

}  // namespace doppel
