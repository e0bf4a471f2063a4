// docs/presets*.md list the same keys as the program.
#include "figure/film_tables.hpp"
#include "figure/kind_tables.hpp"
#include "figure/kinds.hpp"
#include "figure/starting_presets.hpp"
#include "figure/support.hpp"

#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace doppel::reference_test {

using test::FieldTable;

/// The tables of all figures, then those of each kind with what the kind is of.
std::vector<FieldTable> figure_tables() {
    using test::MotionOf;
    const auto table_of = [](const char* kind, const char* name) {
        const auto all = test::tables_of(kind);
        return *std::find_if(all.begin(), all.end(), [&](const auto& table) { return table.name == name; });
    };
    std::vector<FieldTable> all{table_of("grid", "[]"), table_of("grid", "[chart]")};
    all[0].name = "title, subtitle, erratum, captions";
    std::vector<std::string_view> keys;  // of one motion
    for (const auto& field : table_of("section", "[system]").fields) keys.push_back(field.key);
    const auto of_release = fmt::format(" What moves: `[system]`, of which it takes\n`{}`.", fmt::join(keys, "`, `"));
    for (const auto& kind : figure_kinds())
        for (auto& table : test::own_tables(kind.name)) {
            const auto motion = test::motion_of(kind.name);
            table.text = fmt::format("Of `kind = \"{}\"`.{}\n", kind.name,
                                     motion == MotionOf::none ? ""
                                     : motion == MotionOf::pair
                                         ? " What moves: `[system]`, `[a]` and `[b]`, with `duration_s` and "
                                           "`sample_hz` of `[scene]`, as in a film."
                                         : of_release);
            if (table.key() == "chart") {
                table.name = fmt::format("[chart] kind = \"{}\"", kind.name);
                table.text = "Besides those of all figures:\n";
            } else if (table.key() == "series") {
                table.text =
                    "Of `kind = \"series\"`. What moves: of pairs `[system]`, `[a]` and `[b]`, with `duration_s` and "
                    "`sample_hz` of `[scene]`, as in a\nfilm; of one motion the chain of `[system]`, for `exponents` "
                    "also with mass, friction and drives.\n";
            } else if (table.key() == "curve") {
                table.text =
                    "A curve each, of pairs; without any, the one of `[system]`, `[a]` and `[b]`. A curve may have "
                    "`[curve.system]`, `[curve.a]` and\n`[curve.b]` on top of those.\n";
            }
            all.push_back(std::move(table));
        }
    return all;
}

/// A section of docs/presets.md, including the inner tables.
std::string markdown(const FieldTable& table) {
    auto page = fmt::format("\n## `{}`\n\n{}{}| key | takes | unit | default | |\n|---|---|---|---|---|\n", table.name,
                            table.text, table.text.empty() ? "" : "\n");
    for (const auto& field : table.fields)
        page += fmt::format("| `{}` | {} | {} | {} | {} |\n", field.key, field.takes(), field.unit,
                            test::default_of(field), field.help);
    for (const auto& inner : table.tables) page += markdown(inner);
    return page;
}

/// Pages of docs/ with the lists of keys that follow their introductions.
std::map<std::string, std::string> lists_of_pages() {
    const auto list = [](std::span<const FieldTable> tables) {
        std::string text;
        for (const auto& table : tables) text += markdown(table);
        return text;
    };
    const auto film = test::film_tables(), figures = figure_tables();
    const auto series =
        std::find_if(figures.begin(), figures.end(), [](const auto& table) { return table.name == "[series]"; });
    const auto all = std::span(film);
    return {{"presets.md", list(all.first(all.size() - 1))},
            {"presets-video.md", list(all.last(1))},
            {"presets-figures.md", list({figures.begin(), series})},
            {"presets-series.md", list({series, figures.end()})}};
}

TEST(Reference, OfPresetsIsThatOfTheLists) {
    for (const auto& [page, lists] : lists_of_pages()) {
        const auto path = DOPPEL_SOURCE_DIR "/docs/" + page;
        const auto text = test::bytes_of(path), introduction = text.substr(0, text.find("\n## "));
        if (std::getenv("DOPPEL_UPDATE_REFERENCE")) test::write_bytes(path, introduction + lists);
        EXPECT_EQ(test::bytes_of(path), introduction + lists) << "tests/update-reference writes " << page;
    }
}

TEST(Reference, OfInitAndCompletionIsThatOfTheLists) {
    std::map<std::string, std::string> files{{"settings.tsv", test::listed_settings()}};
    for (const auto kind : scene_kinds) files[fmt::format("{}.toml.in", kind)] = test::starting_preset(kind);
    for (const auto& [file, text] : files) {
        const auto path = DOPPEL_SOURCE_DIR "/templates/" + file;
        if (std::getenv("DOPPEL_UPDATE_REFERENCE")) test::write_bytes(path, text);
        EXPECT_EQ(test::bytes_of(path), text) << "tests/update-reference makes it anew";
    }
}

/// The keys in the tables of that name.
std::set<std::string> listed_keys(const std::vector<FieldTable>& tables, const std::string& name) {
    std::set<std::string> keys;
    for (const auto& table : tables) {
        if (table.name == name || table.name.starts_with(name + " kind"))
            for (const auto& field : table.fields) keys.emplace(field.key);
        keys.merge(listed_keys(table.tables, name));
    }
    return keys;
}

TEST(Reference, ListsEveryKeyOfThePresets) {
    auto tables = test::film_tables();
    for (auto& table : figure_tables()) tables.push_back(table);
    std::size_t seen = 0;
    for (const auto& preset : builtin_presets()) {
        std::istringstream lines(preset.text);
        const std::regex heading(R"(^\[+([a-z_.]+)\]+.*)"), key(R"(^([A-Za-z_0-9]+) *=.*)");
        std::string table;
        std::smatch match;
        for (std::string line; std::getline(lines, line);) {
            if (std::regex_match(line, match, heading)) table = match[1];
            if (!std::regex_match(line, match, key) || table.empty()) continue;
            const auto part = table.substr(table.find('.') + 1);
            const bool is_side = part == "a" || part == "b" || part == "system";
            auto keys = listed_keys(tables, is_side ? "[system], [a], [b]" : "[" + table + "]");
            if (part == "a" || part == "b") keys.merge(listed_keys(tables, "[a], [b]"));
            keys.merge(listed_keys(tables, "[[system." + part + "]]"));
            keys.merge(listed_keys(tables, "[[" + table + "]]"));
            keys.merge(listed_keys(tables, "[system." + part + "]"));
            EXPECT_TRUE(keys.contains(match[1]) || match[1] == "kind" || match[1] == "name")
                << preset.path << ": [" << table << "] " << match[1];
            ++seen;
        }
    }
    EXPECT_GT(seen, 200u);
}

}  // namespace doppel::reference_test
