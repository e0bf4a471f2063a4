#pragma once

#include "base/error.hpp"
#include "render/typeface.hpp"
#include "scene/faults.hpp"
#include "scene/member.hpp"

#include <toml++/toml.h>

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace doppel {

/// The text of a TOML document. Places that are asked for in their order are found soon, however long it is.
class TomlText {
public:
    explicit TomlText(std::string text) : text_(std::move(text)) {}

    const std::string& text() const { return text_; }
    /// The number that stands at a line and column (counted in characters, from 1), without its underscores.
    std::string literal_at(std::size_t line, std::size_t column) const;

private:
    struct Place {
        std::size_t line = 1, column = 1, offset = 0;  // bytes
    };

    std::string text_;
    mutable Place last_;  // that was asked for
};

/// The text behind every document that was read, by the path its nodes carry: numbers mean their decimals, which only
/// the text still has.
using TomlTexts = std::map<std::string, TomlText>;

/// The number as it is written; nothing of what stands in no text.
std::optional<std::string> literal_of(const toml::node& node, const TomlTexts& texts);

/// Those of a decimal that tell it from others of its size: "9003" of "090.030e1".
std::string significant_digits(std::string_view decimal);

/// That of figures.
inline const Typeface built_in_typeface;

// Words for errors.

std::string kind_of(const toml::node& node);  // "a whole number"
std::string written(const toml::node& node);  // the value as TOML writes it
std::string shown(const toml::node& node);    // the same on one line and not too long
std::string found(const toml::node& node);    // "it is a whole number (3)"
/// Given on the command line: there, one number or text is a list of one.
bool is_typed(const toml::node& node);

/// Reads one table of a preset key by key: reader(field, member). A key that is absent leaves its member alone; one of
/// the wrong kind is an Error (exit 2) with place, value and what would be right. finish() finds the keys nobody asked
/// for. A reader with `faults` puts all that there, and leaves the member alone; one without throws at the first.
class TomlReader : public KeyVisitor {
public:
    /// `name` = how errors call it, "[video]"; `table` may be null: then all keys are absent.
    /// `typeface` = what texts are drawn in; null: not known, so that any text will do. It and `faults` stay where
    /// they are.
    TomlReader(const toml::table* table, std::string name, std::string path, const TomlTexts& texts,
               const Typeface* typeface = &built_in_typeface, Faults* faults = nullptr);

    bool has(std::string_view key);
    /// What the command line gives of elements of a list: the keys "mass_kg[1]", 1.
    std::vector<std::pair<std::string_view, std::size_t>> elements_of(std::string_view key) const;
    /// Whether the key was given on the command line, and not in the preset's file.
    bool from_command_line(std::string_view key) override;

    /// A field with what belongs to it: whether it counts, and whether it must be there.
    void key(const Field& field, const KeyMember& member) override;
    /// The fields of [NAME.key], and no others.
    void table(std::string_view key, const std::function<void(KeyVisitor&)>& fields) override;

    /// Runs what looks at several keys and throws a TomlFault: a fault of several keys. Where these tables have
    /// faults already, nothing is checked.
    void check_together(const std::function<void()>& check) const;
    /// Takes note of the fault, or throws it.
    void refuse(const TomlFault& fault, std::string_view key) const;
    /// The other key of a fault of two, where it is given in this table; else it may be given elsewhere, or misspelt.
    std::string beside(std::string_view key) const {
        return table_ && table_->contains(key) ? std::string(key) : std::string();
    }

    /// Throws where `name`, which is shown where there is no title, has a letter that no font has.
    void require_title(const std::string& name);
    /// Throws where `text`, the value of `key`, has too many letters, or one that no font has.
    void require_drawable(std::string_view key, std::string_view text) const;
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
    FaultPlace fault_place(std::string_view key) const;
    /// "[table] KEY"
    std::string subject(std::string_view key) const;
    const TomlTexts& texts() const { return *texts_; }

private:
    const toml::node* find(std::string_view key);
    std::optional<toml::source_region> source_of(std::string_view key) const;
    void note(std::string_view key, const Error& fault) const;
    bool counts(const Field& field);
    void require(const Field& field, bool given) const;
    bool is_ruled_out(const Field& field) const;

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

/// "mass_kg[1]" → "mass_kg" and 1; false where the brackets hold no number.
bool take_element(std::string& key, std::optional<std::size_t>& element);

/// Throws Error (exit 2) with the place where the text is no TOML, a value is none, or a key is given twice.
TomlDocument parse_document(const PresetText& source, const std::vector<Override>& overrides);

}  // namespace doppel
