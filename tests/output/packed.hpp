#pragma once

#include "output/files.hpp"

#include <gtest/gtest.h>
#include <libdeflate.h>
#include <nlohmann/json.hpp>

extern "C" {
#include <libavutil/base64.h>
}

#include <cstdint>
#include <string>

namespace doppel::test {

/// The input of deflated(), from its result.
inline std::string inflated(const std::string& base64) {
    std::string bytes(AV_BASE64_DECODE_SIZE(base64.size()), '\0'), plain(std::size_t{1} << 24, '\0');
    const int size =
        av_base64_decode(reinterpret_cast<std::uint8_t*>(bytes.data()), base64.c_str(), static_cast<int>(bytes.size()));
    std::size_t length = 0;
    const Owned<libdeflate_decompressor, libdeflate_free_decompressor> decompressor(libdeflate_alloc_decompressor());
    EXPECT_EQ(libdeflate_zlib_decompress(decompressor.get(), bytes.data(), static_cast<std::size_t>(size), plain.data(),
                                         plain.size(), &length),
              LIBDEFLATE_SUCCESS);
    plain.resize(length);
    return plain;
}

/// The data that the scripts of a packed page read.
inline nlohmann::ordered_json data_of(const std::string& page) {
    const std::string start = "<script type=\"text/packed\" id=\"data\">";
    const auto begin = page.find(start) + start.size();
    return nlohmann::ordered_json::parse(inflated(page.substr(begin, page.find('<', begin) - begin)));
}

}  // namespace doppel::test
