#pragma once

#include "output/sink.hpp"
#include "output/transaction.hpp"
#include "scene/preset_fields.hpp"

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace doppel {

// Values as TOML.

std::string toml_text(const std::string& text);
/// A whole number, or "a/b" in quotes.
inline std::string toml_ratio(const Rational& value) {
    return value.is_whole() ? value.text() : fmt::format("\"{}\"", value.text());
}

std::string toml_value(const Panels& panels);
std::string toml_value(const Speed& speed);
std::string toml_value(const Members& members);
template <class T>
std::string toml_value(const T& value) {
    if constexpr (std::is_same_v<T, std::string>) {
        return toml_text(value);
    } else if constexpr (std::is_enum_v<T>) {
        return fmt::format("\"{}\"", name_of(value));
    } else if constexpr (std::is_same_v<T, Rational>) {
        return toml_ratio(value);
    } else if constexpr (std::is_same_v<T, Quad>) {
        return text_of(value);
    } else if constexpr (std::is_arithmetic_v<T>) {
        return fmt::format("{}", value);
    } else if constexpr (std::is_same_v<T, Size>) {
        return fmt::format("[{}, {}]", value.width, value.height);
    } else if constexpr (std::is_same_v<T, Range>) {
        return fmt::format("[{}, {}]", value.low, value.high);
    } else if constexpr (std::is_same_v<T, Color>) {
        return fmt::format("\"{}\"", hexadecimal(value));
    } else if constexpr (std::is_same_v<T, TomlValues>) {
        return fmt::format("[{}]", fmt::join(value.texts, ", "));
    } else if constexpr (std::is_same_v<T, ChosenText>) {
        return value.own ? toml_value(*value.own) : toml_value(value.shown);
    } else if constexpr (std::is_same_v<T, EndSpec>) {
        return std::visit([](const auto& end) { return toml_value(end); }, value);
    } else {
        std::vector<std::string> elements;
        for (const auto& element : value) elements.push_back(toml_value(element));
        return fmt::format("[{}]", fmt::join(elements, ", "));
    }
}

/// The value of a key; empty for an optional key that is not given.
std::string toml_value(const KeyMember& member);

/// Writes a table key by key: writer(field, member). Keys that do not apply or are not given are left out.
class TomlWriter : public KeyVisitor {
public:
    /// `name` = that of the table, "video".
    explicit TomlWriter(std::string name = "") : name_(std::move(name)) {}

    void key(const Field& field, const KeyMember& member) override;
    void add(std::string_view key, const std::string& value) { text_ += fmt::format("{} = {}\n", key, value); }
    /// Writes [NAME.key] after the other fields; nothing if it is empty.
    void table(std::string_view key, const std::function<void(KeyVisitor&)>& fields) override;

    std::string text() const { return text_ + tables_; }

private:
    std::string name_, text_, tables_;
};

/// The preset as understood, every key with its value: TOML that read_preset() reads back to the same scene.
std::string resolved_toml(const Preset& preset);

/// The part that decides the motion: [scene] without its first keys, then the sides.
std::string resolved_pair(const Preset& preset);
/// [a] and [b] with all keys, inside the table `above` ("curve.").
std::string resolved_sides(const Preset& preset, const std::string& above = "");

/// [system] of which only a chain and its release matter.
std::string resolved_release(SideSpec side);

/// The same without the release.
std::string resolved_chain(SideSpec side);

// Parts of the manifests of films and figures.

using Json = nlohmann::ordered_json;

/// Converts a TOML document without dates. A number with more than 17 digits becomes text: "90.0000000000000000001".
Json json_of_toml(const std::string& toml);

/// Version and revision.
Json program_json();

/// Metadata that trace a picture or film to its source: its title, the preset's name, and `record`: how it was made.
/// Without a record, the name of the manifest; the bytes are the same in a stream, which has none.
Metadata metadata_of(const std::string& title, const std::string& name, std::string record = {});

/// Adds size and SHA-256 of the run's complete files, and of files of earlier runs that stay; then writes the manifest
/// "NAME.json" as the last file. Throws Error (exit 4).
void write_manifest(Transaction& parts, const std::string& name, Json manifest);

}  // namespace doppel
