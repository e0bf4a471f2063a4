#pragma once

#include "scene/member.hpp"
#include "scene/resolved.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace doppel {

struct ListedField;

/// The description of a key's type.
struct ValueType {
    std::string_view words;                       // Markdown
    Json (*schema)(const ListedField&);           // of its values, JSON schema (Draft 4)
    std::string_view example = {};                // TOML, for a key without default; for whole numbers the least one
    std::string_view positive_example = example;  // for numbers > 0
    bool is_list = false;                         // a list of texts
};
ValueType value_type(const KeyMember& member);

/// Shown as the default of a required key.
inline constexpr std::string_view must_be_given = "must be given";

/// A key with all properties from its list of fields. In "widest" tables its bounds are the widest ones.
struct ListedField : Field {
    ValueType type;
    std::string by_default;            // Markdown
    std::vector<std::string> choices;  // of a text, or of a list's elements

    bool is_needed() const { return by_default == must_be_given; }
    /// The range of a number: "> 0", "0 (none) to 100"; empty if there is none.
    std::string range_text() const;
    /// Type and range in words, Markdown.
    std::string takes() const;
    /// The default as TOML; empty if there is none, or only a description.
    std::string default_value() const;
    /// The default, or another valid value, as TOML.
    std::string example() const;
};

/// JSON schema of a list of `minimum` to `maximum` items; 0 = any number.
Json list_schema(Json items, std::size_t minimum, std::size_t maximum);

/// Markdown without code marks.
std::string plain_words(std::string text);

/// A table of presets, "[scene]", and its keys, as data from a list of fields. table(field, default) adds a key.
struct FieldTable : KeyVisitor {
    std::string name, text;  // `text` is shown above the keys in docs/presets.md
    std::vector<ListedField> fields;
    std::vector<FieldTable> tables;  // inner tables
    bool is_widest = false;          // with the widest bounds of all keys

    explicit FieldTable(std::string table_name = {}, std::string text_above = {})
        : name(std::move(table_name)), text(std::move(text_above)) {}

    void key(const Field& field, const KeyMember& by_default) override;
    void table(std::string_view key, const std::function<void(KeyVisitor&)>& list) override;
    void append(const FieldTable& other);

    /// "system" for "[system]", "colors" for "[video.colors]".
    std::string_view key() const;
    /// A section of docs/presets.md, including the inner tables.
    std::string markdown() const;
};

/// The keys that [a] and [b] of a film have in addition to those of [system].
FieldTable side_text_table();

inline constexpr std::string_view torque_table = "[[system.torque]]";

/// All tables of a film's preset: keys outside of tables; [scene]; [system], [a], [b]; particles; the kinds of
/// constraints and forces; torques; side_text_table(); [video].
std::vector<FieldTable> film_tables();

}  // namespace doppel
