#include "numeric/error.hpp"
#include "output/png.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
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

Picture read_png(const std::filesystem::path& path) {
    struct Free {
        void operator()(std::FILE* file) const { std::fclose(file); }
        void operator()(stbi_uc* pixels) const { stbi_image_free(pixels); }
    };
    const std::unique_ptr<std::FILE, Free> file(std::fopen(path.c_str(), "rb"));
    if (!file && errno == ENOENT) throw bad_input("{}: there is no such file", path.string());
    if (!file) throw io_failed("{}: cannot be read: {}", path.string(), std::generic_category().message(errno));

    Size size;
    int channels = 0;
    const std::unique_ptr<stbi_uc, Free> pixels(
        stbi_load_from_file(file.get(), &size.width, &size.height, &channels, 4));
    if (!pixels) throw io_failed("{}: cannot be decoded as PNG: {}", path.string(), stbi_failure_reason());
    Picture picture(size);
    std::copy_n(pixels.get(), picture.rgba.size(), picture.rgba.begin());
    return picture;
}

}  // namespace doppel
