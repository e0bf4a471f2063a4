#pragma once

#include "scene/preset.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace doppel {

// Values as TOML writes them.

/// A basic string, with its quotes.
std::string toml_text(const std::string& text);
/// A number where it is whole, "a/b" where it is not.
std::string toml_ratio(const Rational& value);

inline std::string toml_value(const std::string& text) {
    return toml_text(text);
}
inline std::string toml_value(const Rational& value) {
    return toml_ratio(value);
}
inline std::string toml_value(const Quad& value) {
    return text_of(value);
}
inline std::string toml_value(double value) {
    return fmt::format("{}", value);
}
inline std::string toml_value(int value) {
    return fmt::format("{}", value);
}
inline std::string toml_value(bool value) {
    return value ? "true" : "false";
}
inline std::string toml_value(const Size& size) {
    return fmt::format("[{}, {}]", size.width, size.height);
}
inline std::string toml_value(const Range& range) {
    return fmt::format("[{}, {}]", range.low, range.high);
}
std::string toml_value(const Color& color);
std::string toml_value(const Panels& panels);
template <class Choice>
requires std::is_enum_v<Choice> std::string toml_value(Choice choice) {
    return fmt::format("\"{}\"", name_of(choice));
}
template <class List>
requires requires(const List& list) {
    list.data();
}
std::string toml_value(const List& list) {
    std::vector<std::string> values;
    for (const auto& value : list) values.push_back(toml_value(value));
    return fmt::format("[{}]", fmt::join(values, ", "));
}
inline std::string toml_value(const EndSpec& end) {
    return std::visit([](const auto& one) { return toml_value(one); }, end);
}

/// Writes a table key by key: writer(field, member). Keys that do not count, and what is not given, are left out.
class TomlWriter {
public:
    template <class T>
    void operator()(const Field& field, const T& value) {
        if (!field.only.holds) return;
        if constexpr (is_optional<T>) {
            if (value) add(field.key, toml_value(*value));
        } else if constexpr (std::is_same_v<T, std::string>) {
            if (!value.empty()) add(field.key, toml_value(value));
        } else {
            add(field.key, toml_value(value));
        }
    }
    void add(std::string_view key, const std::string& value) { text_ += fmt::format("{} = {}\n", key, value); }
    /// The fields of [video.key], after all others; nothing where it is empty.
    template <class Visit>
    void table(std::string_view key, const Visit& visit) {
        TomlWriter inside;
        visit(inside);
        if (!inside.text_.empty()) tables_ += fmt::format("\n[video.{}]\n{}", key, inside.text_);
    }
    static bool from_command_line(std::string_view) { return false; }

    std::string text() const { return text_ + tables_; }

private:
    std::string text_, tables_;
};

/// The preset as it was understood, every key with its value: TOML that read_preset() reads back to the same scene.
std::string resolved_toml(const Preset& preset);

/// The part that decides the motion: the rest of [scene], then the sides.
std::string resolved_pair(const Preset& preset);
/// [a] and [b] with everything in them, inside the table that `above` names ("curve.").
std::string resolved_sides(const Preset& preset, const std::string& above = "");

/// [system] where only a chain and its release matter.
std::string resolved_release(const SideSpec& side);

/// The same without the release.
std::string resolved_chain(const SideSpec& side);

}  // namespace doppel
