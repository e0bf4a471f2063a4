#include "figure/tiles.hpp"

#include "base/embedded.hpp"
#include "base/text.hpp"
#include "base/threads.hpp"
#include "embedded/figure.hpp"
#include "output/png.hpp"

#include <algorithm>

namespace doppel {
namespace {

constexpr int tile = 256;  // pixels of a side

/// A part of a picture; what lies beyond it is transparent.
Picture part_of(const Picture& picture, int left, int top, Size size) {
    Picture part(size);
    const int wide = std::min(size.width, picture.size.width - left);
    for (int y = 0; y < std::min(size.height, picture.size.height - top); ++y)
        std::copy_n(picture.at(left, top + y), 4 * static_cast<std::size_t>(wide), part.at(0, y));
    return part;
}

/// From one that fits into a tile on, each with twice the pixels to a side of the one before.
std::vector<Picture> levels_of(Picture cells) {
    std::vector<Picture> levels{std::move(cells)};
    while (std::max(levels[0].size.width, levels[0].size.height) > tile) {
        const auto [width, height] = levels[0].size;
        const Size half{(width + 1) / 2, (height + 1) / 2};
        levels.insert(levels.begin(), downscaled(part_of(levels[0], 0, 0, {2 * half.width, 2 * half.height}), half));
    }
    return levels;
}

Json axis_json(const PlotAxis& axis) {
    return {{"label", axis.label}, {"from", *axis.low}, {"to", *axis.high}, {"logarithmic", axis.logarithmic}};
}

/// The bar of colours with its numbers.
std::string scale_markup(const HeatMap& map, const Theme& theme) {
    const auto hexadecimal = [](Color color) {
        const auto bytes = bytes_of(color);
        return fmt::format("#{:02x}{:02x}{:02x}", bytes[0], bytes[1], bytes[2]);
    };
    constexpr int stops = 64;
    MapScale scale(map);
    std::string colors, numbers;
    for (int i = 0; i <= stops; ++i)
        colors += (i == 0 ? "" : ",") + hexadecimal(scale.color(static_cast<double>(i) / stops));
    scale.axis.to = 380;  // px on the page
    for (const auto& tick : chart_ticks(scale.axis, {.size = 14, .across = false}, map.threshold))
        if (!tick.text.empty())
            numbers +=
                fmt::format("<span style=\"--at:{:.1f}%\">{}</span>", 100 * scale.axis.share(tick.value), tick.text);
    auto text = fmt::format("{}<div id=\"scale\" style=\"--colors:{}\">{}</div>", markup(map.label), colors, numbers);
    if (map.none_label.empty()) return text;
    return fmt::format("{}<div id=\"none\" style=\"border-color:{}\">{}</div>", text,
                       hexadecimal(map.none_is_bad ? theme.bad : theme.none), markup(map.none_label));
}

/// The page, in which {title}, {subtitle}, {scale} and {map} stand for what it shows.
std::string page_text(const std::array<std::pair<std::string_view, std::string>, 4>& values) {
    const auto files = figure_files();
    const auto file = std::ranges::find(files, "figure/tiles.html", &EmbeddedFile::name);
    if (file == files.end()) throw io_failed("the page of tiles was not built in");
    std::string text;
    for (std::string_view rest = file->contents; !rest.empty();) {
        const auto value = std::ranges::find_if(values, [&](const auto& v) { return rest.starts_with(v.first); });
        const auto taken = value == values.end() ? std::min(rest.find('{', 1), rest.size()) : value->first.size();
        text += value == values.end() ? rest.substr(0, taken) : std::string_view(value->second);
        rest.remove_prefix(taken);
    }
    return text;
}

}  // namespace

void require_map(const FigurePreset& figure) {
    const auto map = figure.experiment->map();
    if (!map || map->panels > 1)
        throw bad_input("{}: --tiles are of one map, kind = \"grid\" with [grid.x] and [grid.y] alone", figure.name);
}

Json write_tiles(const FigurePreset& figure, const Figure& page, const Theme& theme, Transaction& files, int jobs,
                 const std::atomic<bool>& stop) {
    require_map(figure);
    const auto& plot = page.panels.front();
    const auto name = figure.name + ".tiles", html = figure.name + ".html";
    const auto folder = files.directory(name);
    const auto levels = levels_of(cell_picture(*plot.map, theme));
    for (std::size_t level = 0; level < levels.size(); ++level) {
        const auto [width, height] = levels[level].size;
        const int across = (width + tile - 1) / tile, down = (height + tile - 1) / tile;
        parallel_for(static_cast<std::size_t>(across) * static_cast<std::size_t>(down), jobs, [&](std::size_t i) {
            throw_if_set(stop);
            const int row = static_cast<int>(i) / across, column = static_cast<int>(i) % across;
            const auto picture = part_of(levels[level], column * tile, row * tile, {tile, tile});
            write_png(folder / fmt::format("{}-{}-{}.png", level, row, column), picture,
                      {.with_alpha = !picture.is_opaque()}, stop);
        });
    }
    files.finished(name);
    const Json map{{"folder", in_address(name)},   {"tile", tile},           {"levels", levels.size() - 1},
                   {"columns", plot.map->columns}, {"rows", plot.map->rows}, {"x", axis_json(plot.x)},
                   {"y", axis_json(plot.y)}};
    write_file(files.file(html),
               page_text({{{"{title}", markup(figure.title)},
                           {"{subtitle}", markup(figure.subtitle)},
                           {"{scale}", scale_markup(*plot.map, theme)},
                           {"{map}", in_script(map.dump(-1, ' ', false, Json::error_handler_t::replace))}}}));
    files.finished(html);
    return {
        {"folder", name}, {"size_px", tile}, {"levels", levels.size()}, {"cells", {plot.map->columns, plot.map->rows}}};
}

}  // namespace doppel
