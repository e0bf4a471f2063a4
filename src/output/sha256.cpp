#include "output/sha256.hpp"

#include "base/error.hpp"

extern "C" {
#include <libavutil/mem.h>
#include <libavutil/sha.h>
}

#include <array>
#include <cstdio>
#include <memory>
#include <new>

namespace doppel {
namespace {

// Besides libav*.cpp this is the only file that knows libav: the hash comes with it.
class Hash {
public:
    Hash() : sha_(av_sha_alloc()) {
        if (!sha_) throw std::bad_alloc();
        av_sha_init(sha_.get(), 256);
    }

    void add(const void* bytes, std::size_t count) {
        av_sha_update(sha_.get(), static_cast<const std::uint8_t*>(bytes), count);
    }

    std::string digits() {
        std::array<std::uint8_t, 32> digest;
        av_sha_final(sha_.get(), digest.data());
        return fmt::format("{:02x}", fmt::join(digest, ""));
    }

private:
    Owned<AVSHA, av_free> sha_;
};

}  // namespace

std::string sha256_of_file(const FilePlace& place) {
    const Stream file = stream_of(open_file(place), "rb", place.path, "read");
    Hash hash;
    std::array<std::uint8_t, std::size_t{1} << 16> block;
    while (const std::size_t n = std::fread(block.data(), 1, block.size(), file.get())) hash.add(block.data(), n);
    if (std::ferror(file.get())) throw cannot(place.path, "read");
    return hash.digits();
}

std::string sha256_of_text(std::string_view text) {
    Hash hash;
    hash.add(text.data(), text.size());
    return hash.digits();
}

}  // namespace doppel
