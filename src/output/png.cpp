#include "output/png.hpp"

#include "base/error.hpp"
#include "base/machine.hpp"
#include "base/text.hpp"
#include "output/samples.hpp"
#include "output/workers.hpp"

#include <libdeflate.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

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

}  // namespace doppel
