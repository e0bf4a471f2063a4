#include "figure/preset.hpp"

#include "figure/kinds.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {

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
    auto scene = document.table(top, "scene");
    figure.kind = read_kind(scene);
    if (errors && errors->concern("scene"))
        errors->throw_if_any();  // without the kind it is unknown which tables are allowed
    if (figure.kind == pair_kind)
        throw bad_input("{}: this is a film, not a figure; make it with: doppel render {}", source.path, source.call);
    auto chart = document.table(top, "chart");
    FigureReader reader{source.name, document, top, scene, chart, stop, errors != nullptr};
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
    return fmt::format("[scene]\nkind = {}\n{}\n[chart]\n{}", toml_text(kind), experiment->resolved(),
                       experiment->resolved_chart());
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
    KeyErrors errors(overrides);
    read_once(source, document, &errors, stop);
    return read_once(source, document, nullptr, stop);
}

}  // namespace doppel
