#include "scene/toml_reader.hpp"

#include "base/text.hpp"
#include "render/typeface.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

namespace doppel {
namespace {

/// Why a text cannot be drawn; nothing if its fonts contain all letters.
std::optional<std::string> not_drawable(std::string_view text, const Typeface& typeface) {
    std::vector<std::string> letters;
    constexpr std::size_t maximum = 8;  // named in the message
    for (auto lacking = typeface.missing_character(text); !lacking.empty() && letters.size() <= maximum;
         lacking = typeface.missing_character(text)) {
        auto after = lacking;
        const auto character = next_character(after);
        const auto number = fmt::format("U+{:04X}", static_cast<unsigned>(character));
        if (is_control(character))
            return fmt::format("contains the control character {}, which cannot be drawn", number);
        if (needs_shaping(character))
            return fmt::format(
                "contains \"{}\" ({}) of a script that Doppel cannot draw (joined or right-to-left letters)", lacking,
                number);
        auto letter = letters.size() == maximum ? "…" : fmt::format("\"{}\" ({})", lacking, number);
        if (std::find(letters.begin(), letters.end(), letter) == letters.end()) letters.push_back(std::move(letter));
        text.remove_prefix(static_cast<std::size_t>(lacking.data() + lacking.size() - text.data()));
    }
    if (letters.empty()) return std::nullopt;
    const auto rest =
        typeface.uses_system_fonts() ? "; no font of this system has them; give a font file in [video.fonts] text" : "";
    return fmt::format(
        "contains {}, which the built-in font lacks; it has Latin and Greek letters and signs of mathematics{}",
        fmt::join(letters, ", "), rest);
}

/// The group of tables whose keys are checked together: [video] and inner tables; all tables that describe sides.
std::string group_of(std::string_view name) {
    name.remove_prefix(std::min(name.find_first_not_of('['), name.size()));
    const auto table = name.substr(0, name.find_first_of(".]"));
    constexpr std::array<std::string_view, 4> of_sides{"system", "a", "b", "curve"};
    return std::string(std::find(of_sides.begin(), of_sides.end(), table) != of_sides.end() ? of_sides[0] : table);
}

constexpr std::size_t max_reported = 20;

bool meet(std::string_view group, std::string_view other) {
    return group == other || group.empty() || other.empty();
}

/// Whether the other error says enough: it has the same message, is about the key beside this one, or conflicts with the
/// same third key.
bool says_enough(const KeyError& other, const KeyError& error) {
    if (error.what() == std::string_view(other.what())) return true;
    if (!error.beside || !meet(error.group, other.group)) return false;
    const auto &key = *error.beside, &wrong = other.beside ? *other.beside : other.key;
    return key == wrong || key.empty() || wrong.empty();
}

}  // namespace

TomlReader::TomlReader(const toml::table* table, std::string name, std::string path, const TomlTexts& texts,
                       const Typeface* typeface, KeyErrors* errors)
    : table_(table),
      name_(std::move(name)),
      path_(std::move(path)),
      group_(group_of(name_)),
      texts_(&texts),
      typeface_(typeface),
      errors_(errors) {}

std::pair<std::string, ErrorPlace> TomlReader::place_of(std::string_view key) const {
    if (!table_) return {path_, no_place};
    const auto entry = table_->find(key);
    const bool is_given = entry != table_->end();
    const toml::node& holder = is_given ? entry->second : *table_;
    const bool is_placed = is_given || name_.starts_with("[[");  // one of several entries
    if (is_placed && is_typed(holder)) return {*holder.source().path, no_place};
    const auto& at = (is_given ? entry->first.source() : table_->source()).begin;
    const bool is_known = at.line > 0 && (is_given || !name_.empty());
    return {is_placed ? fmt::format("{}:{}:{}", path_, at.line, at.column) : path_,
            is_known ? ErrorPlace{at.line, at.column} : no_place};
}

void TomlReader::refuse(const KeyError& error) const {
    if (!errors_) throw KeyError(error);
    errors_->add(error);
}

const toml::node* TomlReader::find(std::string_view key) {
    known_.emplace(key);
    return table_ ? table_->get(key) : nullptr;
}

std::vector<std::pair<std::string_view, std::size_t>> TomlReader::elements_of(std::string_view key) const {
    std::vector<std::pair<std::string_view, std::size_t>> elements;
    if (!table_) return elements;
    for (auto&& [name, node] : *table_) {
        std::string list(name.str());
        std::optional<std::size_t> element;
        if (name.str().starts_with(key) && is_typed(node) && take_element(list, element) && element && list == key)
            elements.emplace_back(name.str(), *element);
    }
    return elements;
}

bool TomlReader::from_command_line(std::string_view key) {
    const auto* node = find(key);
    return node && is_typed(*node);
}

void TomlReader::require_drawable(std::string_view key, std::string_view text) const {
    const auto letters = static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char byte) { return (byte & 0xc0) != 0x80; }));
    if (letters > max_letters) throw error(key, "must have at most {} letters; it has {}", max_letters, letters);
    if (!typeface_) return;
    if (const auto lacking = not_drawable(text, *typeface_)) throw error(key, "{}", *lacking);
}

