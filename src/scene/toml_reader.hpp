#pragma once

#include "numeric/error.hpp"
#include "numeric/rational.hpp"

#include <toml++/toml.h>

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
    TomlReader(const toml::table* table, std::string name, std::string path);

    bool has(std::string_view key);
    void read_text(std::string_view key, std::string& into);
    void read_choice(std::string_view key, std::string& into, std::span<const std::string_view> choices);
    void read_whole(std::string_view key, int& into, int least, int most);
    /// A number, or "a/b" in quotes; > 0.
    void read_positive_ratio(std::string_view key, Rational& into);
    void read_number(std::string_view key, double& into);  // finite
    void read_positive(std::string_view key, double& into);
    void read_numbers(std::string_view key, std::span<double> into, std::string_view one_each);
    void read_positives(std::string_view key, std::span<double> into, std::string_view one_each);
    std::optional<std::vector<std::string>> read_texts(std::string_view key);
    const toml::table* read_table(std::string_view key);

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
    double number(std::string_view key, std::string_view element, const toml::node& node) const;

    const toml::table* table_;
    std::string name_, path_;
    std::set<std::string, std::less<>> known_;
};

}  // namespace doppel
