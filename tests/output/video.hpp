#pragma once

#include "picture/picture.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace doppel::test {

struct Ratio {
    std::int64_t numerator = 0, denominator = 1;
    /// As numbers: 1/2 and 2/4 are equal.
    friend bool operator==(const Ratio& a, const Ratio& b) {
        return a.numerator * b.denominator == b.numerator * a.denominator;
    }
};

/// What a player finds in a video file: libav's words for the tags ("bt709", "tv", "center", "yuv420p").
struct Video {
    Size size;
    std::string codec, pixel_format, range, matrix, primaries, transfer, chroma_location, title;
    Ratio average_rate, base_rate;      // frames/s: avg_frame_rate and r_frame_rate
    Ratio duration;                     // s
    std::vector<Ratio> times, lasting;  // s, a frame each, in the order of display
    bool index_at_front = false;        // moov before mdat
};

/// The luma of one decoded frame.
struct Luma {
    long frame;
    Size size;
    std::vector<std::uint8_t> y;  // rows from the top down, no padding
};

/// Decodes the whole file, frame after frame; std::runtime_error where that fails.
Video read_video(const std::filesystem::path& path, const std::function<void(const Luma&)>& each = {});

/// Peak signal-to-noise ratio of a decoded frame against the picture it was made from, dB, by BT.709's formula in
/// double.
double luma_psnr(const Picture& source, const Luma& decoded);

}  // namespace doppel::test
