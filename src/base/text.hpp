#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace doppel {

// Words from outside: titles, names, paths. UTF-8.

/// Takes the next character off the front of `text`, which is not empty: one byte, and U+FFFD, where it is not
/// well-formed.
char32_t next_character(std::string_view& text);

/// Whether all of it is well-formed.
bool is_utf8(std::string_view text);

/// A character that a terminal may obey rather than show: control characters of ASCII and of Latin-1, line and
/// paragraph separators, and marks that turn the direction of writing.
bool is_control(char32_t character);

/// The text as one line that any terminal can show: a space for every control character, U+FFFD for every byte that is
/// not well-formed.
std::string on_one_line(std::string_view text);

/// The text as XML 1.0 and HTML take it between tags and in quotes: on one line, without characters that XML forbids.
std::string markup(std::string_view text);

/// JSON as a script in a page takes it: nothing in it begins a tag or a comment.
std::string in_script(std::string json);

/// A name as a part of an address, RFC 3986: every byte but letters, digits and -._~ as %XX.
std::string in_address(std::string_view name);

/// The whole characters of its first `most` bytes, with "…" where there is more.
std::string shortened(std::string_view text, std::size_t most);

/// A size for people: "512 bytes", "64 kB", "1.5 MB", "2.0 GB", "17.6 TB".
std::string bytes_text(double bytes);

/// The candidate that is a typing error away from `word`, if there is one.
std::optional<std::string> nearest(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace doppel
