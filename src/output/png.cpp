#include "output/png.hpp"

#include "numeric/error.hpp"
#include "output/output_file.hpp"
#include "output/workers.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <cstdlib>
#include <string>

namespace doppel {
namespace {

/// zlib's format through libdeflate, as stb_image_write asks for it: a block of malloc's, or null.
unsigned char* compress(unsigned char* data, int length, int* compressed_length, int /*quality*/) {
    // the others take 1.8 times as long for a file 2 to 5 % smaller: see tests/output/png_test.cpp
    constexpr int level = 1;
    struct Free {
        void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
    };
    const std::unique_ptr<libdeflate_compressor, Free> compressor(libdeflate_alloc_compressor(level));
    if (!compressor) return nullptr;
    const std::size_t bound = libdeflate_zlib_compress_bound(compressor.get(), std::size_t(length));
    auto* compressed = static_cast<unsigned char*>(std::malloc(bound));
    if (!compressed) return nullptr;
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
#include <stb_image_write.h>
#pragma GCC diagnostic pop

namespace doppel {
namespace {

// flat colours compress best as they are; any filter takes 1.7 times as long for a larger file
[[maybe_unused]] const int no_filter = stbi_write_force_png_filter = 0;

struct Rgb {
    Size size;
    std::vector<std::uint8_t> bytes;
};

Rgb without_alpha(const Picture& picture) {
    Rgb rgb{picture.size, std::vector<std::uint8_t>(picture.rgba.size() / 4 * 3)};
    const std::uint8_t* from = picture.rgba.data();
    std::uint8_t* to = rgb.bytes.data();
    for (std::size_t left = picture.rgba.size() / 4; left > 0; --left, from += 4, to += 3) {
        to[0] = from[0];
        to[1] = from[1];
        to[2] = from[2];
    }
    return rgb;
}

void write_rgb(const std::filesystem::path& path, const Rgb& rgb) {
    std::string file;
    const auto append = [](void* to, void* bytes, int size) {
        static_cast<std::string*>(to)->append(static_cast<const char*>(bytes), std::size_t(size));
    };
    const auto [width, height] = rgb.size;
    if (!stbi_write_png_to_func(append, &file, width, height, 3, rgb.bytes.data(), 3 * width))
        throw io_failed("{}: a picture of {}x{} px cannot be compressed", path.string(), width, height);
    OutputFile output(path);
    output.write(file);
    output.close();
}

class PngSink final : public Sink {
public:
    PngSink(const std::filesystem::path& folder, std::function<std::string(long)> name_of, int jobs)
        : folder_(folder),
          name_of_(std::move(name_of)),
          writers_(std::max(jobs, 1), std::size_t(std::max(jobs, 1)),
                   [](Job& job) { write_rgb(job.path, job.picture); }) {}

    void take(const Picture& picture, const std::vector<Rect>& /*changed*/) override {
        writers_.give({folder_ / name_of_(taken_++), without_alpha(picture)});
    }

    void finish() override { writers_.finish(); }

private:
    struct Job {
        std::filesystem::path path;
        Rgb picture;
    };
    std::filesystem::path folder_;
    std::function<std::string(long)> name_of_;
    long taken_ = 0;
    Workers<Job> writers_;
};

}  // namespace

void write_png(const std::filesystem::path& path, const Picture& picture) {
    write_rgb(path, without_alpha(picture));
}

std::unique_ptr<Sink> make_png_sink(const std::filesystem::path& folder, std::function<std::string(long)> name_of,
                                    int jobs) {
    return std::make_unique<PngSink>(folder, std::move(name_of), jobs);
}

}  // namespace doppel
