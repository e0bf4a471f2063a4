#pragma once

#include "base/error.hpp"
#include "render/typeface.hpp"
#include "scene/preset.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

/// The text of a TOML document, in which places are found soon however long it is.
class TomlText {
public:
    explicit TomlText(std::string text);

    const std::string& text() const { return text_; }
    /// The number that stands at a line and column (counted in characters, from 1), without its underscores.
    std::string literal_at(std::size_t line, std::size_t column) const;

private:
    struct Place {
        std::size_t line, column, offset;  // bytes
        bool is_before(std::size_t other_line, std::size_t other_column) const {
            return line < other_line || (line == other_line && column < other_column);
        }
    };
    void step(Place& place) const;

    std::string text_;
    std::vector<Place> milestones_;  // every so many characters
};

/// The text behind every document that was read, by the path its nodes carry: numbers mean their decimals, which only
/// the text still has.
using TomlTexts = std::map<std::string, TomlText>;

/// That of figures.
inline const Typeface built_in_typeface;

// Words for errors.

std::string kind_of(const toml::node& node);  // "a whole number"
std::string shown(const toml::node& node);    // the value as TOML writes it, on one line and not too long
std::string found(const toml::node& node);    // "it is a whole number (3)"

/// Reads one table of a preset key by key: reader(field, member). A key that is absent leaves its member alone; one of
/// the wrong kind is an Error (exit 2) with place, value and what would be right. finish() finds the keys nobody asked
/// for.
class TomlReader {
public:
    /// `name` = how errors call it, "[video]"; `table` may be null: then all keys are absent.
    /// `typeface` = what texts are drawn in; it stays where it is.
    TomlReader(const toml::table* table, std::string name, std::string path, const TomlTexts& texts,
               const Typeface& typeface = built_in_typeface);

    bool has(std::string_view key);
    /// Whether the key was given on the command line, and not in the preset's file.
    bool from_command_line(std::string_view key);

    /// A field with what belongs to it: whether it counts, and whether it must be there.
    template <class T>
    void operator()(const Field& field, T& into) {
        if (!counts(field)) {
            if constexpr (is_optional<T>) into.reset();
            return;
        }
        if constexpr (is_optional<T>) {
            if (has(field.key)) read(field, into.emplace());
            demand(field, into.has_value());
        } else if constexpr (std::is_enum_v<T>) {
            std::string name(name_of(into));
            read({.key = field.key, .names = names_of<T>}, name);
            into = value_named<T>(name);
        } else {
            read(field, into);
            if constexpr (requires { into.empty(); }) demand(field, !into.empty());
        }
    }
    /// The fields of [NAME.key], and no others.
    template <class Visit>
    void table(std::string_view key, const Visit& visit) {
        auto inside = inner(read_table(key), fmt::format("[{}.{}]", bare_name(), key));
        visit(inside);
        inside.finish();
    }

    template <class T>
    void read(const Field& field, T&& into) {
        if (const auto* node = find(field.key)) read(field, *node, into);
    }

    /// Throws where `name`, which is shown where there is no title, has a letter that no font has.
    void demand_title(const std::string& name);
    /// Throws where no font has a letter of `text`, the value of `key`.
    void demand_drawable(std::string_view key, std::string_view text) const;
    const toml::table* read_table(std::string_view key);
    /// The tables of [[key]]; none where it is absent.
    std::vector<const toml::table*> read_tables(std::string_view key);

    /// The name without brackets, "system".
    std::string_view bare_name() const {
        return name_.empty() ? name_ : std::string_view(name_).substr(1, name_.size() - 2);
    }
    /// A reader of a table inside this one, for errors called `name`.
    TomlReader inner(const toml::table* table, std::string name) const {
        return {table, std::move(name), path_, *texts_, *typeface_};
    }

    /// Throws if the table has a key that was not asked for, and names the nearest that was.
    void finish() const;

    /// PATH:LINE:COLUMN: [table] KEY MESSAGE
    template <class... Args>
    [[nodiscard]] Error fault(std::string_view key, fmt::format_string<Args...> format, Args&&... args) const {
        return bad_input("{}: {} {}", place(key), subject(key), fmt::format(format, std::forward<Args>(args)...));
    }
    /// "path:line:column" of a key, the command line option that gave it, or the path where it is absent.
    [[nodiscard]] std::string place(std::string_view key) const;

private:
    const toml::node* find(std::string_view key);
    void read(const Field& field, const toml::node& node, std::string& into);  // of `names`, if there are some
    void read(const Field& field, const toml::node& node, int& into);
    void read(const Field& field, const toml::node& node, bool& into);
    void read(const Field& field, const toml::node& node, double& into);    // finite
    void read(const Field& field, const toml::node& node, Quad& into);      // to all digits of what is written
    void read(const Field& field, const toml::node& node, Rational& into);  // a number, or "a/b" in quotes
    void read(const Field& field, const toml::node& node, std::span<double> into);
    void read(const Field& field, const toml::node& node,
              std::span<Quad> into);  // one number for all, or an array with one each
    void read(const Field& field, const toml::node& node, std::vector<Quad>& into) {
        read(field, node, std::span(into));
    }
    void read(const Field& field, const toml::node& node, std::vector<double>& into);  // 1 to `most`
    void read(const Field& field, const toml::node& node,
              std::vector<std::string>& into);  // each of `names`, if there are some
    void read(const Field& field, const toml::node& node, QuadPair& into);
    void read(const Field& field, const toml::node& node, EndSpec& into);
    void read(const Field& field, const toml::node& node, Size& into);
    void read(const Field& field, const toml::node& node, std::array<int, 2>& into);
    void read(const Field& field, const toml::node& node, Range& into);
    void read(const Field& field, const toml::node& node, Panels& into);
    void read(const Field& field, const toml::node& node, Speed& into);
    void read(const Field& field, const toml::node& node, Members& into);
    void read(const Field& field, const toml::node& node, ChosenText& into);
    void read(const Field& field, const toml::node& node, Color& into);  // "#rrggbb"
    void read(const Field& field, const toml::node& node, std::array<Color, 2>& into);
    std::vector<std::string> texts_in(const Field& field, const toml::node& node) const;
    std::string subject(std::string_view key) const;
    bool counts(const Field& field);
    void demand(const Field& field, bool given) const;
    double number(std::string_view key, std::string_view element, const toml::node& node, double) const;
    Quad number(std::string_view key, std::string_view element, const toml::node& node, const Quad&) const;
    template <class Number>
    void check(const Field& field, std::string_view element, const Number& value) const;
    template <class Number>
    void read_array(const Field& field, const toml::node& node, std::span<Number> into);
    void read_whole_pair(const Field& field, const toml::node& node, std::string_view what, std::array<int, 2>& into);

    const toml::table* table_;
    std::string name_, path_;
    const TomlTexts* texts_;
    const Typeface* typeface_;
    std::set<std::string, std::less<>> known_;
};

/// A preset's text as tables, with the command line's values in place.
struct TomlDocument {
    std::string path;  // what errors name
    toml::table root;
    TomlTexts texts;

    /// A reader of the table [key], which may be absent.
    TomlReader table(TomlReader& above, std::string_view key) const {
        return above.inner(above.read_table(key), fmt::format("[{}]", key));
    }
};

/// Throws Error (exit 2) with the place where the text is no TOML, a value is none, or a key is given twice.
TomlDocument parse_document(const PresetText& source, const std::vector<Override>& overrides);

}  // namespace doppel
