#include "plot/plot.hpp"

#include "base/error.hpp"
#include "plot/chart_parts.hpp"
#include "plot/labels.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// What stands above and below the panels, and the room between.
struct Page {
    TextBlock title, subtitle;
    std::vector<TextBlock> captions;
    Area body;
    float captions_top = 0;
};

Page laid_out(const Figure& figure, const Area& sheet, const PlotStyle& style, bool subtitle, bool captions) {
    Page page;
    const Theme& theme = style.theme;
    const float width = sheet.width();
    page.title = fitted_block(figure.title, style.title, Weight::bold, theme.text, width);
    page.subtitle =
        fitted_block(subtitle ? figure.subtitle : "", style.subtitle, Weight::regular, theme.quiet_text, width);
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
    return page;
}

/// Whether what stands in the body can be read there.
bool legible(const Figure& figure, const Area& body, const Area& sheet, const PlotStyle& style) {
    if (figure.panels.empty()) return body.height() >= 0;
    const auto rows = static_cast<float>(grid_of(figure, body).rows);
    return body.height() >= std::max(0.5f * sheet.height(), 12.5f * style.tick * rows);
}

/// Whether the panels have room besides their labels and ticks.
bool has_room(const Figure& figure, const Area& body, const PlotStyle& style) {
    if (figure.panels.empty()) return true;
    const auto [columns, rows] = grid_of(figure, body);
    return body.height() >= 13 * style.tick * static_cast<float>(rows) &&
           body.width() >= 9 * style.tick * static_cast<float>(columns);
}

/// With all text where it leaves the panels enough room, else without captions, else without subtitle.
Page laid_out(const Figure& figure, const Area& sheet, const PlotStyle& style) {
    for (const auto& [subtitle, captions] : {std::pair{true, true}, {true, false}}) {
        Page page = laid_out(figure, sheet, style, subtitle, captions);
        if (legible(figure, page.body, sheet, style)) return page;
    }
    return laid_out(figure, sheet, style, false, false);
}

/// Every length `scale` times as long.
struct Enlarge {
    float scale;

    Point at(Point p) const { return {scale * p.x, scale * p.y}; }
    void operator()(Box& box) const {
        for (float* length : {&box.left, &box.top, &box.right, &box.bottom, &box.corner}) *length *= scale;
    }
    void operator()(Capsule& capsule) const {
        capsule = {at(capsule.from), at(capsule.to), scale * capsule.radius, capsule.color};
    }
    void operator()(Ring& ring) const { ring = {at(ring.center), scale * ring.radius, scale * ring.width, ring.color}; }
    void operator()(Stroke& stroke) const {
        for (Stroke::Vertex& vertex : stroke.vertices) vertex.at = at(vertex.at);
        stroke.width *= scale;
    }
    void operator()(Label& label) const {
        label.anchor = at(label.anchor);
        label.size *= scale;
    }
    void operator()(Image& image) const {
        for (float* length : {&image.left, &image.top, &image.right, &image.bottom}) *length *= scale;
    }
};

}  // namespace

DisplayList compose(const Figure& figure, Size size, const Theme& theme, float scale, std::optional<float> unit) {
    if (!(scale > 0 && std::isfinite(scale)))
        throw bad_input("the scale of a figure must be more than 0; it is {}", scale);
    check(figure);
    const float width = static_cast<float>(size.width) / scale, height = static_cast<float>(size.height) / scale;
    // smaller text than that of 800 × 450 cannot be read
    const float by_size = std::max(std::min(width / 1600, height / 900), 0.5f);
    const PlotStyle style{.theme = theme, .unit = unit.value_or(by_size), .scale = scale};
    const float across = std::round(34 * style.unit), down = std::round(28 * style.unit);
    const Area sheet{across, down, width - across, height - down};
    const Page page = laid_out(figure, sheet, style);
    // many panels in a small picture: smaller text rather than no room for panels
    constexpr float least_scale = 0.1f;
    if (!has_room(figure, page.body, style) && scale > least_scale)
        return compose(figure, size, theme, 0.8f * scale, unit);

    DisplayList list{Box{0, 0, width, height, 0, theme.background}};
    page.title.draw({sheet.left, sheet.top}, list);
    page.subtitle.draw({sheet.left, sheet.top + page.title.height()}, list);
    if (!figure.panels.empty()) draw_panels(figure, page.body, style, list);
    float top = page.captions_top;
    for (const TextBlock& caption : page.captions) {
        caption.draw({sheet.left, top}, list);
        top += caption.height();
    }
    if (scale != 1)
        for (Item& item : list) std::visit(Enlarge{scale}, item);
    return list;
}

}  // namespace doppel
