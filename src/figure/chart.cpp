#include "figure/chart.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

constexpr double pt_per_cm = 72 / 2.54, cm_per_inch = 2.54;
constexpr double label_px = 20;                   // text size of labels for unit 1 (plot/chart_parts.hpp), layout px
constexpr double paths_scale = 4;                 // for output made of paths
constexpr double page_scale = 2;                  // for a page, whose picture may be pixels
constexpr double smallest = 16, largest = 16384;  // px; more than any OpenGL supports, which reports its own limit

Size scaled(double width, double height, double scale) {
    return {static_cast<int>(std::lround(width * scale)), static_cast<int>(std::lround(height * scale))};
}

}  // namespace

ChartLayout layout_of(const ChartSpec& chart) {
    double width = chart.size.width, height = chart.size.height, pt = pt_per_px, scale = chart.scale;
    if (chart.width_cm) {
        const double high = chart.height_cm.value_or(*chart.width_cm * height / width);
        pt = chart.font_pt / label_px;
        width = *chart.width_cm * pt_per_cm / pt, height = high * pt_per_cm / pt;
        scale = chart.dpi / cm_per_inch * *chart.width_cm / width;
    }
    if (chart.format != PictureFormat::png) scale = chart.format == PictureFormat::html ? page_scale : paths_scale;
    ChartLayout layout{
        .picture = scaled(width, height, scale), .scale = static_cast<float>(scale), .width_pt = width * pt};
    if (chart.width_cm) layout.unit = 1;
    return layout;
}

namespace {

/// Checks that the picture can be made, with space for its text.
void check_chart(const TomlReader& table, const ChartSpec& chart) {
    const auto layout = layout_of(chart);
    const auto [width, height] = layout.picture;
    const double height_pt = layout.width_pt * height / width;
    // in text heights: the smallest chart with space for axes, labels and a curve
    constexpr double min_width = 12, min_height = 10;
    if (const double maximum = std::min(layout.width_pt / min_width, height_pt / min_height);
        chart.width_cm && chart.font_pt > maximum)
        throw table.error("font_pt",
                          "is too large for a chart of {:.3g}×{:.3g} cm; at most {:.2g} pt is possible; it is {:g}",
                          layout.width_pt / pt_per_cm, height_pt / pt_per_cm, maximum, chart.font_pt);
    if (std::min(width, height) < smallest || std::max(width, height) > largest) {
        const auto what = chart.width_cm
                              ? fmt::format("{:g} cm at {} dpi", *chart.width_cm, chart.dpi)
                              : fmt::format("{:g} times {}×{} px", chart.scale, chart.size.width, chart.size.height);
        throw table.error(chart.width_cm ? "width_cm" : "scale",
                          "must leave a picture of {} to {} px a side; {} is {}×{} px", smallest, largest, what, width,
                          height);
    }
}

}  // namespace

void read_chart(TomlReader& table, ChartSpec& chart) {
    // the meaning of other keys depends on this one
    table({.key = "width_cm"}, chart.width_cm.emplace(0));
    if (!table.has("width_cm")) chart.width_cm.reset();
    chart_fields(table, chart);
    table.finish();
    table.check_together([&] { check_chart(table, chart); });
}

}  // namespace doppel
