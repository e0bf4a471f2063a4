#include "base/error.hpp"
#include "output/png.hpp"

#include <sys/stat.h>

#include <algorithm>
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

constexpr std::size_t head_bytes = 26;  // signature, length, type, width, height, bits, kind of colour

Stream open_png(const FilePlace& place) {
    struct stat status {};
    if (fstatat(place.descriptor(), place.name.c_str(), &status, 0) != 0 && errno == ENOENT)
        throw bad_input("{}: there is no such file", place.path.string());
    return stream_of(open_file(place), "rb", place.path, "read");
}

/// Why the sizes in the file are impossible; "" where they are not. stb_image allocates by the length of a chunk and by
/// the size in the header before it reads on, so a file of a hundred bytes could take gigabytes.
/// Source  Portable Network Graphics (W3C, 2003), 5.3 and 11.2.2; RFC 1951: DEFLATE makes at most 1032 bytes of one.
std::string impossible_claim(std::FILE* file, std::uint64_t bytes) {
    constexpr std::uint64_t signature = 8, around = 12;  // length, type and checksum of a chunk
    constexpr std::uint64_t most_inflated = 1032, most_bytes = std::uint64_t{1} << 30;
    if (bytes > most_bytes) return fmt::format("it has more than {} MB", most_bytes >> 20);
    unsigned char head[head_bytes];
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
        if (chunk[4] < 'A') return fmt::format("there is no chunk at byte {}", at);  // zeros of a sparse file
        if (big_endian(chunk) + around > bytes - at)
            return fmt::format("the chunk at byte {} is longer than the file", at);
        at += around + big_endian(chunk);
    }
    std::rewind(file);
    return {};
}

}  // namespace

Size png_size(const FilePlace& place) {
    const auto file = open_png(place);
    unsigned char head[head_bytes];
    if (std::fread(head, 1, sizeof head, file.get()) != sizeof head ||
        std::string_view(reinterpret_cast<const char*>(head), 8) != "\x89PNG\r\n\x1a\n")
        throw io_failed("{}: cannot be decoded as PNG: not PNG", place.path.string());
    return {static_cast<int>(big_endian(head + 16)), static_cast<int>(big_endian(head + 20))};
}

Picture read_png(const FilePlace& place) {
    const auto file = open_png(place);
    struct stat status {};
    if (fstat(fileno(file.get()), &status) != 0) throw cannot(place.path, "read");
    const auto claim = impossible_claim(file.get(), static_cast<std::uint64_t>(status.st_size));
    if (!claim.empty()) throw io_failed("{}: cannot be decoded as PNG: {}", place.path.string(), claim);

    Size size;
    int channels = 0;
    const Owned<stbi_uc, stbi_image_free> pixels(
        stbi_load_from_file(file.get(), &size.width, &size.height, &channels, 4));
    if (!pixels) throw io_failed("{}: cannot be decoded as PNG: {}", place.path.string(), stbi_failure_reason());
    Picture picture(size);
    std::copy_n(pixels.get(), picture.rgba.size(), picture.rgba.begin());
    return picture;
}

}  // namespace doppel
