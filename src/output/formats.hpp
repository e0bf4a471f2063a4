#pragma once

#include "image/picture.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace doppel {

/// What a film is written as; png: a picture a frame.
enum class FilmFormat { mp4, webm, gif, apng, png };
/// In presets and on the command line; libav's name of a container, and the ending of the file.
inline constexpr std::array<std::string_view, 5> format_names{"mp4", "webm", "gif", "apng", "png"};

/// Of H.264, VP9 and AV1: chroma subsampling and bits a sample.
enum class PixelFormat { yuv420, yuv444, yuv420_10 };
inline constexpr std::array<std::string_view, 3> pixel_format_names{"yuv420p", "yuv444p", "yuv420p10"};

/// Efforts of the encoders of H.264, VP9 and AV1: ours, and x264's.
inline constexpr std::array<std::string_view, 10> encoder_presets{
    "doppel", "ultrafast", "superfast", "veryfast", "faster", "fast", "medium", "slow", "slower", "veryslow"};

/// What a format can have, with one of its codecs. All that libav refuses when a file is opened is known here.
struct FormatRow {
    FilmFormat format;
    std::string_view codec;  // of VideoOptions; empty where the format has one alone
    std::string_view title;
    int largest_side;                  // px
    int largest_crf = 0;               // 0: it has no quality, effort and pixel format
    bool has_alpha = false;            // with a quality: in yuv420p
    std::string_view rate_words = {};  // why frames/s have the limits that follow; 0: none
    int most_fps = 0, most_terms = 0;  // most_terms: of a fraction
    double longest_frame_s = 0;

    bool is_encoded() const { return largest_crf > 0; }
};
// most viewers show a frame of a GIF of 1/100 s for 1/10 s
inline constexpr std::array film_formats{
    FormatRow{FilmFormat::mp4, "h264", "H.264", 16384, 51},
    FormatRow{FilmFormat::webm, "vp9", "VP9", 16384, 63, true, "WebM counts milliseconds", 1000},
    FormatRow{FilmFormat::webm, "av1", "AV1", 16384, 63, false,
              "WebM counts milliseconds, and encoders of AV1 seconds at most", 1000, 0, 1},
    FormatRow{FilmFormat::gif, "", "GIF", 65535, 0, false, "a frame of a GIF takes 2 to 65535 hundredths of a second",
              50, 0, 655.35},
    FormatRow{FilmFormat::apng, "", "animated PNG", 65535, 0, true,
              "an animated PNG has 16 bits for each number of a fraction", 0, 65535},
    FormatRow{FilmFormat::png, "", "PNG sequence", 65535, 0, true},
};

/// The names of the codecs that a format has a choice of.
std::vector<std::string_view> codecs_of(FilmFormat format);

/// The row of the codec, or the first of the format: of its usual codec.
const FormatRow& format_row(FilmFormat format, std::string_view codec);

struct VideoOptions {
    FilmFormat format = FilmFormat::mp4;
    std::string codec = {};    // "h264" (mp4), "vp9" or "av1" (webm); empty = h264, vp9
    Size size;                 // px; even where chroma is for 2×2 pixels
    long fps_numerator = 120;  // frames/s
    long fps_denominator = 1;
    PixelFormat pixel_format = PixelFormat::yuv420;  // gif and apng: not used
    std::string preset = "doppel";                   // of encoder_presets; gif and apng: not used
    int crf = 18;              // h264 0…51, vp9 and av1 0…63, lower is better; gif and apng: not used
    bool transparent = false;  // the pictures' alpha counts: apng, webm of vp9; else it is taken for 255
    Metadata metadata = {};
};

/// What a format cannot have: the option, as presets call it, and what it must be: "must be even, as …".
struct FormatFault {
    std::string_view key;
    std::string words;
};

/// Of all options but frames/s, and of those alone. Nothing where the format can have them.
std::optional<FormatFault> format_fault(const VideoOptions& options);
std::optional<FormatFault> rate_fault(const VideoOptions& options);

/// ".mp4", ".webm", ".gif", ".apng".
inline std::string extension(FilmFormat format) {
    return "." + std::string(format_names[static_cast<std::size_t>(format)]);
}

}  // namespace doppel
