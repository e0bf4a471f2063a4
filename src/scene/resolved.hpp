#pragma once

#include "output/sink.hpp"
#include "output/transaction.hpp"
#include "scene/member.hpp"

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace doppel {

// Values as TOML writes them.

/// A basic string, with its quotes.
std::string toml_text(const std::string& text);
/// A number where it is whole, "a/b" where it is not.
std::string toml_ratio(const Rational& value);

std::string toml_value(const Color& color);
std::string toml_value(const Panels& panels);
std::string toml_value(const Speed& speed);
std::string toml_value(const Members& members);
std::string toml_value(const ChosenText& text);
std::string toml_value(const TomlValues& values);
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
    } else if constexpr (std::is_same_v<T, EndSpec>) {
        return std::visit([](const auto& end) { return toml_value(end); }, value);
    } else {
        std::vector<std::string> elements;
        for (const auto& element : value) elements.push_back(toml_value(element));
        return fmt::format("[{}]", fmt::join(elements, ", "));
    }
}

/// That of a key; empty of an optional one that is not given.
std::string toml_value(const KeyMember& member);

/// Writes a table key by key: writer(field, member). Keys that do not count, and what is not given, are left out.
class TomlWriter : public KeyVisitor {
public:
    /// `name` = that of the table, "video".
    explicit TomlWriter(std::string name = "") : name_(std::move(name)) {}

    void key(const Field& field, const KeyMember& member) override;
    void add(std::string_view key, const std::string& value) { text_ += fmt::format("{} = {}\n", key, value); }
    /// The fields of [NAME.key], after all others; nothing where it is empty.
    void table(std::string_view key, const std::function<void(KeyVisitor&)>& fields) override;

    std::string text() const { return text_ + tables_; }

private:
    std::string name_, text_, tables_;
};

/// The preset as it was understood, every key with its value: TOML that read_preset() reads back to the same scene.
std::string resolved_toml(const Preset& preset);

/// The part that decides the motion: the rest of [scene], then the sides.
std::string resolved_pair(const Preset& preset);
/// [a] and [b] with everything in them, inside the table that `above` names ("curve.").
std::string resolved_sides(const Preset& preset, const std::string& above = "");

/// [system] where only a chain and its release matter.
std::string resolved_release(SideSpec side);

/// The same without the release.
std::string resolved_chain(SideSpec side);

// What the manifests of films and of figures are made of.

using Json = nlohmann::ordered_json;

/// Of a document without dates. A number of more than 17 digits, which double has not, is text: "90.0000000000000000001".
Json json_of_toml(const std::string& toml);

/// Version and revision.
Json program_json();

/// By which a picture or a film can be traced to how it was made: its title, the preset's name, and where that is written.
Metadata metadata_of(const std::string& title, const std::string& name, const std::string& record);

/// Adds the files of the run, those that are finished, and those of earlier runs that stay, with size and SHA-256; then
/// writes the manifest as the last of them, "NAME.json". Throws Error (exit 4).
void write_manifest(Transaction& parts, const std::string& name, Json manifest);

}  // namespace doppel
