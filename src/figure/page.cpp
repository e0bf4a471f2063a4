#include "figure/page.hpp"

#include "base/embedded.hpp"
#include "base/text.hpp"
#include "embedded/figure.hpp"
#include "film/page.hpp"
#include "film/page_json.hpp"
#include "output/page.hpp"
#include "output/png.hpp"

#include <fmt/ranges.h>

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

/// The data URL of the smaller picture: SVG is large if it shows clouds of points.
/// `is_coarse`: each cell of its map is to be seen.
std::string picture_url(const FigurePreset& figure, const Page& page, bool is_coarse) {
    const double width_pt = layout_of(figure.chart).width_pt;
    auto svg = page_file(page, PictureFormat::svg, width_pt, {{"title", figure.title}});
    constexpr std::string_view image = "<image ";
    for (std::size_t at = 0; is_coarse && (at = svg.find(image, at)) != std::string::npos;)
        svg.insert(at += image.size(), "image-rendering=\"pixelated\" ");
    const auto png = png_bytes(picture_of(page));
    return svg.size() <= png.size() ? data_url("image/svg+xml", svg) : data_url("image/png", png);
}

}  // namespace

std::string figure_page(const FigurePreset& figure, Figure drawn, const Theme& theme) {
    std::string heading, captions;
    if (!drawn.title.empty())
        heading = fmt::format("<header><h1 dir=\"auto\">{}</h1><p dir=\"auto\">{}</p></header>\n", markup(drawn.title),
                              markup(drawn.subtitle));
    for (const auto& caption : drawn.captions) captions += fmt::format("<p dir=\"auto\">{}</p>\n", markup(caption));
    drawn.title = drawn.subtitle = "";  // they are text of the page
    drawn.captions.clear();
    const auto page = compose_chart(figure.chart, drawn, theme);
    const auto [width, height] =
        std::pair(static_cast<float>(page.size.width) / page.scale, static_cast<float>(page.size.height) / page.scale);
    constexpr int few_cells = 256;
    const bool is_coarse =
        std::ranges::any_of(drawn.panels, [](const Plot& plot) { return plot.map && plot.map->columns <= few_cells; });
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
<svg viewBox="0 0 {3} {4}" aria-hidden="true"><rect/></svg>
<output></output>
</div></div>
</main>
<footer>{5}<p>Point at the figure, or use arrow keys, with Shift in larger steps.{6}{7}</p></footer>
{8})html",
                             heading, markup(figure.title), picture_url(figure, page, is_coarse), width, height,
                             captions, drawn.panels.size() > 1 ? " Page Up and Page Down change the panel." : "",
                             keys.empty() ? "" : " A click or Enter releases the pendulum there.", whole.body);
    const auto file = [](std::string_view name) { return embedded_file(figure_files(), name); };
    whole.kind = "figure";
    whole.title = figure.title;
    whole.styles.insert(whole.styles.begin(), file("figure/page.css"));
    whole.scripts.insert(whole.scripts.begin(), file("figure/page.js"));
    whole.data["size"] = {width, height};
    whole.data["release"] = keys;
    whole.data["panels"] = Json::array();
    for (std::size_t i = 0; i < drawn.panels.size(); ++i)
        whole.data["panels"].push_back(panel_json(drawn.panels[i], page.panels[i]));
    return page_text(whole);
}

}  // namespace doppel
