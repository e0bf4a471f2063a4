#pragma once

#include "scene/preset_fields.hpp"

#include <optional>
#include <string>

namespace doppel {

/// [chart]: how a figure is drawn.
struct ChartSpec {
    PictureFormat format = PictureFormat::png;
    Size size{1600, 900};
    std::string theme = "light";
    double scale = 1;                           // picture pixels per layout pixel: 2 for print
    std::optional<double> width_cm, height_cm;  // size on paper
    double font_pt = 8;
    int dpi = 300;
    ChosenText title, captions;
};

/// How a chart is laid out (plot/plot.hpp) and written.
struct ChartLayout {
    Size picture;               // px
    float scale = 1;            // picture pixels per layout pixel
    std::optional<float> unit;  // of text and lines, layout pixels; from the picture's size if not given
    double width_pt = 0;        // width on paper, 1/72 inch
};

/// With a size on paper, labels are `font_pt` high and a PNG has `dpi` pixels per inch. Otherwise a layout pixel is 3/4
/// pt. Output made of paths is laid out on a grid too fine to see.
ChartLayout layout_of(const ChartSpec& chart);

/// The keys of [chart] common to all figures.
template <class Visit, class Chart>
void chart_fields(Visit& visit, Chart& chart) {
    const bool on_paper = chart.width_cm.has_value();
    const auto of_paper = [&](std::string_view what) {
        return Condition{on_paper, fmt::format("{}; it needs width_cm", what), true, false, "width_cm"};
    };
    visit({"format", "format of the picture: pixels, text and lines for a paper, or a page that tells the numbers"},
          chart.format);
    visit(size_field, chart.size);
    visit(theme_field, chart.theme);
    visit({.key = "width_cm",
           .help = "width on paper",
           .unit = "cm",
           .bounds = {.low = 2, .high = 200},
           .absent = "none: as wide as `size`"},
          chart.width_cm);
    visit({.key = "height_cm",
           .help = "height on paper",
           .unit = "cm",
           .bounds = {.low = 2, .high = 200},
           .absent = "in proportion, as `size`",
           .only = of_paper("is the height on paper")},
          chart.height_cm);
    visit({.key = "font_pt",
           .help = "text on paper, with `width_cm`",
           .unit = "pt",
           .bounds = {.low = 4, .high = 40},
           .only = of_paper("is the size of text on paper")},
          chart.font_pt);
    visit({.key = "dpi",
           .help = "pixels an inch of a PNG, with `width_cm`",
           .bounds = {.low = 72, .high = 1200},
           .only = of_paper("is the resolution on paper")},
          chart.dpi);
    visit({"scale",
           "picture pixels to a pixel of `size`: 2 for print",
           "",
           {.low = 0, .high = 8, .is_open = true},
           "",
           Condition{!on_paper, "is for a size in pixels; with width_cm, dpi sets it"}},
          chart.scale);
    visit({.key = "title",
           .help = "text in place of title and subtitle, one or a list of both; `false`: none",
           .is_drawn = true},
          chart.title);
    visit(
        {.key = "captions", .help = "text in place of the captions below the picture; `false`: none", .is_drawn = true},
        chart.captions);
}

/// Reads and checks the keys above. Throws Error (exit 2).
void read_chart(TomlReader& table, ChartSpec& chart);

}  // namespace doppel
