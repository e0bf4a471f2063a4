// docs/presets*.md list the same keys as the program.
#include "figure/preset.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

namespace doppel {
namespace reference_test {

TEST(Reference, OfPresetsIsThatOfTheLists) {
    for (const auto& page : reference_pages()) {
        const auto path = DOPPEL_SOURCE_DIR "/docs/" + page.file;
        if (std::getenv("DOPPEL_UPDATE_REFERENCE")) std::ofstream(path) << page.text;
        std::ostringstream text;
        text << std::ifstream(path).rdbuf();
        EXPECT_EQ(text.str(), page.text) << "tests/update-reference writes " << page.file;
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
    auto tables = film_tables();
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

}  // namespace reference_test
}  // namespace doppel
