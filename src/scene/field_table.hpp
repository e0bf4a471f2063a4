#pragma once

#include "scene/resolved.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace doppel {

/// What a key takes whose member is a T.
template <class T>
constexpr std::string_view type_words() {
    if constexpr (is_optional<T>) return type_words<typename T::value_type>();
    if constexpr (std::is_same_v<T, bool>) return "`true` or `false`";
    if constexpr (std::is_same_v<T, int>) return "whole number";
    if constexpr (std::is_same_v<T, double> || std::is_same_v<T, Quad>) return "number";
    if constexpr (std::is_same_v<T, Rational>) return "number or \"a/b\"";
    if constexpr (std::is_same_v<T, std::vector<double>> || std::is_same_v<T, std::vector<Quad>>) return "numbers";
    if constexpr (std::is_same_v<T, std::vector<std::string>>) return "list of text";
    if constexpr (std::is_same_v<T, Panels>) return "list of text, not empty";
    if constexpr (std::is_same_v<T, Speed>) return "number, \"a/b\", or list of [s, number]";
    if constexpr (std::is_same_v<T, QuadPair>) return "[x, y]";
    if constexpr (std::is_same_v<T, Members>) return "whole number, or angles of 2 to 8 pendulums";
    if constexpr (std::is_same_v<T, ChosenText>) return "`true`, `false`, text or list of text";
    if constexpr (std::is_same_v<T, EndSpec>) return "text or [x, y]";
    if constexpr (std::is_same_v<T, TomlValues>) return "values that the key takes";
    if constexpr (std::is_same_v<T, Size> || std::is_same_v<T, std::array<int, 2>>) return "two whole numbers";
    if constexpr (std::is_same_v<T, Range>) return "two numbers";
    if constexpr (std::is_same_v<T, Color>) return "\"#rrggbb\"";
    if constexpr (std::is_same_v<T, std::array<Color, 2>>) return "two of \"#rrggbb\"";
    return "text";
}

/// Of a key without a default.
inline constexpr std::string_view must_be_given = "must be given";

/// A key with what a list of fields says of it.
struct ListedField {
    std::string_view key, type, unit, help;  // `type` is one of type_words()
    std::string by_default;                  // Markdown
    std::vector<std::string> choices = {};   // of text, or of a list's elements
    Bounds bounds = {};
    std::size_t most = 0;           // as in Field
    std::string_view pattern = {};  // as in Field
    bool is_drawn = false;          // as in Field

    bool is_list() const { return type.starts_with("list"); }
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
        fields.push_back({field.key, type_words<T>(), field.unit, field.help, default_text(field, by_default),
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
