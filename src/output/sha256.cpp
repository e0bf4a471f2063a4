#include "output/sha256.hpp"

#include "numeric/error.hpp"

extern "C" {
#include <libavutil/mem.h>
#include <libavutil/sha.h>
}

#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

namespace doppel {

// Besides mp4.cpp this is the only file that knows libav: the hash comes with it.
std::string sha256_of_file(const std::filesystem::path& path) {
    struct Free {
        void operator()(std::FILE* file) const { std::fclose(file); }
        void operator()(AVSHA* sha) const { av_free(sha); }
    };
    const auto cannot_read = [&] {
        return io_failed("{}: cannot be read: {}", path.string(), std::generic_category().message(errno));
    };
    const std::unique_ptr<std::FILE, Free> file(std::fopen(path.c_str(), "rb"));
    if (!file) throw cannot_read();
    const std::unique_ptr<AVSHA, Free> sha(av_sha_alloc());
    if (!sha) throw std::bad_alloc();

    av_sha_init(sha.get(), 256);
    std::array<std::uint8_t, std::size_t{1} << 16> block;
    while (const std::size_t n = std::fread(block.data(), 1, block.size(), file.get()))
        av_sha_update(sha.get(), block.data(), n);
    if (std::ferror(file.get())) throw cannot_read();

    std::array<std::uint8_t, 32> digest;
    av_sha_final(sha.get(), digest.data());
    return fmt::format("{:02x}", fmt::join(digest, ""));
}

}  // namespace doppel
