#include "fuzz/mutation.hpp"

#include <array>
#include <cctype>
#include <string_view>

namespace doppel::test {
namespace {

/// A random number below `end`; the distributions of <random> differ between libraries.
std::size_t below(std::size_t end, std::mt19937& random) {
    return end == 0 ? 0 : random() % end;
}

template <class List>
const auto& any_of(const List& list, std::mt19937& random) {
    return list[below(list.size(), random)];
}

bool in_token(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '+' || c == '.';
}

struct Span {
    std::size_t first, length;
};

/// The positions of words and numbers.
std::vector<Span> token_places(const std::string& text) {
    std::vector<Span> places;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t first = at;
        while (at < text.size() && in_token(text[at])) ++at;
        if (at > first) places.push_back({first, at - first});
        while (at < text.size() && !in_token(text[at])) ++at;
    }
    return places;
}

/// The positions of lines with their ends.
std::vector<Span> line_places(const std::string& text) {
    std::vector<Span> places;
    for (std::size_t first = 0; first < text.size();) {
        const auto end = text.find('\n', first);
        const auto last = end == std::string::npos ? text.size() : end + 1;
        places.push_back({first, last - first});
        first = last;
    }
    return places;
}

// clang-format off
constexpr std::array<std::string_view, 60> extremes{
    "0", "-0.0", "1", "-1", "2", "3", "7", "1e-300", "1e300", "-1e300", "1e-400", "1e400", "5e-324", "1e308",
    "inf", "-inf", "nan", "0x7f", "0b1", "0o17", "1_000", "1e5000", "0.1", "0.3", "1e-16", "1e16", "1e-20",
    "1e20", "2147483647", "2147483648", "-2147483648", "9223372036854775807", "-9223372036854775808",
    "9223372036854775808", "\"1/3\"", "\"1/0\"", "\"-1/3\"", "\"0/1\"", "\"1/9223372036854775807\"",
    "\"9223372036854775807\"", "\"1e9999\"", "\"\"", "\"\\u0000\"", "[]", "[1]", "[1, 2]", "[1, 2, 3]", "[[1]]",
    "[\"a\"]", "[{}]", "{}", "{ a = 1 }", "true", "false", "1979-05-27", "07:32:00", "1979-05-27T07:32:00Z",
    "\"\xc3\xa9\"", "10000", "10001"};
// clang-format on

constexpr std::array<std::string_view, 14> pieces{"[", "]", "=", "\n", "\"", "\"\"\"", "'",
                                                  ".", ",", "#", "[[", "{",  "}",      "\\"};

void change_once(std::string& text, const std::vector<std::string>& tokens, std::mt19937& random) {
    const auto token = any_of(token_places(text + "x"), random);
    const auto line = any_of(line_places(text + "\n"), random);
    const auto line_text = text.substr(std::min(line.first, text.size()), line.length);
    switch (below(10, random)) {
        case 0:
        case 1:
        case 2:
            text.replace(std::min(token.first, text.size()), token.length, any_of(extremes, random));
            break;
        case 3:
            text.replace(std::min(token.first, text.size()), token.length, any_of(tokens, random));
            break;
        case 4:
            text.erase(std::min(line.first, text.size()), line.length);
            break;
        case 5:
            text.insert(any_of(line_places(text + "\n"), random).first, line_text);
            break;
        case 6:
            if (!text.empty()) text[below(text.size(), random)] ^= static_cast<char>(1u << below(8, random));
            break;
        case 7:
            text.insert(below(text.size() + 1, random), any_of(pieces, random));
            break;
        case 8:
            if (below(8, random) == 0) text.resize(below(text.size() + 1, random));
            break;
        default:
            text += "\n#--set " + any_of(tokens, random) + "." + any_of(tokens, random) + "=" +
                    std::string(any_of(extremes, random)) + "\n";
    }
}

void damage_once(std::string& bytes, std::mt19937& random) {
    const auto at = below(bytes.size(), random), length = 1 + below(8, random);
    switch (below(7, random)) {
        case 0:
            if (!bytes.empty()) bytes[at] ^= static_cast<char>(1u << below(8, random));
            break;
        case 1:
            if (!bytes.empty()) bytes[at] = static_cast<char>(below(256, random));
            break;
        case 2:
            if (!bytes.empty()) bytes[at] = static_cast<char>('0' + below(10, random));
            break;
        case 3:
            bytes.erase(at, length);
            break;
        case 4:
            bytes.insert(at, bytes.substr(at, length));
            break;
        case 5: {
            const auto token = any_of(token_places(bytes + "x"), random);
            bytes.replace(std::min(token.first, bytes.size()), token.length, any_of(extremes, random));
            break;
        }
        default:
            if (below(4, random) == 0) bytes.resize(at);
    }
}

}  // namespace

std::vector<std::string> tokens_of(const std::vector<std::string>& texts) {
    std::vector<std::string> tokens;
    for (const auto& text : texts)
        for (const auto& place : token_places(text)) tokens.push_back(text.substr(place.first, place.length));
    return tokens;
}

std::string mutated(std::string text, const std::vector<std::string>& tokens, std::mt19937& random) {
    for (std::size_t changes = 1 + below(4, random); changes > 0; --changes) change_once(text, tokens, random);
    return text;
}

std::string damaged(std::string bytes, std::mt19937& random) {
    for (std::size_t changes = 1 + below(4, random); changes > 0; --changes) damage_once(bytes, random);
    return bytes;
}

}  // namespace doppel::test
