#pragma once

#include <string>
#include <string_view>

namespace doppel::test {

/// The preset of this kind that "doppel init" writes, templates/KIND.toml.in: all keys, the rarely used ones as comments;
/// "{file}" and "{title}" stand for the path and the title.
std::string starting_preset(std::string_view kind);

/// What the shells complete after --set, templates/settings.tsv: kind of preset, key, help, and values to propose.
std::string listed_settings();

}  // namespace doppel::test
