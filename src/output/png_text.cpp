#include "output/png_text.hpp"

#include <libdeflate.h>

#include <cstdint>
#include <optional>
#include <string_view>

namespace doppel {
namespace {

std::string big_endian(std::uint32_t number) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 0xff);
    return bytes;
}

std::string chunk(std::string_view type, std::string_view content) {
    const std::string checked = std::string(type).append(content);
    return big_endian(static_cast<std::uint32_t>(content.size())) + checked +
           big_endian(libdeflate_crc32(0, checked.data(), checked.size()));
}

std::string keyword(const std::string& key) {
    if (key == "encoder") return "Software";
    std::string word = key;
    if (!word.empty() && word[0] >= 'a' && word[0] <= 'z') word[0] = static_cast<char>(word[0] - 'a' + 'A');
    return word;
}

/// UTF-8 as Latin-1; nothing where a character is none of it.
std::optional<std::string> latin1(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto lead = static_cast<unsigned char>(text[i]);
        if (lead < 0x80) {
            result += text[i];
        } else if ((lead == 0xc2 || lead == 0xc3) && i + 1 < text.size()) {
            // U+0080 … U+00FF are two bytes
            result += static_cast<char>((lead & 3) << 6 | (text[++i] & 0x3f));
        } else {
            return std::nullopt;
        }
    }
    return result;
}

}  // namespace

// Portable Network Graphics (W3C, 2003), 11.3.4: a keyword ends with a zero; iTXt adds that it is not compressed, and
// an empty language and translation of the keyword.
std::string png_text_chunks(const Metadata& metadata) {
    std::string chunks;
    for (const auto& [key, text] : metadata) {
        const std::string start = keyword(key) + '\0';
        const auto short_text = latin1(text);
        chunks += short_text ? chunk("tEXt", start + *short_text) : chunk("iTXt", start + std::string(4, '\0') + text);
    }
    return chunks;
}

}  // namespace doppel
