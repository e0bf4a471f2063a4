#include "figure/page.hpp"

#include "base/embedded.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "base/threads.hpp"
#include "embedded/figure.hpp"
#include "film/page.hpp"
#include "output/page.hpp"
#include "output/png.hpp"

#include <fmt/ranges.h>

#include <algorithm>

namespace doppel {
namespace {

/// The cells of a map, otherwise the points of the curves, as text; NaN is "nan".
Json panel_json(const Plot& plot, const PlotRanges& axes) {
    Json panel{{"title", plot.title}, {"x", axis_json(axes.x, plot.x.label)}, {"y", axis_json(axes.y, plot.y.label)}};
    if (axes.right) panel["right"] = axis_json(*axes.right, plot.right->label);
    auto& curves = panel["curves"] = Json::array();
    if (const auto& map = plot.map) {
        const auto values = fmt::format("{:.4g}", fmt::join(map->values, " "));
        panel["map"] = {{"columns", map->columns},
                        {"rows", map->rows},
                        {"label", map->label},
                        {"none", map->none_label},
                        {"values", values}};
        return panel;
    }
    for (const auto& curve : plot.curves)
        if (curve.background == Background::none)
            curves.push_back({{"label", curve.label},
                              {"right", curve.right},
                              {"x", fmt::format("{:.9g}", fmt::join(curve.x, " "))},
                              {"y", fmt::format("{:.6g}", fmt::join(curve.y, " "))}});
    return panel;
}

/// The data URL of the smaller picture: SVG is large if it shows clouds of points. Each cell of a coarse map is to be
/// seen.
std::string picture_url(const FigurePreset& figure, const std::vector<Plot>& panels, const Page& page) {
    const bool is_coarse =
        std::ranges::any_of(panels, [](const Plot& plot) { return plot.map && plot.map->columns <= 256; });
    const double width_pt = layout_of(figure.chart).width_pt;
    auto svg = page_file(page, PictureFormat::svg, width_pt, {{"title", figure.title}});
    constexpr std::string_view image = "<image ";
    for (std::size_t at = 0; is_coarse && (at = svg.find(image, at)) != std::string::npos;)
        svg.insert(at += image.size(), "image-rendering=\"pixelated\" ");
    const auto png = png_bytes(picture_of(page));
    return svg.size() <= png.size() ? data_url("image/svg+xml", svg) : data_url("image/png", png);
}

/// Where its texts begin and end, with a margin, in units of its items: square panels do not fill the height of a page.
std::pair<float, float> used_height(const Page& page) {
    const float width = static_cast<float>(page.size.width) / page.scale, margin = 0.02f * width;
    float top = static_cast<float>(page.size.height) / page.scale, bottom = 0;
    for (const auto& item : page.items)
        if (const auto* text = std::get_if<Label>(&item)) {
            top = std::min(top, text->anchor.y - text->size - margin);
            bottom = std::max(bottom, text->anchor.y + 0.3f * text->size + margin);
        }
    return {std::max(std::round(top), 0.0f), std::round(bottom)};
}

constexpr int tile = 256;  // pixels per side

/// A rectangle of a picture; outside the picture it is transparent.
Picture part_of(const Picture& picture, int left, int top, Size size) {
    Picture part(size);
    const int wide = std::min(size.width, picture.size.width - left);
    for (int y = 0; y < std::min(size.height, picture.size.height - top); ++y)
        std::copy_n(picture.at(left, top + y), 4 * static_cast<std::size_t>(wide), part.at(0, y));
    return part;
}

/// The colour bar from its lower end, and its labels: [share of the bar, text].
Json scale_json(const HeatMap& map, const Theme& theme) {
    constexpr int stops = 64;
    MapScale scale(map);
    Json colors = Json::array(), numbers = Json::array();
    for (int i = 0; i <= stops; ++i) colors.push_back(hexadecimal(scale.color(static_cast<double>(i) / stops)));
    scale.axis.to = 380;  // px on the page
    for (const auto& tick : bar_ticks(scale.axis, {.size = 14, .across = false}, map.threshold))
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

std::string figure_page(const FigurePreset& figure, Figure drawn) {
    std::string heading, captions;
    if (!drawn.title.empty())
        heading = fmt::format("<header><h1 dir=\"auto\">{}</h1><p dir=\"auto\">{}</p></header>\n", markup(drawn.title),
                              markup(drawn.subtitle));
    for (const auto& caption : drawn.captions) captions += fmt::format("<p dir=\"auto\">{}</p>\n", markup(caption));
    drawn.title = drawn.subtitle = "";  // they are text of the page
    drawn.captions.clear();
    const auto page = compose_chart(figure.chart, drawn);
    const auto [width, height] =
        std::pair(static_cast<float>(page.size.width) / page.scale, static_cast<float>(page.size.height) / page.scale);
    const auto [top, end] = used_height(page);
    const float bottom = std::min(end, height);
    HtmlPage whole{.kind = "figure"};
    auto keys = Json::array();
    if (auto releases = figure.experiment->releases()) {
        constexpr Rational longest_s{60, 1};
        auto& duration = releases->pair.duration_s;
        if (duration.value() > longest_s.value()) duration = longest_s;
        if (auto player = film_player(make_scene(releases->pair))) whole = std::move(*player), keys = releases->keys;
    }
    whole.body = fmt::format(R"html({0}<main>
<div id="frame"><div id="figure" tabindex="0" role="application" aria-label="{1}: arrow keys move through its numbers">
<img src="{2}" width="{3}" height="{4}" alt="{1}"/>
<svg viewBox="0 {9} {3} {10}" aria-hidden="true"><rect/></svg>
<output></output>
</div></div>
</main>
<footer>{5}<p>Point at the figure, or use arrow keys, with Shift in larger steps.{6}{7}</p></footer>
{8})html",
                             heading, markup(figure.title), picture_url(figure, drawn.panels, page), width, height,
                             captions, drawn.panels.size() > 1 ? " Page Up and Page Down change the panel." : "",
                             keys.empty() ? "" : " A click or Enter releases the pendulum there.", whole.body, top,
                             bottom - top);
    const auto file = [](std::string_view name) { return embedded_file(figure_files(), name); };
    whole.kind = "figure";
    whole.title = figure.title;
    whole.styles.insert(whole.styles.begin(), file("figure/page.css"));
    whole.scripts.insert(whole.scripts.begin(), file("figure/page.js"));
    whole.data["size"] = {width, bottom - top};
    whole.data["above"] = top;
    whole.data["release"] = keys;
    whole.data["panels"] = Json::array();
    for (std::size_t i = 0; i < drawn.panels.size(); ++i)
        whole.data["panels"].push_back(panel_json(drawn.panels[i], page.panels[i]));
    return page_text(whole);
}

void require_map(const FigurePreset& figure) {
    const auto map = figure.experiment->map();
    if (!map || map->panels > 1)
        throw bad_input("{}: --tiles are of one map, kind = \"grid\" with [grid.x] and [grid.y] alone", figure.name);
}

Json write_tiles(const FigurePreset& figure, const Figure& page, Transaction& files, int jobs,
                 const std::atomic<bool>& stop) {
    require_map(figure);
    const auto& theme = figure.chart.colors();
    const auto& plot = page.panels.front();
    const auto name = figure.name + ".tiles", html = figure.name + ".html";
    const auto folder = files.directory(name);
    // the first level fits into one tile; each further level has twice as many pixels per side
    std::vector<Picture> levels{cell_picture(*plot.map, theme)};
    while (std::max(levels[0].size.width, levels[0].size.height) > tile)
        levels.insert(levels.begin(), halved(levels[0]));
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
