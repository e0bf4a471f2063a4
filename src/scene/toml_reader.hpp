#pragma once

#include "base/error.hpp"
#include "render/typeface.hpp"
#include "scene/faults.hpp"
#include "scene/preset.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <initializer_list>
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

/// Those of a decimal that tell it from others of its size: "9003" of "090.030e1".
std::string significant_digits(std::string_view decimal);

/// That of figures.
inline const Typeface built_in_typeface;

// Words for errors.

std::string kind_of(const toml::node& node);  // "a whole number"
std::string written(const toml::node& node);  // the value as TOML writes it
std::string shown(const toml::node& node);    // the same on one line and not too long
std::string found(const toml::node& node);    // "it is a whole number (3)"

/// Reads one table of a preset key by key: reader(field, member). A key that is absent leaves its member alone; one of
/// the wrong kind is an Error (exit 2) with place, value and what would be right. finish() finds the keys nobody asked
/// for. A reader with `faults` puts all that there, and leaves the member alone; one without throws at the first.
class TomlReader {
public:
    /// `name` = how errors call it, "[video]"; `table` may be null: then all keys are absent.
    /// `typeface` = what texts are drawn in; null: not known, so that any text will do. It and `faults` stay where
    /// they are.
    TomlReader(const toml::table* table, std::string name, std::string path, const TomlTexts& texts,
               const Typeface* typeface = &built_in_typeface, Faults* faults = nullptr);

    bool has(std::string_view key);
    /// Whether the key was given on the command line, and not in the preset's file.
    bool from_command_line(std::string_view key);

    /// A field with what belongs to it: whether it counts, and whether it must be there.
    template <class T>
    void operator()(const Field& field, T& into) {
        attempt(field.key, into, [&](T& value) { read_field(field, value); });
    }
    /// The fields of [NAME.key], and no others.
    template <class Visit>
    void table(std::string_view key, const Visit& visit) {
        auto inside = inner(read_table(key), fmt::format("[{}.{}]", bare_name(), key));
        visit(inside);
        inside.finish();
    }

    /// Runs what looks at several keys and throws a TomlFault: a fault of several keys. Where these tables have
    /// faults already, nothing is checked.
    template <class Check>
    void check_together(const Check& check) const {
        if (!faults_) return check();
        if (faults_->concern(group_)) return;
        try {
            check();
        } catch (const TomlFault& fault) {
            refuse(fault.with(BesideKeys{}), "");
        }
    }
    /// Takes note of the fault, or throws it.
    void refuse(const TomlFault& fault, std::string_view key) const;
    /// The other key of a fault of two, where it is given in this table; else it may be given elsewhere, or misspelt.
    BesideKeys beside(std::string_view key) const {
        return {table_ && table_->contains(key) ? std::string(key) : std::string()};
    }

    /// Throws where `name`, which is shown where there is no title, has a letter that no font has.
    void demand_title(const std::string& name);
    /// Throws where `text`, the value of `key`, has too many letters, or one that no font has.
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
        return {table, std::move(name), path_, *texts_, typeface_, faults_};
    }

    /// An Error where the table has keys that were not asked for, which names the nearest that was.
    void finish() const;

    /// PATH:LINE:COLUMN: [table] KEY MESSAGE
    template <class... Args>
    [[nodiscard]] TomlFault fault(std::string_view key, fmt::format_string<Args...> format, Args&&... args) const {
        return {fmt::format("{}: {} {}", place(key), subject(key), fmt::format(format, std::forward<Args>(args)...)),
                fault_place(key)};
    }
    /// "path:line:column" of a key, the command line option that gave it, or the path where it is absent.
    [[nodiscard]] std::string place(std::string_view key) const;

