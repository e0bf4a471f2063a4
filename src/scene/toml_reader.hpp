#pragma once

#include "base/error.hpp"
#include "render/typeface.hpp"
#include "scene/preset_fields.hpp"

#include <toml++/toml.h>

#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace doppel {

/// The text of a TOML document. Places are found quickly if they are requested in order.
class TomlText {
public:
    explicit TomlText(std::string text) : text_(std::move(text)) {}

    const std::string& text() const { return text_; }
    /// The number at a line and column (counted in characters, from 1), without its underscores.
    std::string literal_at(std::size_t line, std::size_t column) const;

private:
    struct Place {
        std::size_t line = 1, column = 1, offset = 0;  // bytes
    };

    std::string text_;
    mutable Place last_;  // last requested
};

/// The text of every document read, by the path that its nodes carry. Numbers mean their decimals, which only the text
/// contains.
using TomlTexts = std::map<std::string, TomlText>;

/// The number as written; nothing if the node has no text.
std::optional<std::string> literal_of(const toml::node& node, const TomlTexts& texts);

/// The significant digits of a decimal: "9003" for "090.030e1".
std::string significant_digits(std::string_view decimal);

inline const Typeface built_in_typeface;

// Texts for errors.

std::string kind_of(const toml::node& node);  // "a whole number"
std::string written(const toml::node& node);  // the value as TOML
std::string shown(const toml::node& node);    // the same on one line, shortened
std::string found(const toml::node& node);    // "it is a whole number (3)"
/// What a number must be, "> 0" or "from 1 to 10000 kg"; nothing if it is in range.
std::optional<std::string> missed_range(const Bounds& bounds, const Quad& number, std::string_view unit = "");
/// Whether it was given on the command line.
bool is_typed(const toml::node& node);

/// Sort key of an error: line and column in the file; errors without a line and of the command line come last.
using ErrorPlace = std::pair<std::size_t, std::size_t>;
inline constexpr ErrorPlace no_place{std::numeric_limits<std::size_t>::max(), 0};

/// An error in a key (exit 2). If the key is only wrong together with another key of the same table, that key is
/// `beside`; it may be the wrong one. An empty `beside` stands for any key of the group.
struct KeyError : Error {
    KeyError(const std::string& message, ErrorPlace at, std::string of_group, std::string_view of_key)
        : Error(ExitCode::bad_input, message), place(at), group(std::move(of_group)), key(of_key) {}

    /// The same error, caused together with other keys.
    KeyError with(std::string keys) const {
        auto error = *this;
        error.beside = std::move(keys);
        return error;
    }

    ErrorPlace place;
    std::string group, key;  // the tables that are checked together with its table
    std::optional<std::string> beside;
};

/// Collects the errors of a preset to report them together. Keys outside of tables, group "", belong to all groups. An
/// error of several keys is dropped if one of the other keys has an error itself. Of errors with the same other key,
/// only the first is kept, because that key may be wrong.
class KeyErrors {
public:
    void add(const KeyError& error) { errors_.push_back(error); }
    bool concern(std::string_view group) const;
    /// Throws one Error (exit 2) with all remaining errors, without duplicates, sorted by place. Returns if there is
    /// none.
    void throw_if_any() const;

private:
    std::vector<KeyError> errors_;
};

/// Reads one table of a preset key by key: reader(field, member). An absent key leaves its member unchanged. A wrong
/// one is an Error (exit 2) with place, value and what would be right. finish() reports keys that were not read. With
/// `errors`, errors are collected there, and members are unchanged; without, the first error is thrown.
class TomlReader : public KeyVisitor {
public:
    /// `name` = name in errors, "[video]"; `table` may be null: then all keys are absent. `typeface` = fonts of drawn
    /// texts; null: unknown, so that any text is allowed. It and `errors` must outlive the reader.
    TomlReader(const toml::table* table, std::string name, std::string path, const TomlTexts& texts,
               const Typeface* typeface = &built_in_typeface, KeyErrors* errors = nullptr);

    bool has(std::string_view key) { return find(key) != nullptr; }
    /// Elements of a list given on the command line: the keys "mass_kg[1]", 1.
    std::vector<std::pair<std::string_view, std::size_t>> elements_of(std::string_view key) const;
    /// Whether the key was given on the command line, and not in the preset's file.
    bool from_command_line(std::string_view key) override;

