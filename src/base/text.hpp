#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

// Handling of text from outside: titles, names, paths. UTF-8.

/// Removes and returns the first character of `text`, which must not be empty. If it is malformed, removes one byte and
/// returns U+FFFD.
char32_t next_character(std::string_view& text);

/// Whether the text is well-formed UTF-8.
bool is_utf8(std::string_view text);

/// A character that a terminal may interpret: control characters of ASCII and Latin-1, line and paragraph separators,
/// and marks that change the direction of writing.
bool is_control(char32_t character);

/// The text as one line that any terminal can show. Control characters become spaces, malformed bytes become U+FFFD.
std::string on_one_line(std::string_view text);

/// The text escaped for XML 1.0 and HTML, between tags and in quotes: one line, without characters that XML forbids.
std::string markup(std::string_view text);

/// A name escaped as a part of a URL (RFC 3986): every byte except letters, digits and -._~ becomes %XX.
std::string in_address(std::string_view name);

/// At most the first `maximum` bytes of the text, cut between characters; "…" is appended if it was cut.
std::string shortened(std::string_view text, std::size_t maximum);

/// A size for people: "512 bytes", "64 kB", "1.5 MB", "2.0 GB", "17.6 TB".
std::string bytes_text(double bytes);
/// "2.5 s", "28 min", "16 h".
std::string duration_text(double seconds);

/// The candidate that differs from `word` by a typing error, if there is one.
std::optional<std::string> nearest(std::string_view word, std::span<const std::string_view> candidates);
/// The question after `before` whether the nearest candidate was meant, or `otherwise` if there is none.
std::string did_you_mean(std::string_view before, std::string_view word,
                         const std::vector<std::string_view>& candidates, std::string_view otherwise = "");

}  // namespace doppel
