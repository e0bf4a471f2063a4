#pragma once

#include "figure/kinds.hpp"
#include "image/color.hpp"
#include "plot/plot.hpp"
#include "scene/preset.hpp"
#include "scene/toml_reader.hpp"

#include <algorithm>
#include <memory>
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

    const Theme& colors() const { return *std::ranges::find(themes, theme, &Theme::name); }
};

/// How a chart is laid out (plot/plot.hpp) and written.
struct ChartLayout {
    Size picture;               // px
    float scale = 1;            // picture pixels per layout pixel
    std::optional<float> unit;  // of text and lines, layout pixels; from the picture's size if not given
    double width_pt = 0;        // width on paper, 1/72 inch
};

/// With a size on paper, labels are `font_pt` high and a PNG has `dpi` pixels per inch. Otherwise a layout pixel is 3/4
/// pt. A height that is not given is `growth` times that in proportion.
ChartLayout layout_of(const ChartSpec& chart, double growth = 1);
/// The figure in this layout. Without a height of its own, it is as high on paper as all its texts need, and panels that
/// can be read.
Page compose_chart(const ChartSpec& chart, const Figure& figure);

/// The keys of [chart] common to all figures.
void chart_fields(KeyVisitor& visit, ChartSpec& chart);

/// Reads and checks the keys above. Throws Error (exit 2).
void read_chart(TomlReader& table, ChartSpec& chart);

/// A figure described by a preset file: read, completed and checked, not yet computed.
struct FigurePreset {
    std::string name;             // of the file, without folder and extension
    std::string title, subtitle;  // if not given: the name; the experiment's subtitle
    std::vector<std::string> captions;
    std::string erratum;  // where the study's printed caption is wrong
    std::string kind;     // of [scene]
    ChartSpec chart;
    std::shared_ptr<const Experiment> experiment;

    /// The settings that its numbers depend on, TOML.
    std::string resolved_work() const;
    /// All settings; read_figure() reads this TOML back to the same figure.
    std::string resolved() const;
};

/// The keys outside of tables.
void top_fields(KeyVisitor& visit, FigurePreset& figure);

/// Errors as read_preset(), and exit 130 soon after `stop` is set.
FigurePreset read_figure(const PresetText& source, const std::vector<Override>& overrides = {},
                         const std::atomic<bool>& stop = never_stopped);

}  // namespace doppel
