#include "figure/preset.hpp"

#include "figure/kinds.hpp"
#include "scene/resolved.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

void read_chart(TomlReader& table, ChartSpec& chart) {
    read_picture_size(table, chart.size);
    read_theme(table, chart.theme);
    table.read_positive("scale", chart.scale);
    constexpr double most = 8;
    if (chart.scale > most) throw table.fault("scale", "must be at most {}; it is {}", most, chart.scale);
    constexpr double smallest = 16, largest = 16384;  // px; more than any OpenGL takes, which says so itself
    const double width = chart.scale * chart.size.width, height = chart.scale * chart.size.height;
    if (std::min(width, height) < smallest || std::max(width, height) > largest)
        throw table.fault("scale", "must leave a picture of {} to {} px a side; {:g} times {}×{} px is {:g}×{:g}",
                          smallest, largest, chart.scale, chart.size.width, chart.size.height, width, height);
    table.finish();
}

}  // namespace

Size FigurePreset::picture_size() const {
    const auto scaled = [&](int pixels) { return static_cast<int>(std::lround(pixels * chart.scale)); };
    return {scaled(chart.size.width), scaled(chart.size.height)};
}

std::string FigurePreset::resolved_work() const {
    return fmt::format("[scene]\nkind = {}\n{}\n[chart]\n{}", toml_text(kind), work->resolved(),
                       work->resolved_chart());
}

std::string FigurePreset::resolved() const {
    std::vector<std::string> quoted;
    for (const auto& caption : captions) quoted.push_back(toml_text(caption));
    return fmt::format(
        "title = {}\nsubtitle = {}\ncaptions = [{}]\nerratum = {}\n\n{}size = [{}, {}]\ntheme = {}\nscale = "
        "{}\n",
        toml_text(title), toml_text(subtitle), fmt::join(quoted, ", "), toml_text(erratum), resolved_work(),
        chart.size.width, chart.size.height, toml_text(chart.theme), chart.scale);
}

FigurePreset read_figure(const PresetText& source, const std::vector<Override>& overrides,
                         std::span<const ExternalMethod> external_methods) {
    const auto document = parse_document(source, overrides);
    FigurePreset figure;
    figure.name = figure.title = source.name;
    TomlReader top(&document.root, "", document.path, document.texts);
    top.read_drawn_title(figure.title);
    top.read_drawn("subtitle", figure.subtitle);
    top.read_drawn("erratum", figure.erratum);
    if (const auto captions = top.read_texts("captions")) figure.captions = *captions;
    for (const auto& caption : figure.captions) top.demand_drawable("captions", caption);

    auto scene = document.table(top, "scene");
    figure.kind = read_kind(scene);
    if (figure.kind == pair_kind)
        throw bad_input("{}: this is a film, not a figure; make it with: doppel render {}", source.path, source.call);
    auto chart = document.table(top, "chart");
    FigureReader reader{source.name, document, top, scene, chart, external_methods};
    for (const auto& kind : figure_kinds())
        if (kind.name == figure.kind) figure.work = kind.read(reader);
    if (!top.has("subtitle")) figure.subtitle = figure.work->subtitle();
    scene.finish();
    read_chart(chart, figure.chart);
    top.finish();
    return figure;
}

}  // namespace doppel
