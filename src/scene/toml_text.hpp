#pragma once

#include <toml++/toml.h>

#include <cstddef>
#include <map>
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

// Words for errors.

std::string kind_of(const toml::node& node);  // "a whole number"
std::string shown(const toml::node& node);    // the value as TOML writes it, on one line and not too long
std::string found(const toml::node& node);    // "it is a whole number (3)"

}  // namespace doppel
