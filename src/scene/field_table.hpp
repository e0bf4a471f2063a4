#pragma once

#include "scene/resolved.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace doppel {

struct ListedField;

/// What a key takes by the type of its member.
struct ValueType {
    std::string_view words;                       // Markdown
    Json (*schema)(const ListedField&);           // JSON schema (Draft 4)
    std::string_view example = {};                // TOML, of a key without a default
    std::string_view positive_example = example;  // of numbers > 0
};

/// A list of `least` to `most` items; 0 = of any number.
Json list_schema(Json items, std::size_t least, std::size_t most);

// Schemas of values, within the bounds of the key.
Json truth_schema(const ListedField& field);
Json number_schema(const ListedField& field);
Json integer_schema(const ListedField& field);
Json ratio_schema(const ListedField& field);
Json numbers_schema(const ListedField& field);
Json pair_schema(const ListedField& field);
Json whole_pair_schema(const ListedField& field);
Json text_schema(const ListedField& field);
Json texts_schema(const ListedField& field);
Json some_texts_schema(const ListedField& field);
Json chosen_text_schema(const ListedField& field);
Json end_schema(const ListedField& field);
Json color_schema(const ListedField& field);
Json colors_schema(const ListedField& field);
Json speed_schema(const ListedField& field);
Json members_schema(const ListedField& field);
Json values_schema(const ListedField& field);

/// That of a member that is a T.
template <class T>
constexpr ValueType value_type() {
    using std::is_same_v;
    if constexpr (is_optional<T>) return value_type<typename T::value_type>();
    if constexpr (is_same_v<T, bool>) return {"`true` or `false`", truth_schema, "true"};
    if constexpr (is_same_v<T, int>) return {"whole number", integer_schema, "1"};
    if constexpr (is_same_v<T, double> || is_same_v<T, Quad>) return {"number", number_schema, "1", "1e-6"};
    if constexpr (is_same_v<T, Rational>) return {"number or \"a/b\"", ratio_schema, "1", "60"};
    if constexpr (is_same_v<T, std::vector<double>> || is_same_v<T, std::vector<Quad>>)
        return {"numbers", numbers_schema, "1"};
    if constexpr (is_same_v<T, std::vector<std::string>>) return {"list of text", texts_schema, "[\"\"]"};
    if constexpr (is_same_v<T, Panels>) return {"list of text, not empty", some_texts_schema};
    if constexpr (is_same_v<T, Speed>) return {"number, \"a/b\", or list of [s, number]", speed_schema};
    if constexpr (is_same_v<T, QuadPair>) return {"[x, y]", pair_schema, "[0, 0]"};
    if constexpr (is_same_v<T, Members>) return {"whole number, or angles of 2 to 8 pendulums", members_schema};
    if constexpr (is_same_v<T, ChosenText>) return {"`true`, `false`, text or list of text", chosen_text_schema};
    if constexpr (is_same_v<T, EndSpec>) return {"text or [x, y]", end_schema, "\"\""};
    if constexpr (is_same_v<T, TomlValues>) return {"values that the key takes", values_schema, "[0, 90]"};
    if constexpr (is_same_v<T, Size> || is_same_v<T, std::array<int, 2>>)
        return {"two whole numbers", whole_pair_schema, "[4, 3]"};
    if constexpr (is_same_v<T, Range>) return {"two numbers", pair_schema, "[0, 10]", "[1e-6, 10]"};
    if constexpr (is_same_v<T, Color>) return {"\"#rrggbb\"", color_schema, "\"#ff9f40\""};
    if constexpr (is_same_v<T, std::array<Color, 2>>)
        return {"two of \"#rrggbb\"", colors_schema, "[\"#ff9f40\", \"#4fc3f7\"]"};
    return {"text", text_schema, "\"\""};
}

/// Of a key without a default.
inline constexpr std::string_view must_be_given = "must be given";

/// A key with what a list of fields says of it.
struct ListedField {
    std::string_view key;
    ValueType type;
    std::string_view unit, help;
    std::string by_default;                 // Markdown
    std::vector<std::string> choices = {};  // of text, or of a list's elements
    Bounds bounds = {};
    std::size_t most = 0;           // as in Field
    std::string_view pattern = {};  // as in Field
    bool is_drawn = false;          // as in Field

    bool is_list() const { return type.schema == texts_schema || type.schema == some_texts_schema; }
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

/// Markdown without its marks of code.
std::string plain_words(std::string text);

/// A table of presets, "[scene]", and its keys: what a list of fields says, as data. table(field, default) takes a key.
struct FieldTable {
    std::string name, text = {};  // `text` stands above the keys in docs/presets.md
    std::vector<ListedField> fields = {};
    std::vector<FieldTable> tables = {};  // inside this one
    bool is_widest = false;               // with all numbers that keys take, whatever others say

    template <class T>
    void operator()(const Field& field, const T& by_default) {
        std::vector<std::string> choices(field.names.begin(), field.names.end());
        if (choices.empty()) choices.assign(field.known.begin(), field.known.end());
        if constexpr (std::is_enum_v<T>) choices.assign(names_of<T>.begin(), names_of<T>.end());
        if constexpr (std::is_same_v<T, Panels>) {
            choices = {"pendulums"};
            choices.insert(choices.end(), names_of<StripKind>.begin(), names_of<StripKind>.end());
        }
        fields.push_back({field.key, value_type<T>(), field.unit, field.help, default_text(field, by_default),
                          std::move(choices), is_widest ? field.otherwise.value_or(field.bounds) : field.bounds,
                          field.most, field.pattern, field.is_drawn});
    }
    template <class Visit>
    void table(std::string_view key, const Visit& visit) {
        // of "[system], [a], [b]" the first
        visit(tables.emplace_back(FieldTable{fmt::format("[{}.{}]", name.substr(1, name.find(']') - 1), key)}));
    }
    static bool from_command_line(std::string_view) { return false; }

    /// Takes the keys and tables of `other`, too.
    void append(const FieldTable& other);

    /// "system" of "[system]", "colors" of "[video.colors]".
    std::string_view key() const;
    /// A section of docs/presets.md, with those of the tables inside.
    std::string markdown() const;

private:
    template <class T>
    static std::string default_text(const Field& field, const T& value) {
        if (!field.needed_by.empty()) return std::string(must_be_given);
        if constexpr (is_optional<T>)
            return field.absent.empty() ? "none" : std::string(field.absent);
        else
            return field.absent.empty() ? fmt::format("`{}`", toml_value(value)) : std::string(field.absent);
    }
};

/// The keys that [a] and [b] of a film have besides those of [system].
FieldTable side_text_table();

/// Name of the table of motors.
inline constexpr std::string_view torque_table = "[[system.torque]]";

/// All tables of a film's preset: the keys outside of tables; [scene]; [system], [a], [b]; particles; the kinds of
/// constraints and of forces; motors; side_text_table(); [video].
std::vector<FieldTable> film_tables();

}  // namespace doppel
