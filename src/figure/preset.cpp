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
                       std::span<const ExternalMethod> external_methods, const std::atomic<bool>& stop) {
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
    FigureReader reader{source.name, document, top, scene, chart, external_methods, stop, errors != nullptr};
    const auto& kind = *std::ranges::find(figure_kinds(), figure.kind, &FigureKind::name);
    try {
        figure.experiment = kind.read(reader);
    } catch (const KeyError& error) {
        if (!errors) throw;
        top.refuse(error.with({}), "");
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
                         std::span<const ExternalMethod> external_methods, const std::atomic<bool>& stop) {
    const auto document = parse_document(source, overrides);
    KeyErrors errors(overrides);
    read_once(source, document, &errors, external_methods, stop);
    return read_once(source, document, nullptr, external_methods, stop);
}

std::vector<FieldTable> tables_of(std::string_view kind) {
    using System = FigureKind::System;
    const auto film = film_tables();
    const auto figure = std::ranges::find(figure_kinds(), kind, &FigureKind::name);
    const bool is_film = kind == pair_kind, has_pair = is_film || figure->system == System::pair;
    std::vector<FieldTable> all{is_film ? film[0] : FieldTable(), film[1]};
    all[0].name = "[]";
    FigurePreset none;
    if (!is_film) {
        top_fields(all[0], none);
        std::erase_if(all[1].fields, [&](const ListedField& field) {  // only for films, or for pairs
            return field.key.ends_with("_columns") || field.key == "certify" ||
                   (!has_pair && field.key != kind_field.key);
        });
    }
    for (const std::string_view key : {"system", "a", "b"}) {
        if (!has_pair) break;
        all.emplace_back(film[2]).name = fmt::format("[{}]", key);
        if (is_film && key != "system") all.back().append(side_text_table());
    }
    if (is_film) {
        all.push_back(film.back());
        return all;
    }
    if (SideSpec side; figure->system == System::release) {
        auto& chain = all.emplace_back("[system]");
        chain_fields(chain, side);
        gravity_field(chain, side);
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
