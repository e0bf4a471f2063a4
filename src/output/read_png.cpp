#include "base/error.hpp"
#include "output/png.hpp"

#include <libdeflate.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace doppel {
namespace {

std::uint64_t big_endian(const unsigned char* bytes) {
    return std::uint64_t{bytes[0]} << 24 | bytes[1] << 16 | bytes[2] << 8 | bytes[3];
}

Stream open_png(const std::filesystem::path& place) {
    std::error_code ignored;
    if (std::filesystem::status(place, ignored).type() == std::filesystem::file_type::not_found)
        throw bad_input("{}: there is no such file", place.string());
    return open_file(place);
}

/// Whether the chunk that begins with `start` ends with the right checksum. Its contents are the next bytes of `file`.
bool has_its_checksum(std::FILE* file, const unsigned char (&start)[8]) {
    std::array<unsigned char, std::size_t{1} << 16> block;
    std::uint32_t sum = libdeflate_crc32(0, start + 4, 4);
    for (std::uint64_t left = big_endian(start); left > 0;) {
        const auto wanted = std::min<std::uint64_t>(left, block.size());
        if (std::fread(block.data(), 1, wanted, file) != wanted) return false;
        sum = libdeflate_crc32(sum, block.data(), wanted);
        left -= wanted;
    }
    return std::fread(block.data(), 1, 4, file) == 4 && big_endian(block.data()) == sum;
}

/// Why the sizes stated in the file are impossible, or which part is damaged; empty if neither. stb_image allocates by
/// the stated sizes before it reads on, so a file of 100 bytes could take gigabytes. Source: Portable Network Graphics
/// (W3C, 2003), 5.3 and 11.2.2; RFC 1951: DEFLATE expands at most by 1032.
std::string impossible_claim(std::FILE* file, std::uint64_t bytes) {
    constexpr std::uint64_t signature = 8, around = 12;  // length, type and checksum of a chunk
    constexpr std::uint64_t max_inflated = 1032, max_bytes = std::uint64_t{1} << 30;
    if (bytes > max_bytes) return fmt::format("it has more than {} MB", max_bytes >> 20);
    unsigned char head[26];  // signature, length, type, width, height, bits, kind of colour
    if (std::fread(head, 1, sizeof head, file) == sizeof head) {
        const auto width = big_endian(head + 16), height = big_endian(head + 20);
        const std::uint64_t bits = head[24] * (head[25] == 2 ? 3U : head[25] == 4 ? 2U : head[25] == 6 ? 4U : 1U);
        if (width * bits / 8 > max_inflated * bytes / std::max<std::uint64_t>(height, 1))
            return fmt::format("{}x{} pixels cannot be in {} bytes", width, height, bytes);
    }
    for (std::uint64_t at = signature; at + 8 <= bytes;) {
        unsigned char start[8];  // length and type
        if (std::fseek(file, static_cast<long>(at), SEEK_SET) != 0 || std::fread(start, 1, 8, file) != 8) break;
        const std::string_view type(reinterpret_cast<const char*>(start + 4), 4);
        if (!std::ranges::all_of(type, [](unsigned char c) { return std::isalpha(c); }))
            return fmt::format("there is no chunk at byte {}", at);  // a sparse file reads as zeros
        if (big_endian(start) + around > bytes - at)
            return fmt::format("the chunk at byte {} is longer than the file", at);
        if (!has_its_checksum(file, start))
            return fmt::format("the checksum of its chunk {} at byte {} is wrong: it was damaged", type, at);
        if (type == "IEND") break;
        at += around + big_endian(start);
    }
    return {};
}

/// What the file states about its colours if they are not sRGB; empty otherwise. Golden comparison compares numbers, so
/// they must have the same meaning. Source: Portable Network Graphics, third edition (W3C, 2025), 4.3: the first
/// present of cICP, iCCP, sRGB, and gAMA with cHRM counts; 11.3.2.
std::string other_colors(std::FILE* file) {
    constexpr std::uint64_t srgb_gamma = 45455;
    constexpr std::array<std::uint64_t, 8> srgb_primaries{31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};
    std::string gamma, primaries, profile;
    bool is_srgb = false, is_coded_srgb = false;
    const auto near = [](std::uint64_t a, std::uint64_t b, std::uint64_t maximum) {
        return std::max(a, b) - std::min(a, b) <= maximum;
    };
    for (long at = 8; std::fseek(file, at, SEEK_SET) == 0;) {
        unsigned char chunk[8 + 32]{};  // length, type and the contents of these chunks
        if (std::fread(chunk, 1, sizeof chunk, file) < 8) break;
        const std::string_view type(reinterpret_cast<const char*>(chunk + 4), 4);
        const unsigned char* const content = chunk + 8;
        if (type == "IDAT" || type == "IEND") break;
        if (type == "sRGB") is_srgb = true;
        if (type == "iCCP") profile = "a colour profile (iCCP)";
        if (type == "cICP") {
            is_coded_srgb = content[0] == 1 && content[1] == 13 && content[2] == 0 && content[3] == 1;
            if (!is_coded_srgb) return "a colour space of its own (cICP)";
        }
        if (type == "gAMA" && !near(big_endian(content), srgb_gamma, 1))
            gamma = fmt::format("gamma {:g} (gAMA {}, sRGB has {})", static_cast<double>(big_endian(content)) / 1e5,
                                big_endian(content), srgb_gamma);
        if (type == "cHRM")
            for (std::size_t i = 0; i < srgb_primaries.size(); ++i)
                if (!near(big_endian(content + 4 * i), srgb_primaries[i], 100))  // the tolerance of libpng
                    primaries = "primaries of its own (cHRM)";
        at += static_cast<long>(12 + big_endian(chunk));
    }
    if (is_coded_srgb) return {};
    if (!profile.empty()) return profile;
    return is_srgb ? "" : !gamma.empty() ? gamma : primaries;
}

}  // namespace

Picture read_png(const std::filesystem::path& place) {
    const auto file = open_png(place);
    struct stat status {};
    if (fstat(fileno(file.get()), &status) != 0) throw cannot(place, "read");
    const auto claim = impossible_claim(file.get(), static_cast<std::uint64_t>(status.st_size));
    if (!claim.empty()) throw io_failed("{}: cannot be decoded as PNG: {}", place.string(), claim);
    if (const auto colors = other_colors(file.get()); !colors.empty())
        throw io_failed("{}: has {}; convert it to sRGB, as all pictures of Doppel are", place.string(), colors);
    std::rewind(file.get());

    Size size;
    int channels = 0;
    const Owned<stbi_uc, stbi_image_free> pixels(
        stbi_load_from_file(file.get(), &size.width, &size.height, &channels, 4));
    if (!pixels) throw io_failed("{}: cannot be decoded as PNG: {}", place.string(), stbi_failure_reason());
    Picture picture(size);
    std::copy_n(pixels.get(), picture.rgba.size(), picture.rgba.begin());
    return picture;
}

}  // namespace doppel
