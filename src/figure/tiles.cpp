#include "figure/tiles.hpp"

#include "base/embedded.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "base/threads.hpp"
#include "embedded/figure.hpp"
#include "film/page_json.hpp"
#include "output/page.hpp"
#include "output/png.hpp"

#include <algorithm>

namespace doppel {
namespace {

constexpr int tile = 256;  // pixels per side

/// A rectangle of a picture; outside the picture it is transparent.
Picture part_of(const Picture& picture, int left, int top, Size size) {
    Picture part(size);
    const int wide = std::min(size.width, picture.size.width - left);
    for (int y = 0; y < std::min(size.height, picture.size.height - top); ++y)
        std::copy_n(picture.at(left, top + y), 4 * static_cast<std::size_t>(wide), part.at(0, y));
    return part;
}

/// The first level fits into one tile; each further level has twice as many pixels per side.
std::vector<Picture> levels_of(Picture cells) {
    std::vector<Picture> levels{std::move(cells)};
    while (std::max(levels[0].size.width, levels[0].size.height) > tile)
        levels.insert(levels.begin(), halved(levels[0]));
    return levels;
}

/// The colour bar from its lower end, and its labels: [share of the bar, text].
Json scale_json(const HeatMap& map, const Theme& theme) {
    constexpr int stops = 64;
    MapScale scale(map);
    Json colors = Json::array(), numbers = Json::array();
    for (int i = 0; i <= stops; ++i) colors.push_back(hexadecimal(scale.color(static_cast<double>(i) / stops)));
    scale.axis.to = 380;  // px on the page
    for (const auto& tick : chart_ticks(scale.axis, {.size = 14, .across = false}, map.threshold))
        if (!tick.text.empty()) numbers.push_back({scale.axis.share(tick.value), tick.text});
    return {{"colors", colors}, {"numbers", numbers}, {"none", hexadecimal(none_color(map, theme))}};
}

std::string body_of(const FigurePreset& figure, const HeatMap& map) {
    return fmt::format(R"html(<header><h1 dir="auto">{}</h1><p dir="auto">{}</p></header>
<main>
<canvas tabindex="0" aria-label="map: drag to move, scroll to zoom"></canvas>
<p id="at"></p>
<nav><button title="closer (+)" data-by="2">+</button><button title="farther (−)" data-by="0.5">−</button><button title="all (0)" data-by="0">▢</button></nav>
</main>
<aside>{}<div id="scale"></div><div id="none"{}>{}</div></aside>
<footer>Drag to move, scroll or pinch to zoom, arrows and + − 0 on the keyboard. The address keeps the place.</footer>)html",
                       markup(figure.title), markup(figure.subtitle), markup(map.label),
                       map.none_label.empty() ? " hidden=\"\"" : "", markup(map.none_label));
}

}  // namespace

void require_map(const FigurePreset& figure) {
    const auto map = figure.experiment->map();
    if (!map || map->panels > 1)
        throw bad_input("{}: --tiles are of one map, kind = \"grid\" with [grid.x] and [grid.y] alone", figure.name);
    if (figure.chart.format == PictureFormat::html)
        throw bad_input("{0}: --tiles writes {0}.html itself; the format must be png, pdf or svg", figure.name);
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
    const auto axis = [](const PlotAxis& of) { return axis_json({*of.low, *of.high, 0, 1, of.logarithmic}, of.label); };
    const Json map{{"folder", in_address(name)},  {"tile", tile},
                   {"levels", levels.size() - 1}, {"columns", plot.map->columns},
                   {"rows", plot.map->rows},      {"x", axis(plot.x)},
                   {"y", axis(plot.y)},           {"scale", scale_json(*plot.map, theme)}};
    write_file(files.file(html), page_text({.kind = "tiles",
                                            .title = figure.title,
                                            .body = body_of(figure, *plot.map),
                                            .styles = {embedded_file(figure_files(), "figure/tiles.css")},
                                            .scripts = {embedded_file(figure_files(), "figure/tiles.js")},
                                            .data = map,
                                            .has_pictures_beside = true}));
    files.finished(html);
    return {
        {"folder", name}, {"size_px", tile}, {"levels", levels.size()}, {"cells", {plot.map->columns, plot.map->rows}}};
}

}  // namespace doppel