private:
    const toml::node* find(std::string_view key);
    std::optional<toml::source_region> source_of(std::string_view key) const;
    FaultPlace fault_place(std::string_view key) const;
    void note(std::string_view key, const Error& fault) const;

    /// read(value) puts a value in place of `into`, unless it throws.
    template <class T, class Read>
    void attempt(std::string_view key, T& into, const Read& read) {
        if (!faults_) return read(into);
        try {
            auto value = into;
            read(value);
            into = std::move(value);
        } catch (const Error& fault) {
            if (fault.code() != ExitCode::bad_input) throw;
            note(key, fault);
        }
    }
    template <class T>
    void read_field(const Field& field, T& into) {
        if (!counts(field)) {
            if constexpr (is_optional<T>) into.reset();
            return;
        }
        const auto read_present = [&](auto& value) {
            if (const auto* node = find(field.key)) read(field, *node, value);
        };
        if constexpr (is_optional<T>) {
            if (has(field.key)) read_present(into.emplace());
            demand(field, into.has_value());
        } else if constexpr (std::is_enum_v<T>) {
            std::string name(name_of(into));
            if (const auto* node = find(field.key)) read({.key = field.key, .names = names_of<T>}, *node, name);
            into = value_named<T>(name);
        } else {
            read_present(into);
            if constexpr (requires { into.empty(); }) demand(field, !into.empty());
        }
    }
    void read(const Field& field, const toml::node& node, std::string& into);  // of `names`, if there are some
    void read(const Field& field, const toml::node& node, int& into);
    void read(const Field& field, const toml::node& node, bool& into);
    void read(const Field& field, const toml::node& node, double& into);    // finite
    void read(const Field& field, const toml::node& node, Quad& into);      // to all digits of what is written
    void read(const Field& field, const toml::node& node, Rational& into);  // a number, or "a/b" in quotes
    void read(const Field& field, const toml::node& node, std::span<double> into);
    void read(const Field& field, const toml::node& node,
              std::span<Quad> into);  // one number for all, or an array with one each
    void read(const Field& field, const toml::node& node, std::vector<Quad>& into);
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
    void read(const Field& field, const toml::node& node, TomlValues& into);  // 1 to `most`
    void read(const Field& field, const toml::node& node, Color& into);       // "#rrggbb"
    void read(const Field& field, const toml::node& node, std::array<Color, 2>& into);
    std::vector<std::string> texts_in(const Field& field, const toml::node& node) const;
    std::string subject(std::string_view key) const;
    bool counts(const Field& field);
    void demand(const Field& field, bool given) const;
    TomlFault faulty_number(const Field& field, double value, const TomlFault& fault) const;
    using Element = std::initializer_list<std::size_t>;  // {1} of key[1]; its text is made for errors alone
    double number(std::string_view key, Element element, const toml::node& node, double) const;
    Quad number(std::string_view key, Element element, const toml::node& node, const Quad&) const;
    template <class Number>
    void check(const Field& field, Element element, const Number& value) const;
    template <class Number>
    void read_array(const Field& field, const toml::node& node, std::span<Number> into);
    void read_whole_pair(const Field& field, const toml::node& node, std::string_view what, std::array<int, 2>& into);

    const toml::table* table_;
    std::string name_, path_, group_;
    const TomlTexts* texts_;
    const Typeface* typeface_;
    Faults* faults_;
    std::set<std::string, std::less<>> known_;
    std::map<std::string, std::string_view, std::less<>> hidden_;  // keys that do not count, and what decides
};

/// A preset's text as tables, with the command line's values in place.
struct TomlDocument {
    std::string path;  // what errors name
    toml::table root;
    TomlTexts texts;

    /// A reader of the keys outside of tables.
    TomlReader top(Faults* faults = nullptr, const Typeface* typeface = &built_in_typeface) const {
        return {&root, "", path, texts, typeface, faults};
    }
    /// A reader of the table [key], which may be absent.
    TomlReader table(TomlReader& above, std::string_view key) const {
        return above.inner(above.read_table(key), fmt::format("[{}]", key));
    }
};

/// Throws Error (exit 2) with the place where the text is no TOML, a value is none, or a key is given twice.
TomlDocument parse_document(const PresetText& source, const std::vector<Override>& overrides);

}  // namespace doppel
