#include "output/libav_encoder.hpp"
#include "output/png.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

namespace doppel {
namespace {

/// Speed settings of the other encoders, for each of encoder_presets; higher is faster.
struct Speeds {
    int vpx, svt, aom;
};
constexpr std::array<Speeds, encoder_presets.size()> speeds{
    {{4, 10, 6}, {5, 12, 6}, {5, 11, 6}, {4, 10, 6}, {3, 9, 5}, {3, 8, 5}, {2, 7, 4}, {1, 6, 3}, {1, 5, 2}, {0, 4, 1}}};

const Speeds& speeds_of(const VideoOptions& options) {
    return speeds[static_cast<std::size_t>(std::ranges::find(encoder_presets, options.preset) -
                                           encoder_presets.begin())];
}

/// In "doppel", x264's threads share each picture in slices; one thread for each frame would take a fifth more CPU
/// time.
constexpr std::size_t slice_threads = 4;

/// Settings of "doppel", found with tests/bench/encoders. In these films 97 % of the macroblocks do not change from
/// frame to frame. Features for fully changing pictures are off; the first frame is fine; quantizers are constant;
/// there is a key frame every 5 s. A narrow dead zone keeps the faint ends of fading trails, at the expense of coarser
/// B-frames. At the same crf the quality equals that of veryfast.
Metadata x264_options(const VideoOptions& options) {
    if (options.preset != "doppel") {
        Metadata result{{"preset", options.preset}, {"crf", fmt::to_string(options.crf)}};
        // less than 12 macroblocks in a row: x264's tree of them reads what nothing has written, and its bytes vary
        if (options.size.width < 192) result.emplace_back("x264-params", "mbtree=0");
        return result;
    }
    const int finer = options.pixel_format == PixelFormat::yuv420_10 ? 12 : 0;  // 6 quantizer steps for each bit
    const int quantizer = options.crf == 0 ? 0 : std::min(options.crf + 7, 51) + finer;
    return {
        {"preset", "veryfast"},
        {"x264-params", fmt::format("qp={}:ipratio=3:pbratio=2.5:bframes=3:deadzone-inter=14:partitions=all:b-adapt=0:"
                                    "b-pyramid=none:direct=temporal:weightb=0:weightp=0:subme=2:mbtree=0:aq-mode=0:"
                                    "rc-lookahead=0:scenecut=0:sliced-threads=1:keyint={}",
                                    quantizer, options.key_interval())}};
}

/// Settings of "doppel", found with tests/bench/encoders, as for screen sharing: an eighth of the CPU time for 1.2
/// times the bytes. (With ten bits this would cost 7 dB.)
Metadata vpx_options(const VideoOptions& options) {
    const bool is_live = options.preset == "doppel" && options.pixel_format != PixelFormat::yuv420_10;
    Metadata result{{"deadline", is_live ? "realtime" : "good"},
                    {"cpu-used", fmt::to_string(is_live ? 5 : speeds_of(options).vpx)},
                    {"row-mt", "1"},
                    {"tile-columns", "2"},
                    {"b", "0"},
                    {"crf", fmt::to_string(options.crf)}};
    if (is_live) result.emplace_back("tune-content", "screen");
    // hidden frames of the colour stream would have no counterpart in the alpha stream
    if (options.transparent) result.emplace_back("auto-alt-ref", "0");
    return result;
}

Metadata av1_options(const VideoOptions& options, std::string_view encoder) {
    const Speeds& preset = speeds_of(options);
    const auto crf = fmt::to_string(options.crf);
    if (encoder != "libsvtav1")
        return {{"cpu-used", fmt::to_string(preset.aom)}, {"row-mt", "1"}, {"b", "0"}, {"crf", crf}};
    return {
        {"preset", fmt::to_string(preset.svt)}, {"crf", crf}, {"svtav1-params", fmt::format("lp={}", encoder_threads)}};
}

/// SVT-AV1 is several times as fast as libaom, but lacks 4:4:4 and some sizes and rates.
std::vector<const char*> av1_encoders(const VideoOptions& options) {
    const auto [width, height] = options.size;
    const bool has_rate = options.fps_numerator <= 240 * options.fps_denominator;
    const bool has_size = std::min(width, height) >= 64 && height <= 8704;
    const bool svt = has_rate && has_size && options.pixel_format != PixelFormat::yuv444;
    return svt ? std::vector{"libsvtav1", "libaom-av1"} : std::vector{"libaom-av1"};
}

/// Ticks per second of the duration in an mp4. It equals libav's for the video track, so that no frame is cut short.
long mp4_timescale(const VideoOptions& options) {
    long ticks = options.fps_numerator;
    while (ticks < 10000) ticks *= 2;
    return ticks;
}

AVPixelFormat pixels_of(const VideoOptions& options) {
    if (options.format == FilmFormat::gif) return AV_PIX_FMT_PAL8;
    if (options.format == FilmFormat::apng || options.format == FilmFormat::rgb)
        return options.transparent ? AV_PIX_FMT_RGBA : AV_PIX_FMT_RGB24;
    if (options.pixel_format == PixelFormat::yuv444) return AV_PIX_FMT_YUV444P;
    if (options.pixel_format == PixelFormat::yuv420_10) return AV_PIX_FMT_YUV420P10LE;
    return options.transparent ? AV_PIX_FMT_YUVA420P : AV_PIX_FMT_YUV420P;
}

}  // namespace

Encoding encoding_of(const VideoOptions& options) {
    const FormatRow& row = format_row(options.format, options.codec);
    const bool is_av1 = row.codec == std::string_view("av1");
    const auto& encoder = find_encoder(is_av1 ? av1_encoders(options) : std::vector{row.encoder}, row.codec);
    Encoding encoding{.options = options,
                      .row = row,
                      .encoder = &encoder,
                      .pixels = pixels_of(options),
                      .tick = {static_cast<int>(options.fps_denominator), static_cast<int>(options.fps_numerator)}};
    if (row.has_parts()) encoding.segment = options.segment(), encoding.segments = options.segments();
    if (options.format == FilmFormat::mp4) {
        encoding.encoder_options = x264_options(options);
        if (options.preset == "doppel") encoding.threads = slice_threads;
        encoding.container_options = {
            {"movflags", options.is_stream ? "+frag_keyframe+empty_moov+delay_moov+default_base_moof" : "+faststart"},
            {"movie_timescale", fmt::to_string(mp4_timescale(options))}};
    }
    if (options.format == FilmFormat::webm)
        encoding.encoder_options = is_av1 ? av1_options(options, encoder.name) : vpx_options(options);
    if (options.format == FilmFormat::gif) encoding.tick = {1, 100};
    if (options.format == FilmFormat::apng) {
        encoding.container_options = {{"plays", "0"}};
        encoding.png_chunks = png_text_chunks(options.metadata);
    }
    return encoding;
}

}  // namespace doppel
