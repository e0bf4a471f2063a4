#include "output/png.hpp"

#include "base/error.hpp"
#include "base/machine.hpp"
#include "output/files.hpp"
#include "output/samples.hpp"
#include "output/workers.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string>
#include <string_view>

namespace doppel {
namespace {

/// Memory for stb_image_write, reused by each thread: malloc would return these large blocks to the system each time,
/// and page faults would cost a third of the time. A block is valid until four others were taken.
std::uint8_t* next_block(std::size_t size) {
    thread_local std::array<Buffer, 4> blocks;  // of each picture: filtered rows, one row, compressed rows, the file
    thread_local std::size_t next = 0;
    return blocks[next++ % blocks.size()].make_room(size);
}

/// zlib's format by libdeflate, with the signature that stb_image_write requires.
unsigned char* compress(unsigned char* data, int length, int* compressed_length, int /*quality*/) {
    // higher levels take 1.8 times as long for files 2 to 5 % smaller: see tests/output/png_test.cpp
    constexpr int level = 1;
    thread_local const Owned<libdeflate_compressor, libdeflate_free_compressor> compressor(
        checked(libdeflate_alloc_compressor(level)));
    const std::size_t bound = libdeflate_zlib_compress_bound(compressor.get(), std::size_t(length));
    auto* const compressed = next_block(bound);
    *compressed_length =
        static_cast<int>(libdeflate_zlib_compress(compressor.get(), data, std::size_t(length), compressed, bound));
    return compressed;
}

}  // namespace
}  // namespace doppel

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBIW_ZLIB_COMPRESS doppel::compress
#define STBIW_MALLOC(size) doppel::next_block(size)
#define STBIW_REALLOC(block, size) (std::abort(), nullptr)  // only stb's own compressor would call it
#define STBIW_FREE(block) ((void)(block))
#include <stb_image_write.h>
#pragma GCC diagnostic pop

namespace doppel {
namespace {

// Portable Network Graphics (W3C, 2003)

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

std::string keyword(std::string key) {
    if (key == "encoder") return "Software";
    key[0] = static_cast<char>(std::toupper(key[0]));
    return key;
}

// flat colours compress best without a filter; any filter takes 1.7 times as long, and the file is larger
[[maybe_unused]] const int no_filter = stbi_write_force_png_filter = 0;

AVPixelFormat pixels_of(const PngOptions& options) {
    return options.with_alpha ? AV_PIX_FMT_RGBA : AV_PIX_FMT_RGB24;
}

/// The text chunks are inserted after signature and header.
constexpr std::size_t header_bytes = 8 + 25;

/// The samples of the picture in the format pixels_of(); reuses the memory of `samples`.
Buffer samples_of(const Picture& picture, const PngOptions& options, Buffer samples = {}) {
    const Rect all = all_of(picture.size);
    convert(picture, all, pixels_of(options), samples.make_room(byte_count(pixels_of(options), all)));
    return samples;
}

/// The bytes of the file.
std::string encoded(Size size, const Buffer& samples, const PngOptions& options) {
    const int channels = options.with_alpha ? 4 : 3;
    int count = 0;
    const auto* const bytes =
        stbi_write_png_to_mem(samples.data(), channels * size.width, size.width, size.height, channels, &count);
    std::string png(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(count));
    auto chunks = png_text_chunks(options.metadata);
    if (options.dpi > 0) {  // 11.3.5.3, the size of a pixel
        const auto per_m = big_endian(static_cast<std::uint32_t>(std::lround(options.dpi / 0.0254)));
        chunks += chunk("pHYs", per_m + per_m + '\1');  // the unit is the metre
    }
    return png.insert(header_bytes, chunks);
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
        writers_.give({place_of_(taken_++), picture.size, samples_of(picture, options_, writers_.spare().samples)});
    }

    void add(BlockFile& part) override {
        for (std::string bytes; part.next();) {
            throw_if_set(stop_);
            part(bytes);
            write_file(place_of_(taken_++), bytes);
        }
    }

    void finish() override { writers_.finish(); }

private:
    struct Job {
        std::filesystem::path place;
        Size size;
        Buffer samples;
    };

    void write(const Job& job) {
        throw_if_set(stop_);
        write_file(job.place, encoded(job.size, job.samples, options_));
    }

    const std::function<std::filesystem::path(long)> place_of_;
    const PngOptions options_;
    const std::atomic<bool>& stop_;
    long taken_ = 0;
    Workers<Job> writers_;
};

}  // namespace

// 11.3.4: a keyword ends with a zero. In iTXt, flags for no compression, an empty language and an empty translated
// keyword follow.
std::string png_text_chunks(const Metadata& metadata) {
    std::string chunks;
    for (const auto& [key, text] : metadata) {
        const std::string start = keyword(key) + '\0';
        const bool is_ascii = std::ranges::all_of(text, [](unsigned char byte) { return byte < 0x80; });
        chunks += is_ascii ? chunk("tEXt", start + text) : chunk("iTXt", start + std::string(4, '\0') + text);
    }
    return chunks;
}

std::string png_bytes(const Picture& picture, const PngOptions& options) {
    return encoded(picture.size, samples_of(picture, options), options);
}

void write_png(const std::filesystem::path& place, const Picture& picture, const PngOptions& options,
               const std::atomic<bool>& stop) {
    throw_if_set(stop);
    write_file(place, png_bytes(picture, options));
}

std::unique_ptr<Sink> make_png_sink(std::function<std::filesystem::path(long)> place_of, int threads,
                                    PngOptions options, const std::atomic<bool>& stop) {
    return std::make_unique<PngSink>(std::move(place_of), static_cast<std::size_t>(std::max(threads, 1)),
                                     std::move(options), stop);
}

int png_threads(int jobs, Size size) {
    // for each thread: a queued picture, its current one, filtered rows, compressed rows, and the file
    const std::size_t bytes = 5 * byte_count(AV_PIX_FMT_RGBA, all_of(size));
    return static_cast<int>(affordable(bytes, static_cast<std::size_t>(jobs > 0 ? jobs : cores())));
}

}  // namespace doppel
