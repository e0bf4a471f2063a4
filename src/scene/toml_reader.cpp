#include "scene/toml_reader.hpp"

#include "base/text.hpp"
#include "render/typeface.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace doppel {
namespace {

constexpr std::string_view command_line = "--";

/// What keeps a text from being drawn; nothing where its fonts have all of its letters.
std::optional<std::string> not_drawable(std::string_view text, const Typeface& typeface) {
    std::vector<std::string> letters;
    constexpr std::size_t most = 8;  // that are named
    for (auto lacking = typeface.missing_character(text); !lacking.empty() && letters.size() <= most;
         lacking = typeface.missing_character(text)) {
        auto after = lacking;
        const auto character = next_character(after);
        const auto number = fmt::format("U+{:04X}", static_cast<unsigned>(character));
        if (is_control(character)) return fmt::format("holds the control character {}, which cannot be drawn", number);
        if (needs_shaping(character))
            return fmt::format(
                "holds \"{}\" ({}) of a script whose letters join or run to the left, which Doppel does "
                "not write",
                lacking, number);
        auto letter = letters.size() == most ? "…" : fmt::format("\"{}\" ({})", lacking, number);
        if (std::find(letters.begin(), letters.end(), letter) == letters.end()) letters.push_back(std::move(letter));
        text.remove_prefix(static_cast<std::size_t>(lacking.data() + lacking.size() - text.data()));
    }
    if (letters.empty()) return std::nullopt;
    const auto rest = typeface.uses_system_fonts() ? "; no font of this system has outlines of them either; "
                                                     "[video.fonts] text takes a font file of your own"
                                                   : "";
    return fmt::format(
        "holds {}, which the built-in font lacks; it has Latin and Greek letters and signs of mathematics{}",
        fmt::join(letters, ", "), rest);
}

}  // namespace

TomlReader::TomlReader(const toml::table* table, std::string name, std::string path, const TomlTexts& texts,
                       const Typeface& typeface)
    : table_(table), name_(std::move(name)), path_(std::move(path)), texts_(&texts), typeface_(&typeface) {}

std::string TomlReader::place(std::string_view key) const {
    if (!table_) return path_;
    for (auto&& [name, node] : *table_) {
        if (name.str() != key) continue;
        const auto& origin = node.source().path;
        if (origin && origin->starts_with(command_line)) return *origin;
        return fmt::format("{}:{}:{}", path_, name.source().begin.line, name.source().begin.column);
    }
    return path_;
}

std::string TomlReader::subject(std::string_view key) const {
    return name_.empty() ? std::string(key) : fmt::format("{} {}", name_, key);
}

const toml::node* TomlReader::find(std::string_view key) {
    known_.emplace(key);
    return table_ ? table_->get(key) : nullptr;
}

bool TomlReader::has(std::string_view key) {
    return find(key) != nullptr;
}

bool TomlReader::from_command_line(std::string_view key) {
    const auto* node = find(key);
    return node && node->source().path && node->source().path->starts_with(command_line);
}

void TomlReader::demand_drawable(std::string_view key, std::string_view text) const {
    if (const auto fault = not_drawable(text, *typeface_)) throw this->fault(key, "{}", *fault);
}

void TomlReader::demand_title(const std::string& name) {
    if (has("title")) return;
    if (const auto fault = not_drawable(name, *typeface_))
        throw bad_input("{}: title is missing, and the preset's name in its place {}", path_, *fault);
}

const toml::table* TomlReader::read_table(std::string_view key) {
    const auto* node = find(key);
    if (node && !node->is_table()) throw fault(key, "must be a table; {}", found(*node));
    return node ? node->as_table() : nullptr;
}

std::vector<const toml::table*> TomlReader::read_tables(std::string_view key) {
    std::vector<const toml::table*> tables;
    const auto* node = find(key);
    if (!node) return tables;
    const auto* array = node->as_array();
    if (!array || !array->is_array_of_tables())
        throw fault(key, "must be written as [[{}{}{}]] tables; {}", bare_name(), name_.empty() ? "" : ".", key,
                    found(*node));
    for (const auto& element : *array) tables.push_back(element.as_table());
    return tables;
}

void TomlReader::finish() const {
    if (!table_) return;
    for (auto&& [name, node] : *table_) {
        if (known_.contains(name.str())) continue;
        const std::vector<std::string_view> keys(known_.begin(), known_.end());
        const auto meant = nearest(name.str(), keys);
        throw bad_input(
            "{}: {} no \"{}\"; {}", place(name.str()), name_.empty() ? "a preset has" : name_ + " has", name.str(),
            meant ? fmt::format("did you mean \"{}\"?", *meant) : fmt::format("it has {}", fmt::join(keys, ", ")));
    }
}

/// One speed, or times with speeds.
void TomlReader::read(const Field& field, const toml::node& node, Speed& into) {
    const auto* array = node.as_array();
    into.changes.clear();
    if (!array) return read(field, node, into.constant);
    constexpr std::string_view form = "must be a speed, or times, s, with speeds such as [[0, 1], [6.8, 0.25]]";
    if (array->empty()) throw fault(field.key, "{}; it is []", form);
    for (const auto& element : *array) {
        const auto* pair = element.as_array();
        if (!pair || pair->size() != 2) throw fault(field.key, "{}; {} is none", form, shown(element));
        auto& [at_s, speed] = into.changes.emplace_back();
        read({.key = field.key, .bounds = not_negative}, *pair->get(0), at_s);
        read({.key = field.key, .bounds = changing_speeds}, *pair->get(1), speed);
    }
}

}  // namespace doppel
