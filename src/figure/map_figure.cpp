#include "figure/map_figure.hpp"

#include "base/error.hpp"
#include "base/machine.hpp"
#include "base/text.hpp"
#include "scene/captions.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {

std::size_t MapFigure::row_trials() const {
    return static_cast<std::size_t>(frame_.is_mirrored ? (frame_.y.count + 1) / 2 : frame_.y.count);
}

double MapFigure::units(std::size_t trial) const {
    if (trial >= row_trials()) return 0;
    const bool is_twofold =
        frame_.is_mirrored && static_cast<int>(trial) != frame_.y.count - 1 - static_cast<int>(trial);
    return frame_.x.count * (is_twofold ? 2 : 1);
}

TrialNumbers MapFigure::compute_trial(std::size_t trial, const std::atomic<bool>& stop) const {
    if (trial >= row_trials()) return compute_other(trial - row_trials(), stop);
    constexpr int together = 512;
    TrialNumbers row;
    for (int column = 0; column < frame_.x.count; column += together) {
        std::vector<TrialNumbers> cells(static_cast<std::size_t>(std::min(together, frame_.x.count - column)));
        find(static_cast<int>(trial), column, cells, stop);
        for (const auto& cell : cells) row.insert(row.end(), cell.begin(), cell.end());
    }
    return row;
}

bool MapFigure::fits(std::size_t trial, std::span<const double> numbers) const {
    if (trial >= row_trials()) return fits_other(trial - row_trials(), numbers);
    const std::size_t cell = numbers_in_cell();
    if (numbers.size() != cell * static_cast<std::size_t>(frame_.x.count)) return false;
    for (; !numbers.empty(); numbers = numbers.subspan(cell))
        if (!fits_cell(numbers.first(cell))) return false;
    return true;
}

std::span<const double> MapFigure::numbers_at(std::span<const TrialNumbers> numbers, int row, int column) const {
    const bool is_there = static_cast<std::size_t>(row) < row_trials();
    const auto& trial = numbers[static_cast<std::size_t>(is_there ? row : frame_.y.count - 1 - row)];
    const auto place = static_cast<std::size_t>(is_there ? column : frame_.x.count - 1 - column);
    return std::span(trial).subspan(place * numbers_in_cell(), numbers_in_cell());
}

double MapFigure::at(std::span<const TrialNumbers> numbers, int row, int column) const {
    const double number = numbers_at(numbers, row, column).front();
    return std::isfinite(number) ? number : NAN;
}

void MapFigure::write_rows(std::span<const TrialNumbers> numbers, Csv& table) const {
    for (int row = 0; row < frame_.y.count; ++row)
        for (int column = 0; column < frame_.x.count; ++column) {
            table.add(frame_.x.middle(column));
            table.add(frame_.y.middle(row));
            for (const double number : numbers_at(numbers, row, column))
                table.add_or_empty(std::isfinite(number) ? number : NAN);
            table.end_row();
        }
}

void MapFigure::draw(std::span<const TrialNumbers> numbers, Figure& figure) const {
    const auto &x = frame_.x, &y = frame_.y;
    Plot plot{.x = frame_.x_axis, .y = frame_.y_axis, .map = frame_.look};
    plot.x.low = x.from, plot.x.high = x.to;
    plot.y.low = y.from, plot.y.high = y.to;
    plot.x.logarithmic = x.is_logarithmic(), plot.y.logarithmic = y.is_logarithmic();
    auto& map = *plot.map;
    map.columns = static_cast<std::size_t>(x.count);
    map.rows = static_cast<std::size_t>(y.count);
    map.x_low = x.from, map.x_high = x.to, map.y_low = y.from, map.y_high = y.to;
    map.values.reserve(map.columns * map.rows);
    for (int row = 0; row < y.count; ++row)
        for (int column = 0; column < x.count; ++column)
            map.values.push_back(static_cast<float>(at(numbers, row, column)));
    if (std::none_of(map.values.begin(), map.values.end(), [](float cell) { return std::isnan(cell); }))
        map.none_label = "";
    figure.panels.push_back(std::move(plot));
}

void demand_room(const FigurePreset& figure, const PartHeader& header, const std::filesystem::path& folder) {
    const auto* map = figure.experiment->map();
    if (!map) return;
    const auto &x = map->frame().x, &y = map->frame().y;
    const double share = static_cast<double>(header.last() - header.first()) / static_cast<double>(header.trials);
    const double numbers = static_cast<double>(map->frame().columns.size() - 2);
    const double cells = share * x.count * y.count;
    const auto refuse = [&](const char* what, double needed, double there) {
        return bad_input("{}: {} × {} cells take {} of {}, and there are {}; take fewer, or --tiles", figure.name,
                         grouped(x.count), grouped(y.count), bytes_text(needed), what, bytes_text(there));
    };
    // the numbers of all trials, and where a picture is drawn twice a float
    const double memory = cells * (8 * numbers + 8), owned = static_cast<double>(this_machine().memory);
    if (memory > 0.8 * owned) throw refuse("memory", memory, owned);
    std::error_code unknown;
    const auto space = std::filesystem::space(folder, unknown);
    const double table = cells * (30 + 18 * numbers), free = static_cast<double>(space.available);
    if (!unknown && table > free) throw refuse("disk", table, free);
}

}  // namespace doppel
