#include "base/error.hpp"
#include "output/png.hpp"

extern "C" {
#include <libavutil/base64.h>
}

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <string_view>

namespace doppel {
namespace {

constexpr std::size_t block_bytes = std::size_t{3} << 14;  // a multiple of three: padding only after the last block

std::string start_of_url(std::string_view type) {
    return fmt::format("data:{};base64,", type);
}

void add_block(std::string& url, const char* bytes, std::size_t count) {
    std::array<char, AV_BASE64_SIZE(block_bytes)> digits;
    url += av_base64_encode(digits.data(), static_cast<int>(digits.size()),
                            reinterpret_cast<const std::uint8_t*>(bytes), static_cast<int>(count));
}

}  // namespace

std::string data_url(const std::filesystem::path& png) {
    const Stream file = open_file(png);
    auto url = start_of_url("image/png");
    std::array<char, block_bytes> block;
    while (const std::size_t count = std::fread(block.data(), 1, block.size(), file.get()))
        add_block(url, block.data(), count);
    if (std::ferror(file.get())) throw cannot(png, "read");
    return url;
}

std::string data_url(const Picture& picture, const PngOptions& options) {
    return data_url("image/png", png_bytes(picture, options));
}

std::string data_url(std::string_view type, std::string_view bytes) {
    auto url = start_of_url(type);
    for (std::size_t at = 0; at < bytes.size(); at += block_bytes)
        add_block(url, &bytes[at], std::min(block_bytes, bytes.size() - at));
    return url;
}

}  // namespace doppel
