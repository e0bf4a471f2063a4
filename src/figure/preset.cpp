#include "figure/preset.hpp"

#include "figure/kinds.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace doppel {
namespace {

constexpr std::string_view film_introduction = R"(# Presets: keys of films

After reading this page you can write a preset and look up every key that describes the motion. [presets-video.md](presets-video.md) lists the keys
of pictures, [presets-figures.md](presets-figures.md) those of figures.

A preset is a TOML file. It describes two pendulums and the film of them, or a figure. Every key has a default, and its unit is part of its
name. An unknown key is an error. All errors of a preset are listed at once.

| command | does |
|---|---|
| `doppel init FILE.toml` | writes a preset with every key (`--figure KIND`: of a figure) |
| `doppel show NAME` | prints a preset |
| `doppel check FILE.toml` | says what would run |
| `--set KEY=VALUE` | sets a key on the command line |

Examples of `--set`: `video.theme=light` (text needs no quotes), `system.angle_deg=[90, 60]`, `system.mass_kg[1]=2` (the second of a list),
`system.force.NAME.length_m=1.2` (an entry by its `name`, or by its `kind` if it is the only one).

```toml
title = "Three thousandths of a degree"

[scene]
duration_s = 30

[system]                  # both sides
angle_deg = [90, 90]

[b]                       # the second side, where it differs
angle_deg = [90.003, 90]
```

Keys of `[a]` and `[b]` replace those of `[system]` for one side. An array with one number for each link can also be a single number for
all links. `[[a.particle]]`, `[[a.constraint]]` and `[[a.force]]` change the entry of that `name` in `[system]`; others are added.

Editors with JSON schemas (taplo, Even Better TOML) complete keys and mark errors if the first line names the schema:
`#:schema ./preset.schema.json`, for a file that `doppel schema > preset.schema.json` wrote beside the preset.
)";

constexpr std::string_view video_introduction = R"(# Presets: keys of pictures

After reading this page you can look up every key of `[video]`: format, speed, layout, strips, colours and sizes. [films.md](films.md) shows examples.
)";

constexpr std::string_view figure_introduction = R"(# Presets: keys of figures and grids

After reading this page you can look up the keys that all figures have, and those of grids. [figures.md](figures.md) shows examples. `kind` of `[scene]`
selects the kind of figure. In place of `[video]` a figure has `[chart]` and a table of its own kind; [presets-series.md](presets-series.md) has those
of the other kinds. `[system]`, `[a]` and `[b]` are as in [films](presets.md).
)";

constexpr std::string_view series_introduction = R"(# Presets: keys of series, sections and work-precision diagrams

After reading this page you can look up the keys of these kinds of figures, beside [those of all figures](presets-figures.md).
)";

/// The keys outside of tables.
template <class Visit>
void top_fields(Visit& visit, FigurePreset& figure) {
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

/// [system] of figures that integrate a chain themselves.
FieldTable release_table() {
    SideSpec side;
    FieldTable release{"[system]"};
    chain_fields(release, side, positive);
    gravity_field(release, side);
    return release;
}

/// The description of the system in docs/presets.md.
std::string system_description(FigureKind::System system) {
    using System = FigureKind::System;
    if (system == System::none) return "";
    if (system == System::pair)
        return " What moves: `[system]`, `[a]` and `[b]`, with `duration_s` and `sample_hz` of `[scene]`, as in a "
               "film.";
    std::vector<std::string_view> keys;
    const auto table = release_table();
    for (const auto& field : table.fields) keys.push_back(field.key);
    return fmt::format(" What moves: `[system]`, of which it takes\n`{}`.", fmt::join(keys, "`, `"));
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
    FigureReader reader{source.name, document, top, scene, chart, external_methods, stop};
    const auto& kind = *std::ranges::find(figure_kinds(), figure.kind, &FigureKind::name);
    try {
        if (errors)
            kind.read_keys(reader, kind.system);
        else
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
    chart_fields(writer, chart);
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

std::vector<FieldTable> figure_tables() {
    FigurePreset figure;
    FieldTable top{"title, subtitle, erratum, captions"}, chart{"[chart]"};
    top_fields(top, figure);
    chart_fields(chart, figure.chart);
    std::vector<FieldTable> all{top, chart};
    for (const auto& kind : figure_kinds())
        for (auto& table : kind.tables()) {
            if (table.text.empty())
                table.text = fmt::format("Of `kind = \"{}\"`.{}\n", kind.name, system_description(kind.system));
            all.push_back(std::move(table));
        }
    return all;
}

std::vector<FieldTable> tables_of(std::string_view kind) {
    const auto film = film_tables();
    const auto& [top, scene, system] = std::tie(film[0], film[1], film[2]);
    const auto named = [](FieldTable table, std::string_view key) {
        table.name = fmt::format("[{}]", key);
        return table;
    };
    std::vector<FieldTable> pair{scene, named(system, "system"), named(system, "a"), named(system, "b")};
    std::vector<FieldTable> all{named(top, "")};
    if (kind == pair_kind) {
        all.insert(all.end(), pair.begin(), pair.end());
        for (auto& table : all)
            if (table.key() == "a" || table.key() == "b") table.append(side_text_table());
        all.push_back(film.back());
        return all;
    }
    const auto figures = figure_tables();
    all = {named(figures[0], "")};
    std::erase_if(pair[0].fields, [](const ListedField& field) {  // only for films
        return field.key.ends_with("_columns") || field.key == "certify";
    });
    for (const auto& figure : figure_kinds()) {
        if (figure.name != kind) continue;
        if (figure.system == FigureKind::System::pair)
            all.insert(all.end(), pair.begin(), pair.end());
        else
            all.emplace_back("[scene]").fields = {scene.fields.front()};
        if (figure.system == FigureKind::System::release) all.push_back(release_table());
        all.push_back(figures[1]);
        for (auto& table : figure.tables())
            if (table.key() == "chart")
                all.back().fields.insert(all.back().fields.end(), table.fields.begin(), table.fields.end());
            else
                all.insert(all.end() - 1, std::move(table));
    }
    return all;
}

std::vector<ReferencePage> reference_pages() {
    const auto film = film_tables();
    const auto markdown = [](std::span<const FieldTable> tables) {
        std::string text;
        for (const auto& table : tables) text += table.markdown();
        return text;
    };
    const auto figures = figure_tables();
    const auto series = std::find_if(figures.begin(), figures.end(), [](const FieldTable& table) {
        return table.text.find("`kind = \"series\"`") != std::string::npos;
    });
    const auto all = std::span(film);
    return {{"presets.md", std::string(film_introduction) + markdown(all.first(all.size() - 1))},
            {"presets-video.md", std::string(video_introduction) + markdown(all.last(1))},
            {"presets-figures.md", std::string(figure_introduction) + markdown({figures.begin(), series})},
            {"presets-series.md", std::string(series_introduction) + markdown({series, figures.end()})}};
}

}  // namespace doppel
