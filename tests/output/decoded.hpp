#pragma once

#include "image/picture.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace doppel::test {

struct Ratio {
    std::int64_t numerator = 0, denominator = 1;
    /// Compares values: 1/2 and 2/4 are equal.
    friend bool operator==(const Ratio& a, const Ratio& b) {
        return a.numerator * b.denominator == b.numerator * a.denominator;
    }
    double value() const { return static_cast<double>(numerator) / static_cast<double>(denominator); }
};

/// The properties of a video file, with libav's names for the tags ("bt709", "tv", "center", "yuv420p").
struct Video {
    Size size;
    std::string codec, pixel_format, range, matrix, primaries, transfer, chroma_location, title;
    std::map<std::string, std::string> metadata;  // of the file, or (PNG) of its first frame; keys in lower case
    Ratio average_rate, base_rate;                // frames/s: avg_frame_rate and r_frame_rate
    Ratio duration;                               // s
    std::vector<Ratio> times, lasting;            // s, one for each frame, in display order
    bool index_at_front = false;                  // moov before mdat
    std::vector<std::pair<double, std::string>> chapters;  // start, s; title
};

/// One decoded frame: luma of YUV; the picture of RGB (gif, apng); alpha if present.
struct Luma {
    long frame;
    Size size;
    std::vector<double> y;                      // rows from the top down, no padding; on the scale of 8 bits, 16…235
    std::array<std::vector<double>, 2> chroma;  // Cb and Cr on that scale, one sample for each pixel or for four
    std::vector<std::uint8_t> alpha;
    Picture picture;
};

/// Decodes the whole file frame by frame; throws std::runtime_error on failure.
Video read_video(const std::filesystem::path& path, const std::function<void(const Luma&)>& each = {});

/// Peak signal-to-noise ratio of a decoded frame against its source picture, dB: for YUV of luma by BT.709's formula in
/// double; for RGB of the colours.
double luma_psnr(const Picture& source, const Luma& decoded);
double rgb_psnr(const Picture& source, const Picture& decoded);

}  // namespace doppel::test
