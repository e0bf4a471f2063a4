#pragma once

#include "scene/member.hpp"
#include "scene/resolved.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace doppel {

struct ListedField;

/// What a key takes, by the type of its member.
struct ValueType {
    std::string_view words;                       // Markdown
    Json (*schema)(const ListedField&);           // of its values: JSON schema (Draft 4)
    std::string_view example = {};                // TOML, of a key without a default; of whole numbers the least
    std::string_view positive_example = example;  // of numbers > 0
    bool is_list = false;                         // of text
};
ValueType value_type(const KeyMember& member);

/// Of a key without a default.
inline constexpr std::string_view must_be_given = "must be given";

/// A key with all that a list of fields says of it: its bounds are the widest where the table's are.
struct ListedField : Field {
    ValueType type;
    std::string by_default;            // Markdown
    std::vector<std::string> choices;  // of text, or of a list's elements

    bool is_needed() const { return by_default == must_be_given; }
    /// The range of a number: "> 0", "0 (none) to 100"; empty where there is none.
    std::string range_text() const;
    /// What it takes, in words, with its range: Markdown.
    std::string takes() const;
    /// The default as TOML; empty where it is none or only words.
    std::string default_value() const;
    /// The default, or another value that it takes: TOML.
    std::string example() const;
};

/// JSON schema of a list of `least` to `most` items; 0 = of any number.
Json list_schema(Json items, std::size_t least, std::size_t most);

/// Markdown without its marks of code.
std::string plain_words(std::string text);

/// A table of presets, "[scene]", and its keys: what a list of fields says, as data. table(field, default) takes a key.
struct FieldTable : KeyVisitor {
    std::string name, text;  // `text` stands above the keys in docs/presets.md
    std::vector<ListedField> fields;
    std::vector<FieldTable> tables;  // inside this one
    bool is_widest = false;          // with all numbers that keys take, whatever others say

    explicit FieldTable(std::string table_name = {}, std::string text_above = {})
        : name(std::move(table_name)), text(std::move(text_above)) {}

    void key(const Field& field, const KeyMember& by_default) override;
    void table(std::string_view key, const std::function<void(KeyVisitor&)>& list) override;
    /// Takes the keys and tables of `other`, too.
    void append(const FieldTable& other);

    /// "system" of "[system]", "colors" of "[video.colors]".
    std::string_view key() const;
    /// A section of docs/presets.md, with those of the tables inside.
    std::string markdown() const;
};

/// The keys that [a] and [b] of a film have besides those of [system].
FieldTable side_text_table();

/// Name of the table of motors.
inline constexpr std::string_view torque_table = "[[system.torque]]";

/// All tables of a film's preset: the keys outside of tables; [scene]; [system], [a], [b]; particles; the kinds of
/// constraints and of forces; motors; side_text_table(); [video].
std::vector<FieldTable> film_tables();

}  // namespace doppel
