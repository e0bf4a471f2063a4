#include "output/png.hpp"

#include "base/error.hpp"
#include "base/machine.hpp"
#include "output/folder.hpp"
#include "output/samples.hpp"
#include "output/workers.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <cstdint>
#include <new>
#include <optional>
#include <string>
#include <string_view>

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

/// A picture's rows, each after a byte that says that it is not filtered: flat colours compress best as they are; any
/// filter takes 1.7 times as long for a larger file.
struct Rows {
    Size size;
    std::size_t bytes = 0;
    Buffer data{};

    void set(const Picture& picture, const PngOptions& options) {
        size = picture.size;
        const Samples samples = options.with_alpha ? Samples::rgba : Samples::rgb;
        const std::size_t row_bytes = byte_count(samples, {0, 0, size.width, 1});
        bytes = (1 + row_bytes) * static_cast<std::size_t>(size.height);
        std::uint8_t* to = data.make_room(bytes);
        for (int y = 0; y < size.height; ++y, to += row_bytes) {
            *to++ = 0;
            convert(picture, {0, y, size.width, y + 1}, samples, to);
        }
    }
};

/// Writes pictures, one after another; keeps its memory.
class PngWriter {
public:
    void write(const FilePlace& place, const Rows& rows, const PngOptions& options, const std::atomic<bool>& stop) {
        if (stop) throw Error(ExitCode::interrupted, "interrupted");
        OutputFile file(place);
        std::string header = big_endian(static_cast<std::uint32_t>(rows.size.width)) +
                             big_endian(static_cast<std::uint32_t>(rows.size.height));
        header += {8, static_cast<char>(options.with_alpha ? 6 : 2), 0, 0, 0};  // bits a channel, RGBA or RGB
        file.write("\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + png_text_chunks(options.metadata));

        const std::size_t bound = libdeflate_zlib_compress_bound(compressor_.get(), rows.bytes);
        std::uint8_t* packed = packed_.make_room(bound);
        const std::size_t count =
            libdeflate_zlib_compress(compressor_.get(), rows.data.data(), rows.bytes, packed, bound);
        if (count == 0 || count > INT32_MAX)
            throw io_failed("{}: a picture of {}x{} px cannot be compressed", place.path.string(), rows.size.width,
                            rows.size.height);
        file.write(big_endian(static_cast<std::uint32_t>(count)) + "IDAT");
        file.write({reinterpret_cast<const char*>(packed), count});
        const auto check = libdeflate_crc32(libdeflate_crc32(0, "IDAT", 4), packed, count);
        file.write(big_endian(check) + chunk("IEND", ""));
        file.close();
    }

private:
    static libdeflate_compressor* made_compressor() {
        // the levels above take 1.8 times as long for a file 2 to 5 % smaller: see tests/output/png_test.cpp
        constexpr int level = 1;
        if (auto* compressor = libdeflate_alloc_compressor(level)) return compressor;
        throw std::bad_alloc();
    }

    Owned<libdeflate_compressor, libdeflate_free_compressor> compressor_{made_compressor()};
    Buffer packed_;
};

class PngSink final : public Sink {
public:
    PngSink(std::function<FilePlace(long)> place_of, std::size_t threads, PngOptions options,
            const std::atomic<bool>& stop)
        : place_of_(std::move(place_of)),
          options_(std::move(options)),
          stop_(stop),
          workers_(threads, threads, [this](Job& job) { write(job); }) {}

    void take(const Picture& picture, const std::vector<Rect>& /*changed*/) override {
        Job job{place_of_(taken_++), spare_.take()};
        job.rows.set(picture, options_);
        workers_.give(std::move(job));
    }

    void finish() override { workers_.finish(); }

private:
    struct Job {
        FilePlace place;
        Rows rows;
    };

    void write(Job& job) {
        PngWriter writer = writers_.take();
        writer.write(job.place, job.rows, options_, stop_);
        writers_.give_back(std::move(writer));
        spare_.give_back(std::move(job.rows));
    }

    const std::function<FilePlace(long)> place_of_;
    const PngOptions options_;
    const std::atomic<bool>& stop_;
    long taken_ = 0;
    Pool<Rows> spare_;
    Pool<PngWriter> writers_;  // as many as threads
    Workers<Job> workers_;
};

}  // namespace

// 11.3.4: a keyword ends with a zero; iTXt adds that it is not compressed, and an empty language and translation of the
// keyword.
std::string png_text_chunks(const Metadata& metadata) {
    std::string chunks;
    for (const auto& [key, text] : metadata) {
        const std::string start = keyword(key) + '\0';
        const auto short_text = latin1(text);
        chunks += short_text ? chunk("tEXt", start + *short_text) : chunk("iTXt", start + std::string(4, '\0') + text);
    }
    return chunks;
}

void write_png(const FilePlace& place, const Picture& picture, const PngOptions& options,
               const std::atomic<bool>& stop) {
    Rows rows;
    rows.set(picture, options);
    PngWriter().write(place, rows, options, stop);
}

std::unique_ptr<Sink> make_png_sink(std::function<FilePlace(long)> place_of, int threads, PngOptions options,
                                    const std::atomic<bool>& stop) {
    return std::make_unique<PngSink>(std::move(place_of), static_cast<std::size_t>(std::max(threads, 1)),
                                     std::move(options), stop);
}

int png_threads(int jobs, Size size) {
    // what waits, what is at work, compressed, and as much again for the rest of the program
    const std::size_t bytes = 5 * byte_count(Samples::rgba, all_of(size));
    return static_cast<int>(in_hand(bytes, static_cast<std::size_t>(jobs > 0 ? jobs : cores())));
}

}  // namespace doppel