void TomlReader::require_title(const std::string& name) {
    if (has("title") || !typeface_) return;
    if (const auto error = not_drawable(name, *typeface_))
        refuse(error_at("title", fmt::format("title is missing, and the preset's name {}", *error)).with(""));
}

TomlReader TomlReader::inner(std::string_view key) {
    const auto* node = find(key);
    if (node && !node->is_table()) refuse(error(key, "must be a table; {}", found(*node)));
    return inner(node ? node->as_table() : nullptr, fmt::format("[{}]", inner_name(key)));
}

std::vector<TomlReader> TomlReader::entries(std::string_view key) {
    std::vector<TomlReader> all;
    const auto* node = find(key);
    if (!node) return all;
    const auto* array = node->as_array();
    if (!array || !array->is_array_of_tables()) {
        refuse(error(key, "must be written as [[{}]] tables; {}", inner_name(key), found(*node)));
        return all;
    }
    for (const auto& element : *array)
        all.push_back(inner(element.as_table(), fmt::format("[[{}]] {}", inner_name(key), all.size() + 1)));
    return all;
}

void TomlReader::finish() const {
    if (!table_) return;
    for (auto&& [name, node] : *table_) {
        if (known_.contains(name.str())) continue;
        const std::vector<std::string_view> keys(known_.begin(), known_.end());
        refuse(
            error_at(name.str(),
                     fmt::format("{} no \"{}\"; {}", name_.empty() ? "a preset has" : name_ + " has", name.str(),
                                 did_you_mean("", name.str(), keys, fmt::format("it has {}", fmt::join(keys, ", "))))));
    }
}

void TomlReader::table(std::string_view key, const std::function<void(KeyVisitor&)>& fields) {
    auto inside = inner(key);
    fields(inside);
    inside.finish();
}

void TomlReader::check_together(const std::function<void()>& check) const {
    if (!errors_) return check();
    if (errors_->concern(group_)) return;
    try {
        check();
    } catch (const KeyError& error) {
        refuse(error.with(""));
    }
}

bool TomlReader::counts(const Field& field) {
    const auto& only = field.only;
    if (only.applies || only.error.empty()) return true;
    if (has(field.key) && (!only.drops || from_command_line(field.key)))
        throw error(field.key, "{}", only.error).with(beside(only.beside));
    return false;
}

void TomlReader::require(const Field& field, bool given) const {
    if (!given && !field.needed_by.empty())
        throw error(field.key, "is missing; a {} needs it", field.needed_by).with(beside("kind"));
}

bool KeyErrors::concern(std::string_view group) const {
    return std::ranges::any_of(errors_, [&](const KeyError& error) { return meet(error.group, group); });
}

void KeyErrors::throw_if_any() const {
    auto errors = errors_;
    std::stable_partition(errors.begin(), errors.end(), [](const KeyError& error) { return !error.beside; });
    std::vector<KeyError> counting;
    for (const auto& error : errors)
        if (std::ranges::none_of(counting, [&](const KeyError& other) { return says_enough(other, error); }))
            counting.push_back(error);
    if (counting.empty()) return;
    std::ranges::stable_sort(counting, {}, &KeyError::place);
    std::vector<std::string> lines;
    for (const auto& error : counting) lines.emplace_back(error.what());
    if (lines.size() > max_reported) {
        const auto left = lines.size() - max_reported;
        lines.resize(max_reported);
        lines.push_back(fmt::format("and {} more", left));
    }
    throw Error(ExitCode::bad_input, lines.front(), {std::next(lines.begin()), lines.end()});
}

}  // namespace doppel
