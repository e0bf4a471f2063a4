#pragma once

#include "cli/process.hpp"
#include "output/png.hpp"

#include <cstdint>
#include <filesystem>

namespace doppel::test {

/// A picture of one colour.
inline Picture plain(int red, Size size = {16, 8}) {
    Picture picture(size);
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
        picture.rgba[i] = static_cast<std::uint8_t>(red), picture.rgba[i + 3] = 255;
    return picture;
}

inline void make(const std::filesystem::path& path, const Picture& picture) {
    std::filesystem::create_directories(path.parent_path());
    write_png(path, picture);
}

/// Changes 40 pixels of a picture.
inline void spoil(const std::filesystem::path& file, int by = 64) {
    auto picture = read_png(file);
    for (int x = 0; x < 40; ++x) picture.at(10 + x, 20)[0] = static_cast<std::uint8_t>(picture.at(10 + x, 20)[0] ^ by);
    write_png(file, picture);
}

}  // namespace doppel::test
