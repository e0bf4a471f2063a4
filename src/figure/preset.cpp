#include "figure/preset.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace doppel {
namespace {

constexpr double pt_per_cm = 72 / 2.54, cm_per_inch = 2.54;
constexpr double most_growth = 5;                 // of the height, where only the width on paper is given
constexpr double label_px = 20;                   // text size of labels for unit 1 (plot/panel.hpp), layout px
constexpr double paths_scale = 4;                 // for output made of paths
constexpr double page_scale = 2;                  // for a page, whose picture may be pixels
constexpr double smallest = 16, largest = 16384;  // px; more than any OpenGL supports, which reports its own limit

/// Checks that the picture can be made, with space for its text.
void check_chart(const TomlReader& table, const ChartSpec& chart) {
    const auto layout = layout_of(chart);
    const auto [width, height] = layout.picture;
    const double height_pt = layout.width_pt * height / width * (chart.height_cm ? 1 : most_growth);
    // in text heights: the smallest chart with space for axes, labels and a curve
    constexpr double min_width = 12, min_height = 10;
    if (const double maximum = std::min(layout.width_pt / min_width, height_pt / min_height);
        chart.width_cm && chart.font_pt > maximum)
        throw table.error("font_pt", "is too large for a chart of {:.3g}{}; at most {:g} pt is possible; it is {:g}",
                          *chart.width_cm, chart.height_cm ? fmt::format("×{:.3g} cm", *chart.height_cm) : " cm width",
                          std::floor(10 * maximum) / 10, chart.font_pt);
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

void chart_fields(KeyVisitor& visit, ChartSpec& chart) {
    const bool on_paper = chart.width_cm.has_value();
    const auto of_paper = [&](std::string_view what) {
        return Condition{on_paper, fmt::format("{}; it needs width_cm", what), true, "width_cm"};
    };
    visit({"format", "format of the picture: pixels, text and lines for a paper, or a page that tells the numbers"},
          chart.format);
    auto size = size_field;
    size.only = {!on_paper || !chart.height_cm, "is for a size in pixels; width_cm and height_cm set it", true};
    visit(size, chart.size);
    visit(theme_field, chart.theme);
    const Condition of_pixels{!on_paper, "is for a size in pixels; with width_cm, dpi sets it"};
    const auto sizes_cm = from_to(2, 200);
    constexpr Bounds scales{.low = 0, .high = 8, .is_open = true};
    visit({"width_cm", "width on paper", "cm", sizes_cm, "none: as wide as `size`"}, chart.width_cm);
    visit({"height_cm", "height on paper", "cm", sizes_cm, "in proportion, as `size`",
           of_paper("is the height on paper")},
          chart.height_cm);
    visit({"font_pt", "text on paper, with `width_cm`", "pt", from_to(4, 40), "",
           of_paper("is the size of text on paper")},
          chart.font_pt);
    visit({"dpi", "pixels an inch of a PNG, with `width_cm`", "", from_to(72, 1200), "",
           of_paper("is the resolution on paper")},
          chart.dpi);
    visit({"scale", "picture pixels to a pixel of `size`: 2 for print", "", scales, "", of_pixels}, chart.scale);
    visit({.key = "title",
           .help = "text in place of title and subtitle, one or a list of both; `false`: none",
           .is_drawn = true},
          chart.title);
    visit(
        {.key = "captions", .help = "text in place of the captions below the picture; `false`: none", .is_drawn = true},
        chart.captions);
}

ChartLayout layout_of(const ChartSpec& chart, double growth) {
    double width = chart.size.width, height = chart.size.height, pt = pt_per_px, scale = chart.scale;
    if (chart.width_cm) {
        const double high = chart.height_cm.value_or(growth * *chart.width_cm * height / width);
        pt = chart.font_pt / label_px;
        width = *chart.width_cm * pt_per_cm / pt, height = high * pt_per_cm / pt;
        scale = chart.dpi / cm_per_inch * *chart.width_cm / width;
    }
    // all formats have the same layout: the grid of paths is some times finer than that of the PNG
    const double finest = chart.format == PictureFormat::png    ? scale
                          : chart.format == PictureFormat::html ? page_scale
                                                                : paths_scale;
    const int finer = static_cast<int>(std::max(std::ceil(finest / scale), 1.0));
    ChartLayout layout{.picture = {finer * static_cast<int>(std::lround(width * scale)),
                                   finer * static_cast<int>(std::lround(height * scale))},
                       .scale = static_cast<float>(finer * scale),
                       .width_pt = width * pt};
    if (chart.width_cm) layout.unit = 1;
    return layout;
}

Page compose_chart(const ChartSpec& chart, const Figure& figure) {
    // px, where labels have 20
    const float readable_width = std::ranges::any_of(figure.panels, &Plot::square) ? 160 : 120;
    constexpr float readable_height = 90;
    std::optional<Page> best;
    std::size_t fewest = 0;
    for (double growth = 1;; growth += 0.1) {
        const auto layout = layout_of(chart, growth);
        auto made = compose(figure, layout.picture, chart.colors(), layout.scale, layout.unit);
        const bool is_readable = have_sides(made.panels, readable_width, readable_height);
        const std::size_t faults = made.notes.size() + (is_readable ? 0 : 1);
        if (!best || faults < fewest) best = std::move(made), fewest = faults;
        const bool may_grow = chart.width_cm && !chart.height_cm && growth < most_growth;
        if (fewest == 0 || !may_grow) return std::move(*best);
    }
}

void read_chart(TomlReader& table, ChartSpec& chart) {
    // the meaning of other keys depends on these
    if (table.has("width_cm")) chart.width_cm = 0;
    if (table.has("height_cm")) chart.height_cm = 0;
    chart_fields(table, chart);
    table.finish();
    table.check_together([&] { check_chart(table, chart); });
}

void top_fields(KeyVisitor& visit, FigurePreset& figure) {
    visit(title_field, figure.title);
    visit({.key = "subtitle",
           .help = "below the title",
           .absent = "of pairs: the system and the integrator",
           .is_drawn = true},
          figure.subtitle);
    visit(
        {.key = "erratum", .help = "below the picture: where a printed caption and the truth differ", .is_drawn = true},
        figure.erratum);
    visit({.key = "captions", .help = "below the picture", .is_drawn = true}, figure.captions);
}

namespace {

/// With `errors`, reads each key by itself and throws all errors found. Otherwise reads the figure and checks keys
/// together.
FigurePreset read_once(const PresetText& source, const TomlDocument& document, KeyErrors* errors,
                       const std::atomic<bool>& stop) {
    FigurePreset figure;
    figure.name = figure.title = source.name;
    auto top = document.top(errors);
    top.require_title(figure.name);
    top_fields(top, figure);
    auto scene = top.inner("scene");
    figure.kind = read_kind(scene, source, false);
    auto chart = top.inner("chart");
    FigureReader reader{source.name, top, scene, chart, stop, errors != nullptr};
    const auto& kind = *std::ranges::find(figure_kinds(), figure.kind, &FigureKind::name);
    try {
        figure.experiment = kind.read(reader);
    } catch (KeyError& error) {
        if (!errors) throw;
        error.group.clear();
        top.refuse(error.with({}));
        errors->throw_if_any();
    }
    if (!errors && !top.has("subtitle")) figure.subtitle = figure.experiment->subtitle();
    scene.finish();
    read_chart(chart, figure.chart);
    top.finish();
    if (errors) errors->throw_if_any();
    return figure;
}

}  // namespace

std::string FigurePreset::resolved_work() const {
    return fmt::format("[scene]\nkind = {}\n{}", toml_text(kind), experiment->resolved());
}

std::string FigurePreset::resolved() const {
    TomlWriter writer;
    auto own = chart;
    chart_fields(writer, own);
    return fmt::format("title = {}\nsubtitle = {}\ncaptions = {}\nerratum = {}\n\n{}{}", toml_text(title),
                       toml_text(subtitle), toml_value(captions), toml_text(erratum), resolved_work(), writer.text());
}

FigurePreset read_figure(const PresetText& source, const std::vector<Override>& overrides,
                         const std::atomic<bool>& stop) {
    const auto document = parse_document(source, overrides);
    KeyErrors errors;
    read_once(source, document, &errors, stop);
    auto figure = read_once(source, document, nullptr, stop);
    const auto is_set = [&](std::string_view key) { return std::ranges::count(overrides, key, &Override::key) > 0; };
    // the preset's texts are about its own quantity and axis
    if (is_set("grid.quantity") || is_set("grid.x") || is_set("grid.x.key")) {
        if (!is_set("title")) figure.title = figure.name;
        if (!is_set("subtitle")) figure.subtitle = figure.experiment->subtitle();
        if (!is_set("captions")) figure.captions.clear();
        if (!is_set("erratum")) figure.erratum.clear();
    }
    return figure;
}

}  // namespace doppel
