#pragma once

#include "scene/preset.hpp"
#include "scene/toml_reader.hpp"

namespace doppel {

/// A preset's text as tables, with the command line's values in place.
struct TomlDocument {
    std::string path;  // what errors name
    toml::table root;
    TomlTexts texts;

    /// A reader of the table [key], which may be absent.
    TomlReader table(TomlReader& above, std::string_view key) const {
        return {above.read_table(key), fmt::format("[{}]", key), path, texts};
    }
};

/// Throws Error (exit 2) with the place where the text is no TOML, a value is none, or a key is given twice.
TomlDocument parse_document(const PresetText& source, const std::vector<Override>& overrides);

}  // namespace doppel
