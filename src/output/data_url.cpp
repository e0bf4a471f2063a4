#include "base/error.hpp"
#include "output/png.hpp"

extern "C" {
#include <libavutil/base64.h>
}

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <string_view>

namespace doppel {

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
    url.pop_back();  // the terminating zero
    return url;
}

}  // namespace doppel
