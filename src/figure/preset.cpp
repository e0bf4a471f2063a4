#include "figure/preset.hpp"

#include "figure/kinds.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace doppel {
namespace {

constexpr std::string_view film_introduction = R"(# Presets: all tables and keys

A preset is a TOML file that describes two pendulums and the film of them, or a figure. Every key has a default; units
are part of the key. `doppel init FILE.toml` writes one to start from (`doppel init --figure KIND` that of a figure),
`doppel show NAME` prints one, `doppel check FILE` tells what it would run, and `--set KEY=VALUE` sets a key from the command line:
`video.theme=light` (text needs no quotes), `system.angle_deg=[90, 60]`, `system.mass_kg[1]=2` (the second of a list),
`system.force.NAME.length_m=1.2` (an entry by its `name`, or the only one of its `kind`).
A key that is not in these tables is an error; all faults of a preset are told in one go, in the order of its lines.

```toml
title = "Three thousandths of a degree"

[scene]
duration_s = 30

[system]                  # both sides
angle_deg = [90, 90]

[b]                       # the second side, where it differs
angle_deg = [90.003, 90]
```

Side a has the keys of `[system]` with those of `[a]` in their place, side b those of `[b]`. Arrays with one number a
link may also be one number for all links. `[[a.particle]]`, `[[a.constraint]]` and `[[a.force]]` with the `name` of one
in `[system]` change it; others are added.

Editors that read JSON schemas (taplo, Even Better TOML) complete keys and mark mistakes as you type, where the first line
names the schema: `#:schema ./preset.schema.json` for a file that `doppel schema > preset.schema.json` wrote beside the
preset. `doppel show` names the schema that it finds, in `presets/` here or installed with the program, and leaves the line
out where there is none. `doppel check` tells if the line names another file.
)";

constexpr std::string_view figure_introduction = R"(
# Presets of figures

`kind` of `[scene]` says which figure it is; [figures](figures.md) shows them. In place of `[video]` there are `[chart]`
and a table that is the kind's own.
)";

/// The keys outside all tables.
template <class Visit>
void top_fields(Visit& visit, FigurePreset& figure) {
    visit(title_field, figure.title);
    visit({.key = "subtitle",
           .help = "below the title",
           .absent = "of pairs: what moves, and how it is stepped",
           .is_drawn = true},
          figure.subtitle);
    visit(
        {.key = "erratum", .help = "below the picture: where a printed caption and the truth differ", .is_drawn = true},
        figure.erratum);
    visit({.key = "captions", .help = "below the picture", .is_drawn = true}, figure.captions);
}

/// [system] of figures that step a chain themselves.
FieldTable release_table() {
    SideSpec side;
    FieldTable release{"[system]"};
    chain_fields(release, side, positive);
    gravity_field(release, side);
    return release;
}

/// What moves, in docs/presets.md.
std::string what_moves(FigureKind::System system) {
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

/// Reads the keys alone where `faults` are given, and throws all that they have by themselves; else the figure, with what
/// keys say together.
FigurePreset read_once(const PresetText& source, const TomlDocument& document, Faults* faults,
                       std::span<const ExternalMethod> external_methods, const std::atomic<bool>& stop) {
    FigurePreset figure;
    figure.name = figure.title = source.name;
    auto top = document.top(faults);
    top.demand_title(figure.name);
    top_fields(top, figure);
    auto scene = document.table(top, "scene");
    figure.kind = read_kind(scene);
    if (faults && faults->concern("scene")) faults->throw_if_any();  // which tables there may be is not known
    if (figure.kind == pair_kind)
        throw bad_input("{}: this is a film, not a figure; make it with: doppel render {}", source.path, source.call);
    auto chart = document.table(top, "chart");
    FigureReader reader{source.name, document, top, scene, chart, external_methods, stop};
    const auto& kind = *std::ranges::find(figure_kinds(), figure.kind, &FigureKind::name);
    try {
        if (faults)
            kind.read_keys(reader, kind.system);
        else
            figure.experiment = kind.read(reader);
    } catch (const TomlFault& fault) {
        if (!faults) throw;
        top.refuse(fault.with({}), "");
        faults->throw_if_any();
    }
    if (!faults && !top.has("subtitle")) figure.subtitle = figure.experiment->subtitle();
    scene.finish();
    read_chart(chart, figure.chart);
    top.finish();
    if (faults) faults->throw_if_any();
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
    Faults faults(overrides);
    read_once(source, document, &faults, external_methods, stop);
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
                table.text = fmt::format("Of `kind = \"{}\"`.{}\n", kind.name, what_moves(kind.system));
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
    pair[0].fields.pop_back();  // columns of a film's table
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

std::string preset_reference() {
    std::string text(film_introduction);
    for (const auto& table : film_tables()) text += table.markdown();
    text += figure_introduction;
    for (const auto& table : figure_tables()) text += table.markdown();
    return text;
}

}  // namespace doppel
