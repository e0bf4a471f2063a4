#include "base/error.hpp"
#include "base/owned.hpp"
#include "output/png.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <string>
#include <string_view>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace doppel {
namespace {

/// The contents of the chunks of a PNG, by type.
using Chunks = std::map<std::string_view, std::string_view>;

/// Number `i` of the big-endian numbers in the text; 0 after its end.
std::int64_t number(std::string_view text, std::size_t i) {
    std::int64_t result = 0;
    if (text.size() >= 4 * (i + 1))
        for (const unsigned char byte : text.substr(4 * i, 4)) result = result << 8 | byte;
    return result;
}

Error undecodable(const std::filesystem::path& place, std::string_view why) {
    return io_failed("{}: cannot be decoded as PNG: {}", place.string(), why);
}

/// The chunks up to IEND. Throws Error (exit 4) if one is damaged.
Chunks chunks_of(std::string_view png, const std::filesystem::path& place) {
    constexpr std::size_t signature = 8, around = 12;  // length, type and checksum of a chunk
    Chunks chunks;
    for (std::size_t at = signature; at + 8 <= png.size() && !chunks.contains("IEND");) {
        const auto size = static_cast<std::size_t>(number(png.substr(at), 0));
        const auto type = png.substr(at + 4, 4);
        if (!std::ranges::all_of(type, [](unsigned char c) { return std::isalpha(c); }))
            throw undecodable(place, fmt::format("there is no chunk at byte {}", at));  // a sparse file reads as zeros
        if (size + around > png.size() - at)
            throw undecodable(place, fmt::format("the chunk at byte {} is longer than the file", at));
        if (libdeflate_crc32(0, type.data(), 4 + size) != number(png.substr(at + 8 + size), 0))
            throw undecodable(
                place, fmt::format("the checksum of its chunk {} at byte {} is wrong: it was damaged", type, at));
        chunks.emplace(type, png.substr(at + 8, size));
        at += around + size;
    }
    return chunks;
}

/// Whether the file can contain the pixels that its header states. stb_image allocates by the header before it reads on,
/// so a file of 100 bytes could take gigabytes. Source: Portable Network Graphics (W3C, 2003), 11.2.2; RFC 1951: DEFLATE
/// expands at most by 1032.
bool has_room(std::string_view header, std::int64_t bytes) {
    constexpr std::int64_t max_inflated = 1032;
    constexpr std::array channels{1, 1, 3, 1, 2, 1, 4};  // by the kind of colour
    if (header.size() < 10) return true;                 // no PNG
    const int bits = static_cast<unsigned char>(header[8]) * channels[std::min<std::size_t>(header[9], 6)];
    return number(header, 0) * bits / 8 <= max_inflated * bytes / std::max<std::int64_t>(number(header, 1), 1);
}

/// What the file states about its colours if they are not sRGB; empty otherwise. Golden comparison compares numbers, so
/// they must have the same meaning. Source: Portable Network Graphics, third edition (W3C, 2025), 4.3: the first
/// present of cICP, iCCP, sRGB, and gAMA with cHRM counts; 11.3.2.
std::string other_colors(const Chunks& chunks) {
    constexpr std::int64_t srgb_gamma = 45455;
    constexpr std::array<std::int64_t, 8> srgb_primaries{31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};
    if (const auto coded = chunks.find("cICP"); coded != chunks.end())
        return coded->second == std::string_view("\x1\xd\0\x1", 4) ? "" : "a colour space of its own (cICP)";
    if (chunks.contains("iCCP")) return "a colour profile (iCCP)";
    if (chunks.contains("sRGB")) return {};
    if (chunks.contains("gAMA"))
        if (const auto gamma = number(chunks.at("gAMA"), 0); std::abs(gamma - srgb_gamma) > 1)
            return fmt::format("gamma {:g} (gAMA {}, sRGB has {})", static_cast<double>(gamma) / 1e5, gamma,
                               srgb_gamma);
    if (chunks.contains("cHRM"))
        for (std::size_t i = 0; i < srgb_primaries.size(); ++i)
            if (std::abs(number(chunks.at("cHRM"), i) - srgb_primaries[i]) > 100)  // the tolerance of libpng
                return "primaries of its own (cHRM)";
    return {};
}

}  // namespace

Picture read_png(const std::filesystem::path& place) {
    const auto png = read_whole_file(place, png_file);
    auto chunks = chunks_of(png, place);
    if (const auto header = chunks["IHDR"]; !has_room(header, std::ssize(png)))
        throw undecodable(
            place, fmt::format("{}x{} pixels cannot be in {} bytes", number(header, 0), number(header, 1), png.size()));
    if (const auto colors = other_colors(chunks); !colors.empty())
        throw io_failed("{}: has {}; convert it to sRGB, as all pictures of Doppel are", place.string(), colors);
    Size size;
    int channels = 0;
    const Owned<stbi_uc, stbi_image_free> pixels(stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(png.data()),
                                                                       static_cast<int>(png.size()), &size.width,
                                                                       &size.height, &channels, 4));
    if (!pixels) throw undecodable(place, stbi_failure_reason());
    Picture picture(size);
    std::copy_n(pixels.get(), picture.rgba.size(), picture.rgba.begin());
    return picture;
}

}  // namespace doppel
