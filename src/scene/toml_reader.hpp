#pragma once

#include "base/error.hpp"
#include "image/color.hpp"
#include "numeric/quad.hpp"
#include "numeric/rational.hpp"
#include "scene/toml_text.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

/// Reads one table of a preset key by key. Every read_… leaves its target alone where the key is absent, and throws
/// Error (exit 2) with place, value and what would be right where it is of the wrong kind. finish() finds the keys
/// nobody asked for.
class TomlReader {
public:
    /// `name` = how errors call it, "[video]"; `table` may be null: then all keys are absent.
    TomlReader(const toml::table* table, std::string name, std::string path, const TomlTexts& texts);

    bool has(std::string_view key);
    void read_text(std::string_view key, std::string& into);
    /// Text that pictures show: of letters that the font has.
    void read_drawn(std::string_view key, std::string& into);
    /// `title`; the name that stands in `into` where it is absent is drawn as well.
    void read_drawn_title(std::string& into);
    /// Throws where the font lacks a letter of `text`, the value of `key`.
    void demand_drawable(std::string_view key, std::string_view text) const;
    void read_choice(std::string_view key, std::string& into, std::span<const std::string_view> choices);
    /// A choice by name, for an enumeration in the order of its names.
    template <class Choice, std::size_t N>
    void read_enumerated(std::string_view key, Choice& into, const std::array<std::string_view, N>& names) {
        std::string name(names[static_cast<std::size_t>(into)]);
        read_choice(key, name, names);
        into = static_cast<Choice>(std::find(names.begin(), names.end(), name) - names.begin());
    }
    void read_whole(std::string_view key, int& into, int least, int most);
    void read_truth(std::string_view key, bool& into);
    /// A number, or "a/b" in quotes; > 0.
    void read_positive_ratio(std::string_view key, Rational& into);
    /// The same, or 0.
    void read_ratio_from_zero(std::string_view key, Rational& into);
    void read_number(std::string_view key, double& into);  // finite
    void read_positive(std::string_view key, double& into);
    void read_numbers(std::string_view key, std::span<double> into, std::string_view one_each);
    void read_positives(std::string_view key, std::span<double> into, std::string_view one_each);
    /// The same to all digits of what is written.
    void read_number(std::string_view key, Quad& into);
    void read_positive(std::string_view key, Quad& into);
    /// One number for all, or an array with one each.
    void read_numbers(std::string_view key, std::span<Quad> into, std::string_view one_each);
    void read_positives(std::string_view key, std::span<Quad> into, std::string_view one_each);
    /// An array of 1 to `most` numbers > 0.
    void read_positive_list(std::string_view key, std::vector<double>& into, std::size_t most);
    std::optional<std::vector<std::string>> read_texts(std::string_view key);
    /// "#rrggbb"
    void read_color(std::string_view key, Color& into);
    const toml::table* read_table(std::string_view key);
    /// The tables of [[key]]; none where it is absent.
    std::vector<const toml::table*> read_tables(std::string_view key);
    /// Two numbers, x and y.
    void read_pair(std::string_view key, std::array<Quad, 2>& into);
    bool is_text(std::string_view key);
    /// The name without brackets, "system".
    std::string_view bare_name() const {
        return name_.empty() ? name_ : std::string_view(name_).substr(1, name_.size() - 2);
    }
    /// A reader of a table inside this one, for errors called `name`.
    TomlReader inner(const toml::table* table, std::string name) const {
        return {table, std::move(name), path_, *texts_};
    }
    /// Whether the key was given on the command line, and not in the preset's file.
    bool from_command_line(std::string_view key);

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
    std::string subject(std::string_view key) const;
    std::optional<Rational> ratio(std::string_view key);
    double number(std::string_view key, std::string_view element, const toml::node& node) const;
    Quad exact(std::string_view key, std::string_view element, const toml::node& node) const;

    const toml::table* table_;
    std::string name_, path_;
    const TomlTexts* texts_;
    std::set<std::string, std::less<>> known_;
};

}  // namespace doppel
