#include "output/png.hpp"

#include "base/error.hpp"
#include "base/machine.hpp"
#include "base/text.hpp"
#include "output/samples.hpp"
#include "output/workers.hpp"

extern "C" {
#include <libavutil/base64.h>
}

#include <libdeflate.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
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

// Portable Network Graphics (W3C, 2003)

std::string big_endian(std::uint32_t number) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 0xff);
    return bytes;
}

void add_chunk(std::string& png, std::string_view type, std::string_view content) {
    const auto sum = libdeflate_crc32(0, type.data(), type.size());
    png.append(big_endian(static_cast<std::uint32_t>(content.size()))).append(type).append(content);
    png += big_endian(libdeflate_crc32(sum, content.data(), content.size()));
}

std::string keyword(const std::string& key) {
    if (key == "encoder") return "Software";
    std::string word = key;
    if (!word.empty() && word[0] >= 'a' && word[0] <= 'z') word[0] = static_cast<char>(word[0] - 'a' + 'A');
    return word;
}

/// UTF-8 as Latin-1; nothing where a character is not in it.
std::optional<std::string> latin1(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const char32_t character = next_character(text);
        if (character > 0xff) return std::nullopt;
        result += static_cast<char>(character);
    }
    return result;
}

/// Of a row with the number of its filter before it.
std::size_t row_bytes(Size size, const PngOptions& options) {
    return 1 + (options.with_alpha ? std::size_t{4} : std::size_t{3}) * static_cast<std::size_t>(size.width);
}

/// The rows of a picture, unfiltered: flat colours compress best so; any filter takes 1.7 times as long for a larger
/// file.
void put_rows(const Picture& picture, const PngOptions& options, Buffer& rows) {
    const auto [width, height] = picture.size;
    const auto format = options.with_alpha ? AV_PIX_FMT_RGBA : AV_PIX_FMT_RGB24;
    const std::size_t bytes = row_bytes(picture.size, options);
    std::uint8_t* row = rows.make_room(bytes * static_cast<std::size_t>(height));
    for (int y = 0; y < height; ++y, row += bytes) {
        row[0] = 0;
        convert(picture, {0, y, width, y + 1}, format, row + 1);
    }
}

/// The bytes of the file of a picture's rows. `path` is for messages.
std::string encoded(const std::filesystem::path& path, Size size, const Buffer& rows, const PngOptions& options) {
    // other levels take 1.8 times as long for a file 2 to 5 % smaller: see tests/output/png_test.cpp
    constexpr int level = 1;
    thread_local const Owned<libdeflate_compressor, libdeflate_free_compressor> compressor(
        libdeflate_alloc_compressor(level));
    thread_local Buffer compressed;
    const std::size_t bytes = row_bytes(size, options) * static_cast<std::size_t>(size.height);
    if (!compressor || bytes > std::numeric_limits<std::int32_t>::max())
        throw io_failed("{}: a picture of {}x{} px cannot be compressed", path.string(), size.width, size.height);
    const std::size_t bound = libdeflate_zlib_compress_bound(compressor.get(), bytes);
    auto* const data = compressed.make_room(bound);
    const auto count = libdeflate_zlib_compress(compressor.get(), rows.data(), bytes, data, bound);
    std::string png = "\x89PNG\r\n\x1a\n";
    add_chunk(png, "IHDR",
              big_endian(static_cast<std::uint32_t>(size.width)) + big_endian(static_cast<std::uint32_t>(size.height)) +
                  '\x8' + (options.with_alpha ? '\x6' : '\x2') + std::string(3, '\0'));
    png += png_text_chunks(options.metadata);
    if (options.dpi > 0) {  // 11.3.5.3, the size of a pixel
        const auto per_m = big_endian(static_cast<std::uint32_t>(std::lround(options.dpi / 0.0254)));
        add_chunk(png, "pHYs", per_m + per_m + '\1');  // the unit is the metre
    }
    add_chunk(png, "IDAT", {reinterpret_cast<const char*>(data), count});
    add_chunk(png, "IEND", "");
    return png;
}

class PngSink final : public Sink {
public:
    PngSink(std::function<std::filesystem::path(long)> place_of, std::size_t threads, PngOptions options,
            const std::atomic<bool>& stop)
        : place_of_(std::move(place_of)),
          options_(std::move(options)),
          stop_(stop),
          writers_(threads, threads, [this](Job& job) { write(job); }) {}

    void take(const Picture& picture, const std::vector<Rect>& /*changed*/) override {
        Job job{place_of_(taken_++), picture.size, spare_.take()};
        put_rows(picture, options_, job.rows);
        writers_.give(std::move(job));
    }

    void finish() override { writers_.finish(); }

private:
    struct Job {
        std::filesystem::path place;
        Size size;
        Buffer rows;
    };

    void write(Job& job) {
        throw_if_set(stop_);
        write_file(job.place, encoded(job.place, job.size, job.rows, options_));
        spare_.give_back(std::move(job.rows));
    }

    const std::function<std::filesystem::path(long)> place_of_;
    const PngOptions options_;
    const std::atomic<bool>& stop_;
    long taken_ = 0;
    Pool<Buffer> spare_;
    Workers<Job> writers_;
};

// Reading.

std::uint64_t big_endian(const unsigned char* bytes) {
    return std::uint64_t{bytes[0]} << 24 | bytes[1] << 16 | bytes[2] << 8 | bytes[3];
}

constexpr std::size_t head_bytes = 26;  // signature, length, type, width, height, bits, kind of colour

