#pragma once

#include "image/picture.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace doppel {

/// The output format of a film; png: one picture for each frame; html: a page that draws it; y4m: uncompressed YUV
/// frames with a header; rgb: bytes of RGB, or RGBA if the film is transparent, row by row.
enum class FilmFormat { mp4, webm, gif, apng, png, html, y4m, rgb };
/// The names in presets and on the command line, which are also the file extensions.
inline constexpr std::array<std::string_view, 8> format_names{"mp4", "webm", "gif", "apng",
                                                              "png", "html", "y4m", "rgb"};

/// Chroma subsampling and bits per sample for H.264, VP9 and AV1.
enum class PixelFormat { yuv420, yuv444, yuv420_10 };
inline constexpr std::array<std::string_view, 3> pixel_format_names{"yuv420p", "yuv444p", "yuv420p10"};

/// Encoder presets for H.264, VP9 and AV1: Doppel's own, and those of x264.
inline constexpr std::array<std::string_view, 10> encoder_presets{
    "doppel", "ultrafast", "superfast", "veryfast", "faster", "fast", "medium", "slow", "slower", "veryslow"};

/// A format with one of its codecs, how libav writes it, and its limits. The limits include all that libav would refuse
/// when a file is opened.
struct FormatRow {
    FilmFormat format;
    const char *codec, *title;         // the codec has libav's name
    const char *container, *encoder;   // libav's names; null: written without libav
    int largest_crf = 0;               // 0: no quality or encoder preset
    bool has_alpha = false;            // for formats with a quality: only with yuv420p
    std::string_view rate_words = {};  // why the frame rate is limited as follows; limits of 0 mean none
    int max_fps = 0, max_terms = 0;    // max_terms: the largest numerator and denominator
    double longest_frame_s = 0;

    bool is_encoded() const { return largest_crf > 0; }
    /// Y, Cb and Cr, in one of the pixel formats.
    bool is_yuv() const { return is_encoded() || format == FilmFormat::y4m; }
    /// Whether a film can be joined from parts.
    bool has_parts() const { return is_encoded() || format == FilmFormat::png; }
    /// Whether it can be written to a pipe while it is made.
    bool is_streamed() const { return is_yuv() || format == FilmFormat::rgb; }
};
// most viewers show a GIF frame of 1/100 s for 1/10 s
inline constexpr std::array film_formats{
    FormatRow{FilmFormat::mp4, "h264", "H.264", "mp4", "libx264", 51},
    FormatRow{FilmFormat::webm, "vp9", "VP9", "webm", "libvpx-vp9", 63, true, "WebM counts milliseconds", 1000},
    FormatRow{FilmFormat::webm, "av1", "AV1", "webm", "libaom-av1", 63, false,
              "WebM counts milliseconds, and encoders of AV1 seconds at most", 1000, 0, 1},
    FormatRow{FilmFormat::gif, "gif", "GIF", "gif", "gif", 0, false,
              "a frame of a GIF takes 2 to 65535 hundredths of a second", 50, 0, 655.35},
    FormatRow{FilmFormat::apng, "apng", "animated PNG", "apng", "apng", 0, true,
              "an animated PNG has 16 bits for each number of a fraction", 0, 65535},
    FormatRow{FilmFormat::png, "png", "PNG sequence", nullptr, nullptr, 0, true},
    FormatRow{FilmFormat::html, "", "HTML page", nullptr, nullptr, 0, true},
    FormatRow{FilmFormat::y4m, "wrapped_avframe", "Y4M", "yuv4mpegpipe", "wrapped_avframe"},
    FormatRow{FilmFormat::rgb, "rawvideo", "raw RGB", "rawvideo", "rawvideo", 0, true},
};

/// The codecs of webm; the other formats have one each.
inline constexpr std::array<std::string_view, 2> webm_codecs{"vp9", "av1"};

/// The row of this codec, or the first row of the format, which has its default codec.
const FormatRow& format_row(FilmFormat format, std::string_view codec);

struct VideoOptions {
    FilmFormat format = FilmFormat::mp4;
    std::string codec = {};    // of webm_codecs; empty = the default
    Size size{1920, 1080};     // px, at most 16384 a side; even if chroma is subsampled
    long fps_numerator = 120;  // frames/s
    long fps_denominator = 1;
    PixelFormat pixel_format = PixelFormat::yuv420;  // gif, apng and rgb: not used
    std::string preset = "doppel";                   // of encoder_presets; gif and apng: not used
    int crf = 18;  // h264 0…51, vp9 and av1 0…63, lower is better; gif and apng: not used
    bool transparent =
        false;  // store the alpha channel (apng, and webm with vp9); otherwise pictures are taken as opaque
    Metadata metadata = {};
    bool is_stream = false;        // written to a pipe: an MP4 is fragmented
    std::string part_header = {};  // write a part of the film instead, with this header
    long first_frame = 0;          // of the part

    long frames = 0;  // of the whole film; 0: unknown, and it is one segment

    /// Frames from a key frame to the next: an eighth of the film, but from 1 to 5 s.
    long key_interval() const;
    /// Frames of a segment, a key interval or (of few frames) several; the last segment has up to twice as many.
    /// Segments are encoded independently, so that films can be joined from parts. (Of fewer than 8 frames x264 may not
    /// space the decoding times evenly.)
    long segment() const { return key_interval() * ((8 + key_interval() - 1) / key_interval()); }
    long segments() const { return std::max(frames / segment(), 1L); }
};

/// An option that the format does not allow: its name in presets, and what it must be ("must be even, as …").
struct FormatError {
    std::string_view key;
    std::string words;
};

/// Checks all options except the frame rate, and the frame rate alone. Nothing if the format allows them.
std::optional<FormatError> format_error(const VideoOptions& options);
std::optional<FormatError> rate_error(const VideoOptions& options);

/// ".mp4", ".webm", …
inline std::string extension(FilmFormat format) {
    return "." + std::string(format_names[static_cast<std::size_t>(format)]);
}

}  // namespace doppel
