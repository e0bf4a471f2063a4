#include "base/error.hpp"
#include "output/png.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <system_error>

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

/// Why the sizes in the file are impossible; "" where they are not. stb_image allocates by the length of a chunk and by
/// the size in the header before it reads on, so a file of a hundred bytes could take gigabytes.
/// Source  Portable Network Graphics (W3C, 2003), 5.3 and 11.2.2; RFC 1951: DEFLATE makes at most 1032 bytes of one.
std::string impossible_claim(std::FILE* file, std::uint64_t bytes) {
    constexpr std::uint64_t signature = 8, around = 12;  // length, type and checksum of a chunk
    constexpr std::uint64_t most_inflated = 1032;
    unsigned char head[26];  // signature, length, type, width, height, bits, kind of colour
    if (std::fread(head, 1, sizeof head, file) == sizeof head) {
        const auto width = big_endian(head + 16), height = big_endian(head + 20);
        const std::uint64_t bits = head[24] * (head[25] == 2 ? 3U : head[25] == 4 ? 2U : head[25] == 6 ? 4U : 1U);
        if (width * bits / 8 > most_inflated * bytes / std::max<std::uint64_t>(height, 1))
            return fmt::format("{}x{} pixels cannot be in {} bytes", width, height, bytes);
    }
    for (std::uint64_t at = signature; at + 8 <= bytes;) {
        unsigned char chunk[8];  // length and type
        if (std::fseek(file, static_cast<long>(at), SEEK_SET) != 0 || std::fread(chunk, 1, 8, file) != 8) break;
        if (std::string_view(reinterpret_cast<const char*>(chunk + 4), 4) == "IEND") break;
        if (big_endian(chunk) + around > bytes - at)
            return fmt::format("the chunk at byte {} is longer than the file", at);
        at += around + big_endian(chunk);
    }
    std::rewind(file);
    return {};
}

}  // namespace

Picture read_png(const std::filesystem::path& path) {
    const Stream file(std::fopen(path.c_str(), "rb"));
    if (!file && errno == ENOENT) throw bad_input("{}: there is no such file", path.string());
    if (!file) throw io_failed("{}: cannot be read: {}", path.string(), std::generic_category().message(errno));
    std::error_code fault;
    const auto bytes = std::filesystem::file_size(path, fault);
    if (fault) throw io_failed("{}: cannot be read: {}", path.string(), fault.message());
    if (const auto claim = impossible_claim(file.get(), bytes); !claim.empty())
        throw io_failed("{}: cannot be decoded as PNG: {}", path.string(), claim);

    Size size;
    int channels = 0;
    const Owned<stbi_uc, stbi_image_free> pixels(
        stbi_load_from_file(file.get(), &size.width, &size.height, &channels, 4));
    if (!pixels) throw io_failed("{}: cannot be decoded as PNG: {}", path.string(), stbi_failure_reason());
    Picture picture(size);
    std::copy_n(pixels.get(), picture.rgba.size(), picture.rgba.begin());
    return picture;
}

}  // namespace doppel
