#include "base/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace doppel {
namespace {

constexpr char32_t replacement = 0xfffd;
constexpr std::string_view replacement_utf8 = "\xef\xbf\xbd";

/// The text with each character replaced by replace(character); characters for which it returns nothing stay.
template <class Replace>
std::string replaced(std::string_view text, const Replace& replace) {
    std::string result;
    while (!text.empty()) {
        const auto before = text;
        const std::optional<std::string_view> other = replace(next_character(text));
        result += other ? *other : before.substr(0, before.size() - text.size());
    }
    return result;
}

/// Edit distances (Levenshtein 1965) between a and the first 0, 1, 2 … letters of b.
std::vector<std::size_t> edit_distances(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0]++;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const auto swap = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({swap, row[j] + 1, diagonal + 1});
        }
    }
    return row;
}

}  // namespace

char32_t next_character(std::string_view& text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned first = byte(0);
    const std::size_t length = first < 0x80 ? 1 : first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    char32_t character = length <= 1 ? first : first & (0x7fu >> length);
    bool well_formed = length > 0 && first < 0xf5 && text.size() >= length;
    for (std::size_t i = 1; well_formed && i < length; ++i) {
        well_formed = (byte(i) & 0xc0u) == 0x80;
        character = character << 6 | (byte(i) & 0x3fu);
    }
    // refuses overlong encodings, surrogates, and values above U+10FFFF
    well_formed = well_formed && !(length == 3 && (character < 0x800 || (character >> 11) == 0x1b)) &&
                  !(length == 4 && (character < 0x10000 || character > 0x10ffff));
    text.remove_prefix(well_formed ? length : 1);
    return well_formed ? character : replacement;
}

bool is_utf8(std::string_view text) {
    while (!text.empty()) {
        const auto before = text.size();
        if (next_character(text) == replacement && before - text.size() == 1) return false;
    }
    return true;
}

bool is_control(char32_t c) {
    const auto within = [&](char32_t first, char32_t last) { return c >= first && c <= last; };
    return c < 0x20 || within(0x7f, 0x9f) || c == 0x61c || within(0x200e, 0x200f) || within(0x2028, 0x202e) ||
           within(0x2066, 0x2069);
}

std::string on_one_line(std::string_view text) {
    return replaced(text, [](char32_t character) -> std::optional<std::string_view> {
        if (is_control(character)) return " ";
        if (character == replacement) return replacement_utf8;  // U+FFFD also replaces a malformed byte
        return std::nullopt;
    });
}

std::string markup(std::string_view text) {
    return replaced(on_one_line(text), [](char32_t character) -> std::optional<std::string_view> {
        if (character == '&') return "&amp;";
        if (character == '<') return "&lt;";
        if (character == '>') return "&gt;";
        if (character == '"') return "&quot;";
        if (character == '\'') return "&#39;";
        if ((character & 0xfffe) == 0xfffe) return replacement_utf8;  // XML 1.0, 2.2: neither U+FFFE nor U+FFFF
        return std::nullopt;
    });
}

std::string in_address(std::string_view name) {
    std::string address;
    for (const char c : name) {
        const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                              std::string_view("-._~").find(c) != std::string_view::npos;
        address += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return address;
}

std::string shortened(std::string_view text, std::size_t maximum) {
    if (text.size() <= maximum) return std::string(text);
    while (maximum > 0 && (static_cast<unsigned char>(text[maximum]) & 0xC0) == 0x80)
        --maximum;  // do not cut within a character
    return std::string(text.substr(0, maximum)) + "…";
}

std::string bytes_text(double bytes) {
    if (bytes < 1e3) return fmt::format("{:.0f} bytes", bytes);
    if (bytes < 1e6) return fmt::format("{:.0f} kB", bytes / 1e3);
    if (bytes < 1e9) return fmt::format("{:.1f} MB", bytes / 1e6);
    return bytes < 1e12 ? fmt::format("{:.1f} GB", bytes / 1e9) : fmt::format("{:.1f} TB", bytes / 1e12);
}

std::string duration_text(double seconds) {
    constexpr double minute = 60, hour = 3600, many_hours = 10 * hour;
    return seconds < 99.5         ? fmt::format("{:.2g} s", seconds)
           : seconds < many_hours ? fmt::format("{:.0f} min", std::ceil(seconds / minute))
                                  : fmt::format("{:.0f} h", std::ceil(seconds / hour));
}

std::optional<std::string> nearest(std::string_view word, std::span<const std::string_view> candidates) {
    constexpr std::size_t longest = 100;  // longer texts are no typing errors
    if (word.size() > longest) return {};
    const auto whole = [&](std::string_view one) { return edit_distances(word, one).back(); };
    const auto start = [&](std::string_view one) { return std::ranges::min(edit_distances(word, one)); };
    const auto best = std::ranges::min_element(candidates, {}, whole);
    if (best == candidates.end()) return {};
    const auto errors = whole(*best);  // at least a letter is right
    if (errors <= std::max<std::size_t>(2, word.size() / 3) && errors < word.size()) return std::string(*best);
    // for example "gravity" as the start of "gravity_m_per_s2"
    const auto longer = std::ranges::min_element(candidates, {}, start);
    const bool is_start = word.size() > 2 && start(*longer) <= word.size() / 6;
    return is_start ? std::optional<std::string>(*longer) : std::nullopt;
}

std::string did_you_mean(std::string_view before, std::string_view word,
                         const std::vector<std::string_view>& candidates, std::string_view otherwise) {
    const auto meant = nearest(word, candidates);
    return meant ? fmt::format("{}did you mean \"{}\"?", before, *meant) : std::string(otherwise);
}

}  // namespace doppel
