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

/// The tables whose keys mean something beside each other: [video] and those inside; all that describe sides.
std::string group_of(std::string_view name) {
    name.remove_prefix(std::min(name.find_first_not_of('['), name.size()));
    const auto table = name.substr(0, name.find_first_of(".]"));
    constexpr std::array<std::string_view, 4> of_sides{"system", "a", "b", "curve"};
    return std::string(std::find(of_sides.begin(), of_sides.end(), table) != of_sides.end() ? of_sides[0] : table);
}

}  // namespace

TomlReader::TomlReader(const toml::table* table, std::string name, std::string path, const TomlTexts& texts,
                       const Typeface* typeface, Faults* faults)
    : table_(table),
      name_(std::move(name)),
      path_(std::move(path)),
      group_(group_of(name_)),
      texts_(&texts),
      typeface_(typeface),
      faults_(faults) {}

/// Of the key's name, with the option of the command line that gave it; nothing where the key is absent.
std::optional<toml::source_region> TomlReader::source_of(std::string_view key) const {
    if (!table_) return std::nullopt;
    for (auto&& [name, node] : *table_) {
        if (name.str() != key) continue;
        const auto& origin = node.source().path;
        return origin && origin->starts_with(command_line) ? node.source() : name.source();
    }
    return std::nullopt;
}

std::string TomlReader::place(std::string_view key) const {
    const auto source = source_of(key);
    if (!source) return path_;
    if (source->path && source->path->starts_with(command_line)) return *source->path;
    return fmt::format("{}:{}:{}", path_, source->begin.line, source->begin.column);
}

FaultPlace TomlReader::fault_place(std::string_view key) const {
    const auto source = source_of(key);
    if (source && source->path && source->path->starts_with(command_line))
        return faults_ ? faults_->of_option(*source->path) : FaultPlace{};
    if (!table_ || (!source && name_.empty())) return {};
    const auto& at = (source ? *source : table_->source()).begin;
    return at.line > 0 ? FaultPlace{at.line, at.column} : FaultPlace{};
}

void TomlReader::note(std::string_view key, const Error& fault) const {
    const auto* known = dynamic_cast<const TomlFault*>(&fault);
    // a title says nothing of the tables
    faults_->add({fault.what(), fault_place(key), name_.empty() ? std::string(key) : group_, std::string(key),
                  known ? known->beside() : std::nullopt});
}

void TomlReader::refuse(const TomlFault& fault, std::string_view key) const {
    if (!faults_) throw TomlFault(fault);
    faults_->add({fault.what(), fault.place(), group_, std::string(key), fault.beside()});
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
    const auto letters = static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char byte) { return (byte & 0xc0) != 0x80; }));
    if (letters > most_letters) throw fault(key, "must have at most {} letters; it has {}", most_letters, letters);
    if (!typeface_) return;
    if (const auto lacking = not_drawable(text, *typeface_)) throw fault(key, "{}", *lacking);
}

void TomlReader::demand_title(const std::string& name) {
    if (has("title") || !typeface_) return;
    if (const auto fault = not_drawable(name, *typeface_))
        refuse({fmt::format("{}: title is missing, and the preset's name in its place {}", path_, *fault),
                {},
                BesideKeys{}},
               "title");
}

const toml::table* TomlReader::read_table(std::string_view key) {
    const auto* node = find(key);
    if (node && !node->is_table()) refuse(fault(key, "must be a table; {}", found(*node)), key);
    return node ? node->as_table() : nullptr;
}

std::vector<const toml::table*> TomlReader::read_tables(std::string_view key) {
    std::vector<const toml::table*> tables;
    const auto* node = find(key);
    if (!node) return tables;
    const auto* array = node->as_array();
    if (!array || !array->is_array_of_tables()) {
        refuse(fault(key, "must be written as [[{}{}{}]] tables; {}", bare_name(), name_.empty() ? "" : ".", key,
                     found(*node)),
               key);
        return tables;
    }
    for (const auto& element : *array) tables.push_back(element.as_table());
    return tables;
}

void TomlReader::finish() const {
    if (!table_) return;
    for (auto&& [name, node] : *table_) {
        if (known_.contains(name.str())) continue;
        const std::vector<std::string_view> keys(known_.begin(), known_.end());
        const auto meant = nearest(name.str(), keys);
        const auto message = fmt::format(
            "{}: {} no \"{}\"; {}", place(name.str()), name_.empty() ? "a preset has" : name_ + " has", name.str(),
            meant ? fmt::format("did you mean \"{}\"?", *meant) : fmt::format("it has {}", fmt::join(keys, ", ")));
        const auto hidden = hidden_.find(name.str());
        refuse({message, fault_place(name.str()),
                hidden == hidden_.end() ? std::nullopt : std::optional(beside(hidden->second))},
               name.str());
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

void TomlReader::read(const Field& field, const toml::node& node, Color& into) {
    const auto* text = node.as_string();
    const auto color = text ? parse_color(text->get()) : std::nullopt;
    if (!color) throw fault(field.key, "must be a colour such as \"#ff9f40\"; {}", found(node));
    into = *color;
}

void TomlReader::read(const Field& field, const toml::node& node, std::array<Color, 2>& into) {
    const auto colors = texts_in(field, node);
    if (colors.size() != 2) throw fault(field.key, "must have 2 colours, a and b; it has {}", colors.size());
    for (std::size_t i = 0; i < 2; ++i) {
        const auto color = parse_color(colors[i]);
        if (!color) throw fault(field.key, "must be colours such as \"#ff9f40\"; [{}] is \"{}\"", i, colors[i]);
        into[i] = *color;
    }
}

/// "pendulums" and the strips, in their order.
void TomlReader::read(const Field& field, const toml::node& node, Panels& into) {
    const auto panels = texts_in(field, node);
    const auto& names = names_of<StripKind>;
    into = {false, {}};
    for (const auto& panel : panels) {
        const auto strip = std::find(names.begin(), names.end(), panel);
        if (panel == "pendulums") {
            into.pendulums = true;
        } else if (strip == names.end()) {
            throw fault(field.key, "may hold \"pendulums\", \"{}\"; \"{}\" is none of them", fmt::join(names, "\", \""),
                        panel);
        } else if (const auto kind = static_cast<StripKind>(strip - names.begin());
                   std::find(into.strips.begin(), into.strips.end(), kind) == into.strips.end()) {
            into.strips.push_back(kind);
        }
    }
    if (panels.empty())
        throw fault(field.key, "must hold at least one of \"pendulums\", \"{}\"", fmt::join(names, "\", \""));
}

}  // namespace doppel
