#pragma once

#include "scene/preset_fields.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace doppel::test {

/// The description of a key's type, that of its member.
struct ValueType {
    std::string_view words;                       // Markdown
    std::string_view example = {};                // TOML, for a key without default; for whole numbers the least one
    std::string_view positive_example = example;  // for numbers > 0
    bool is_list = false;                         // a list of texts
};

/// A key with all properties from its list of fields. `names` are also those of an enumeration, and known values. In
/// "widest" tables its bounds are the widest ones.
struct ListedField : Field {
    std::size_t member_type;             // index in KeyMember; for the schema (tests/figure)
    ValueType type;                      // in words
    std::string default_value;           // TOML; empty if there is none, or only a description
    std::string_view described_default;  // the description then

    /// The range of a number: "> 0", "0 (none) to 100"; empty if there is none.
    std::string range_text() const;
    /// Type and range in words, Markdown.
    std::string takes() const;
    /// The default, or another valid value, as TOML.
    std::string example() const;
};

/// A table of presets, "[scene]", and its keys, as data from a list of fields. table(field, default) adds a key.
struct FieldTable : KeyVisitor {
    std::string name, text;  // `text` is shown above the keys in docs/presets-*.md
    std::vector<ListedField> fields;
    std::vector<FieldTable> tables;  // inner tables
    bool is_widest = false;          // with the widest bounds of all keys

    explicit FieldTable(std::string table_name = {}, std::string text_above = {})
        : name(std::move(table_name)), text(std::move(text_above)) {}

    void key(const Field& field, const KeyMember& by_default) override;
    void table(std::string_view key, const std::function<void(KeyVisitor&)>& list) override;

    /// Whether a preset has a list of such tables, "[[curve]]".
    bool is_entry() const { return name.starts_with("[["); }
    /// "system" for "[system]", "colors" for "[video.colors]".
    std::string_view key() const;
};

}  // namespace doppel::test