    /// Reads a field, and checks whether it applies or is required.
    void key(const Field& field, const KeyMember& member) override;
    void table(std::string_view key, const std::function<void(KeyVisitor&)>& fields) override;

    /// Runs a check of several keys, which throws KeyError. Skipped if these tables already have errors.
    void check_together(const std::function<void()>& check) const;
    /// Throws all errors of the preset if these tables have one.
    void throw_if_any() const {
        if (errors_ && errors_->concern(group_)) errors_->throw_if_any();
    }
    /// Records the error, or throws it.
    void refuse(const KeyError& error) const;
    /// Calls read(), whose errors in the input are errors of the key. Returns whether there was none.
    template <class Read>
    bool guarded(std::string_view key, const Read& read) const {
        try {
            read();
            return true;
        } catch (const Error& thrown) {
            if (thrown.code() != ExitCode::bad_input) throw;
            refuse(error(key, "{}", thrown.what()));
            return false;
        }
    }
    /// The other key of an error, if it is given in this table; otherwise empty: it may be given elsewhere, or
    /// misspelt.
    std::string beside(std::string_view key) const {
        return table_ && table_->contains(key) ? std::string(key) : std::string();
    }

    /// Throws if `name`, which is shown if there is no title, contains a letter that no font has.
    void require_title(const std::string& name);
    /// Throws if `text`, the value of `key`, is too long or contains a letter that no font has.
    void require_drawable(std::string_view key, std::string_view text) const;
    /// Readers of the tables of [[NAME.key]]; none if it is absent.
    std::vector<TomlReader> entries(std::string_view key);

    /// The name of an inner table, "system.pivot"; outside of tables and in an entry, the key itself.
    std::string inner_name(std::string_view key) const {
        const bool is_inside = !name_.empty() && !name_.starts_with("[[");
        return is_inside ? fmt::format("{}.{}", name_.substr(1, name_.size() - 2), key) : std::string(key);
    }
    /// A reader of the table [NAME.key]; it may be absent.
    TomlReader inner(std::string_view key);
    /// A reader of an inner table, called `name` in errors.
    TomlReader inner(const toml::table* table, std::string name) const {
        return {table, std::move(name), path_, *texts_, typeface_, errors_};
    }

    /// Throws Error if the table has keys that were not read, with the nearest known key.
    void finish() const;

    /// The error "PATH:LINE:COLUMN: [table] KEY MESSAGE".
    template <class... Args>
    [[nodiscard]] KeyError error(std::string_view key, fmt::format_string<Args...> format, Args&&... args) const {
        return error_at(key, fmt::format("{} {}", subject(key), fmt::format(format, std::forward<Args>(args)...)));
    }
    /// The error "PATH:LINE:COLUMN: MESSAGE" of a key.
    [[nodiscard]] KeyError error_at(std::string_view key, const std::string& message) const {
        const auto [place, order] = place_of(key);
        return {fmt::format("{}: {}", place, message), order, group_, key};
    }
    /// "path:line:column" of a key, the command line option that gave it, or the path if it is absent; and its place
    /// among other errors.
    std::pair<std::string, ErrorPlace> place_of(std::string_view key) const;
    std::string subject(std::string_view key) const {
        return name_.empty() ? std::string(key) : fmt::format("{} {}", name_, key);
    }
    const std::string& path() const { return path_; }
    const TomlTexts& texts() const { return *texts_; }

private:
    const toml::node* find(std::string_view key);
    bool counts(const Field& field);
    void require(const Field& field, bool given) const;

    const toml::table* table_;
    std::string name_, path_, group_;
    const TomlTexts* texts_;
    const Typeface* typeface_;
    KeyErrors* errors_;
    std::set<std::string, std::less<>> known_;
};

/// A preset as TOML tables, with the command line's values applied.
struct TomlDocument {
    std::string path;  // shown in errors
    toml::table root;
    TomlTexts texts;

    /// A reader of the keys outside of tables.
    TomlReader top(KeyErrors* errors = nullptr, const Typeface* typeface = &built_in_typeface) const {
        return {&root, "", path, texts, typeface, errors};
    }
};

/// Splits "mass_kg[1]" into "mass_kg" and 1; returns false if the brackets contain no number.
bool take_element(std::string& key, std::optional<std::size_t>& element);

/// Throws Error (exit 2) with the place if the text or a value is no TOML, or a key is given twice.
TomlDocument parse_document(const PresetText& source, const std::vector<Override>& overrides);

}  // namespace doppel