Stream open_png(const std::filesystem::path& place) {
    std::error_code ignored;
    if (std::filesystem::status(place, ignored).type() == std::filesystem::file_type::not_found)
        throw bad_input("{}: there is no such file", place.string());
    return open_file(place);
}

/// Whether the chunk that starts so, and whose contents are read next, has the checksum at its end.
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

/// Why the sizes in the file are impossible, or which part of it is damaged; "" where they are not. stb_image allocates by the length of a chunk and by
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
        unsigned char start[8];  // length and type
        if (std::fseek(file, static_cast<long>(at), SEEK_SET) != 0 || std::fread(start, 1, 8, file) != 8) break;
        const std::string_view type(reinterpret_cast<const char*>(start + 4), 4);
        if (!std::ranges::all_of(type, [](unsigned char c) { return std::isalpha(c); }))
            return fmt::format("there is no chunk at byte {}", at);  // zeros of a sparse file
        if (big_endian(start) + around > bytes - at)
            return fmt::format("the chunk at byte {} is longer than the file", at);
        if (!has_its_checksum(file, start))
            return fmt::format("the checksum of its chunk {} at byte {} is wrong: it was damaged", type, at);
        if (type == "IEND") break;
        at += around + big_endian(start);
    }
    return {};
}

/// What a picture says of its colours other than sRGB; "" where nothing. Its numbers are compared as they are, so that
/// they have to mean the same.
/// Source  Portable Network Graphics, third edition (W3C, 2025), 4.3: of cICP, iCCP, sRGB and gAMA with cHRM the first
/// that is there counts; 11.3.2.
std::string other_colors(std::FILE* file) {
    constexpr std::uint64_t srgb_gamma = 45455;
    constexpr std::array<std::uint64_t, 8> srgb_primaries{31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};
    std::string gamma, primaries, profile;
    bool is_srgb = false, is_coded_srgb = false;
    const auto near = [](std::uint64_t a, std::uint64_t b, std::uint64_t most) {
        return std::max(a, b) - std::min(a, b) <= most;
    };
    for (long at = 8; std::fseek(file, at, SEEK_SET) == 0;) {
        unsigned char chunk[8 + 32]{};  // length, type and what these have
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
                if (!near(big_endian(content + 4 * i), srgb_primaries[i], 100))  // as libpng
                    primaries = "primaries of its own (cHRM)";
        at += static_cast<long>(12 + big_endian(chunk));
    }
    if (is_coded_srgb) return {};
    if (!profile.empty()) return profile;
    return is_srgb ? "" : !gamma.empty() ? gamma : primaries;
}

}  // namespace

// 11.3.4: a keyword ends with a zero; iTXt adds that it is not compressed, and an empty language and translation of the
// keyword.
std::string png_text_chunks(const Metadata& metadata) {
    std::string chunks;
    for (const auto& [key, text] : metadata) {
        const std::string start = keyword(key) + '\0';
        if (const auto short_text = latin1(text))
            add_chunk(chunks, "tEXt", start + *short_text);
        else
            add_chunk(chunks, "iTXt", start + std::string(4, '\0') + text);
    }
    return chunks;
}

void write_png(const std::filesystem::path& place, const Picture& picture, const PngOptions& options,
               const std::atomic<bool>& stop) {
    Buffer rows;
    put_rows(picture, options, rows);
    throw_if_set(stop);
    write_file(place, encoded(place, picture.size, rows, options));
}

std::string png_bytes(const Picture& picture, const PngOptions& options) {
    Buffer rows;
    put_rows(picture, options, rows);
    return encoded("a PNG", picture.size, rows, options);
}

std::unique_ptr<Sink> make_png_sink(std::function<std::filesystem::path(long)> place_of, int threads,
                                    PngOptions options, const std::atomic<bool>& stop) {
    return std::make_unique<PngSink>(std::move(place_of), static_cast<std::size_t>(std::max(threads, 1)),
                                     std::move(options), stop);
}

int png_threads(int jobs, Size size) {
    // a thread's queued rows, its current ones, the compressed ones, and the file, with room to grow
    const std::size_t bytes = std::size_t{5} * 4 * static_cast<std::size_t>(size.width) * size.height;
    return static_cast<int>(affordable(bytes, static_cast<std::size_t>(jobs > 0 ? jobs : cores())));
}

Size png_size(const std::filesystem::path& place) {
    const auto file = open_png(place);
    unsigned char head[head_bytes];
    if (std::fread(head, 1, sizeof head, file.get()) != sizeof head ||
        std::string_view(reinterpret_cast<const char*>(head), 8) != "\x89PNG\r\n\x1a\n")
        throw io_failed("{}: cannot be decoded as PNG: not PNG", place.string());
    return {static_cast<int>(big_endian(head + 16)), static_cast<int>(big_endian(head + 20))};
}

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

std::string data_url(const std::filesystem::path& png) {
    const Stream file = open_file(png);
    std::string bytes(std::filesystem::file_size(png), '\0');
    if (std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) throw cannot(png, "read");
    return data_url("image/png", bytes);
}

std::string data_url(const Picture& picture, const PngOptions& options) {
    return data_url("image/png", png_bytes(picture, options));
}

std::string data_url(std::string_view type, std::string_view bytes) {
    auto url = fmt::format("data:{};base64,", type);
    const auto start = url.size();
    url.resize(start + AV_BASE64_SIZE(bytes.size()));
    av_base64_encode(&url[start], static_cast<int>(url.size() - start),
                     reinterpret_cast<const std::uint8_t*>(bytes.data()), static_cast<int>(bytes.size()));
    url.pop_back();  // the zero at its end
    return url;
}

}  // namespace doppel
