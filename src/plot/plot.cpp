#include "plot/plot.hpp"

#include "plot/chart_parts.hpp"
#include "plot/labels.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

/// One line of at most `width` px if possible. It is shrunk, on paper to the size of labels, otherwise to three quarters
/// but not below 9 px, then broken.
TextBlock fitted_block(std::string_view text, float size, Weight weight, Color color, float width,
                       const PlotStyle& style) {
    if (text.empty()) return {{}, size, weight, color};
    const float minimum = style.on_paper ? style.text : std::max(0.75f * size, 9.0f);
    const float shrunk = std::max(fitting_size(text, size, weight, width), std::min(size, minimum));
    return {evenly_wrapped(text, shrunk, weight, width), shrunk, weight, color};
}

/// The texts above and below the panels, and the area between.
struct Layout {
    TextBlock title, subtitle;
    std::vector<TextBlock> captions;
    Area body;
    float captions_top = 0;
    std::vector<std::string_view> left_out;  // for lack of space
};

/// Whether the contents of the body are large enough to read.
bool legible(const Figure& figure, const Area& body, const Area& sheet, const PlotStyle& style) {
    if (figure.panels.empty()) return body.height() >= 0;
    const auto rows = static_cast<float>(grid_of(figure, body).rows);
    return body.height() >= std::max(0.5f * sheet.height(), (style.on_paper ? 9.5f : 12.5f) * style.tick * rows);
}

/// Whether the panels have space besides their labels and ticks.
bool has_room(const Figure& figure, const Area& body, const PlotStyle& style) {
    if (figure.panels.empty()) return true;
    const auto [columns, rows] = grid_of(figure, body);
    return body.height() >= (style.on_paper ? 7 : 13) * style.tick * static_cast<float>(rows) &&
           body.width() >= 9 * style.tick * static_cast<float>(columns);
}

/// The layout with all text if that leaves the panels enough space; otherwise without captions, or also without
/// subtitle.
Layout figure_layout(const Figure& figure, const Area& sheet, const PlotStyle& style) {
    Layout page;
    const Theme& theme = style.theme;
    const float width = sheet.width();
    for (const auto& [subtitle, captions] : {std::pair{true, true}, {true, false}, {false, false}}) {
        page = {};
        page.title = fitted_block(figure.title, style.title, Weight::bold, theme.text, width, style);
        page.subtitle = fitted_block(subtitle ? figure.subtitle : "", style.subtitle, Weight::regular, theme.quiet_text,
                                     width, style);
        page.body = sheet;
        page.body.top += page.title.height() + page.subtitle.height();
        if (page.body.top > sheet.top) page.body.top += 0.75f * style.subtitle;
        float height = 0;
        for (const std::string& caption : figure.captions) {
            if (!captions) break;
            page.captions.push_back({evenly_wrapped(caption, style.caption, Weight::regular, width), style.caption,
                                     Weight::regular, theme.quiet_text});
            height += page.captions.back().height();
        }
        page.captions_top = sheet.bottom - height;
        if (height > 0) page.body.bottom = page.captions_top - 0.9f * style.caption;
        if (legible(figure, page.body, sheet, style)) break;
    }
    if (page.subtitle.lines.empty() && !figure.subtitle.empty()) page.left_out.emplace_back("the subtitle");
    if (page.captions.empty() && !figure.captions.empty()) page.left_out.emplace_back("the captions");
    return page;
}

}  // namespace

float smallest_side(const std::vector<PlotRanges>& panels) {
    float smallest = std::numeric_limits<float>::infinity();
    for (const auto& [x, y, right] : panels) smallest = std::min({smallest, x.to - x.from, y.from - y.to});
    return smallest;
}

Page compose(const Figure& figure, Size size, const Theme& theme, float scale, std::optional<float> unit) {
    Page made{.size = size, .scale = scale, .items = {}};
    for (;; made.scale *= 0.8f) {
        const float width = static_cast<float>(size.width) / made.scale;
        const float height = static_cast<float>(size.height) / made.scale;
        // text smaller than that of an 800 × 450 picture cannot be read
        const float by_size = std::max(std::min(width / 1600, height / 900), 0.5f);
        const PlotStyle style{
            .theme = theme, .unit = unit.value_or(by_size), .scale = made.scale, .on_paper = unit.has_value()};
        // a page has its own margins
        const float across = std::round((style.on_paper ? 8 : 34) * style.unit);
        const float down = std::round((style.on_paper ? 8 : 28) * style.unit);
        const Area sheet{across, down, width - across, height - down};
        const Layout page = figure_layout(figure, sheet, style);
        // with many panels in a small picture, shrinks the text to leave space for the panels
        constexpr float min_scale = 0.1f;
        if (!has_room(figure, page.body, style) && made.scale > min_scale) continue;

        made.items = {Box{0, 0, width, height, 0, theme.background}};
        page.title.draw({sheet.left, sheet.top}, made.items);
        page.subtitle.draw({sheet.left, sheet.top + page.title.height()}, made.items);
        if (!figure.panels.empty()) made.panels = draw_panels(figure, page.body, style, made.items);
        if (smallest_side(made.panels) < drawn_side && made.scale > min_scale) continue;
        float top = page.captions_top;
        for (const TextBlock& caption : page.captions) {
            caption.draw({sheet.left, top}, made.items);
            top += caption.height();
        }
        if (!page.left_out.empty())
            made.notes.push_back(fmt::format("there is no space for {}", fmt::join(page.left_out, " and ")));
        if (unit && made.scale < scale)
            made.notes.push_back(
                fmt::format("text is reduced to {:.2g} times its size for lack of space", made.scale / scale));
        return made;
    }
}

}  // namespace doppel
