#include "figure/preset.hpp"

#include "figure/kinds.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// The keys outside of tables.
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

std::vector<FieldTable> tables_of(std::string_view kind) {
    using System = FigureKind::System;
    const auto figure = std::ranges::find(figure_kinds(), kind, &FigureKind::name);
    const bool is_film = kind == pair_kind, has_pair = is_film || figure->system == System::pair;
    std::vector<FieldTable> all;
    Preset preset;
    FigurePreset none;
    auto& top = all.emplace_back("[]");
    if (is_film) {
        top(title_field, preset.title);
        top(subtitle_field, preset.subtitle);
    } else {
        top_fields(top, none);
    }
    auto& scene = all.emplace_back("[scene]");
    scene(kind_field, std::string(pair_kind));
    if (is_film)
        film_fields(scene, preset);
    else if (has_pair)
        clock_fields(scene, preset);
    for (const auto* name : {"[system]", "[a]", "[b]"}) {
        if (!has_pair) break;
        auto& side = all.emplace_back(name);
        side.is_widest = true;
        side_fields(side, preset.a);
        if (is_film && side.key() != "system") side_text_fields(side, preset.a);
    }
    if (is_film) {
        auto& video = all.emplace_back("[video]");
        video.is_widest = true;
        video(size_field, preset.video.size);
        video(preview_field, false);
        video_fields(video, preset.video);
        return all;
    }
    if (figure->system == System::release) {
        auto& chain = all.emplace_back("[system]");
        chain_fields(chain, preset.a);
        gravity_field(chain, preset.a);
    }
    chart_fields(all.emplace_back("[chart]"), none.chart);
    for (auto& table : figure->tables())
        if (table.key() == "chart")
            all.back().fields.insert(all.back().fields.end(), table.fields.begin(), table.fields.end());
        else
            all.insert(all.end() - 1, std::move(table));
    return all;
}

}  // namespace doppel
