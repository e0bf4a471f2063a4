#include "base/error.hpp"
#include "output/libav_encoder.hpp"
#include "output/png.hpp"

extern "C" {
#include <libavutil/imgutils.h>
}

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string_view>

namespace doppel {
namespace {

/// What a codec can have.
struct Codec {
    VideoFormat format;
    const char* container;   // libav's name, and that of the file's ending
    std::string_view name;   // VideoOptions::codec's
    std::string_view title;  // as errors have it
    int largest_side;        // px
    int largest_crf = 0;     // 0: it has none
    bool alpha = false;
};

// the first of a format is its usual one
constexpr std::array codecs{
    Codec{VideoFormat::mp4, "mp4", "h264", "H.264", 16384, 51},
    Codec{VideoFormat::webm, "webm", "vp9", "VP9", 16384, 63, true},
    Codec{VideoFormat::webm, "webm", "av1", "AV1", 16384, 63},
    Codec{VideoFormat::gif, "gif", "", "GIF", 65535},
    Codec{VideoFormat::apng, "apng", "", "APNG", 65535, 0, true},
};

/// "doppel", or a preset of x264, and the speed of the other encoders that compares with it (the higher, the faster).
struct Preset {
    std::string_view name;
    int vpx, svt, aom;
};
constexpr std::array presets{Preset{"doppel", 4, 10, 6},   Preset{"ultrafast", 5, 12, 6}, Preset{"superfast", 5, 11, 6},
                             Preset{"veryfast", 4, 10, 6}, Preset{"faster", 3, 9, 5},     Preset{"fast", 3, 8, 5},
                             Preset{"medium", 2, 7, 4},    Preset{"slow", 1, 6, 3},       Preset{"slower", 1, 5, 2},
                             Preset{"veryslow", 0, 4, 1},  Preset{"placebo", 0, 3, 0}};

const Preset* find_preset(std::string_view name) {
    const auto* found = std::ranges::find(presets, name, &Preset::name);
    return found == presets.end() ? nullptr : found;
}

template <class Things, class Value>
std::string listed(const Things& things, Value Things::value_type::*member) {
    std::vector<Value> values;
    for (const auto& thing : things) values.push_back(thing.*member);
    return fmt::format("{}", fmt::join(values, ", "));
}

const Codec& codec_of(const VideoOptions& options) {
    std::vector<Codec> of_format;
    for (const Codec& codec : codecs) {
        if (codec.format != options.format) continue;
        if (options.codec.empty() || codec.name == options.codec) return codec;
        of_format.push_back(codec);
    }
    const auto& [format, container, name, title, side, crf, alpha] = of_format.front();
    if (name.empty())
        throw bad_input("{} has only one codec, and no name for it; \"{}\" is none", container, options.codec);
    throw bad_input("{} holds {}, not \"{}\"", container, listed(of_format, &Codec::name), options.codec);
}

bool is_yuv(const VideoOptions& options) {
    return options.format == VideoFormat::mp4 || options.format == VideoFormat::webm;
}

/// libav's limit: a picture's bytes, with padding, in 31 bits.
bool libav_takes(Size size) {
    capture_libav_log();
    return av_image_check_size(static_cast<unsigned>(size.width), static_cast<unsigned>(size.height), 0, nullptr) >= 0;
}

/// The largest of about the same shape that libav takes, of even sides.
Size largest_alike(Size size) {
    const double height = static_cast<double>(size.height) / size.width;
    for (int width = size.width - size.width % 2; width > 2; width -= 2)
        if (const Size alike{width, 2 * static_cast<int>(width * height / 2)}; alike.height > 0 && libav_takes(alike))
            return alike;
    return {2, 2};
}

void check_size(const VideoOptions& options, const Codec& codec) {
    const auto [width, height] = options.size;
    if (width < 1 || height < 1 || std::max(width, height) > codec.largest_side)
        throw bad_input("{} has sizes of 1x1 … {}x{} px; {}x{} is none", codec.title, codec.largest_side,
                        codec.largest_side, width, height);
    if (!libav_takes(options.size)) {
        const auto [less_wide, less_high] = largest_alike(options.size);
        throw bad_input("{} of {}x{} px is more than libav encodes; {}x{} would do{}", codec.title, width, height,
                        less_wide, less_high,
                        options.format == VideoFormat::mp4
                            ? ", and 8192x4352 for players that keep to the highest level of H.264, 6.2"
                            : "");
    }
    const bool halved = is_yuv(options) && options.pixel_format != PixelFormat::yuv444;
    if (halved && (width % 2 != 0 || height % 2 != 0))
        throw bad_input("{} needs even sizes; {}x{} is not; {}x{} would do", codec.title, width, height,
                        width + width % 2, height + height % 2);
}

void check_rate(const VideoOptions& options) {
    const int numerator = options.fps_numerator;
    const int denominator = options.fps_denominator;
    if (numerator < 1 || denominator < 1)
        throw bad_input("frames per second must be > 0; they are {}/{}", numerator, denominator);
    const auto limit = [&](int most, std::string_view why) {
        if (numerator > std::int64_t{most} * denominator)
            throw bad_input("{}; {} frames/s are too many, at most {} would do", why,
                            denominator == 1 ? fmt::to_string(numerator) : fmt::format("{}/{}", numerator, denominator),
                            most);
    };
    switch (options.format) {
        case VideoFormat::mp4:
            break;
        case VideoFormat::webm:
            limit(1000, "WebM counts milliseconds");
            break;
        // most viewers show a frame of 1/100 s for 1/10 s
        case VideoFormat::gif:
            limit(50, "GIF counts 1/100 s and needs two of them a frame");
            break;
        case VideoFormat::apng:
            if (const int common = std::gcd(numerator, denominator);
                numerator / common > 65535 || denominator / common > 65535)
                throw bad_input("APNG has rates of numerators and denominators up to 65535; {}/{} is none", numerator,
                                denominator);
    }
}

/// Threads of x264 in "doppel", a slice of the picture each: with a frame each, as else, it takes a fifth more CPU time.
constexpr std::size_t slice_threads = 4;

/// In "doppel", found by tests/bench/encoders, all that serves pictures which change everywhere is off: of ours 97 % of the
/// macroblocks stay as they are. A fine first frame keeps sharp what rests; quantizers are constant, and a frame is whole
/// every 5 s. A narrow dead zone keeps the last faint steps of trails that fade, which coarser B-frames pay for. It looks
/// as veryfast does at the same crf.
Metadata x264_options(const VideoOptions& options) {
    if (options.preset != "doppel") return {{"preset", options.preset}, {"crf", fmt::to_string(options.crf)}};
    const int finer = options.pixel_format == PixelFormat::yuv420_10 ? 12 : 0;  // 6 quantizers a bit
    const int quantizer = options.crf == 0 ? 0 : std::min(options.crf + 7, 51) + finer;
    const auto key_interval = 5 * std::int64_t{options.fps_numerator} / options.fps_denominator;
    return {
        {"preset", "veryfast"},
        {"x264-params", fmt::format("qp={}:ipratio=3:pbratio=2.5:bframes=3:deadzone-inter=14:partitions=all:b-adapt=0:"
                                    "b-pyramid=none:direct=temporal:weightb=0:weightp=0:subme=2:mbtree=0:aq-mode=0:"
                                    "rc-lookahead=0:scenecut=0:sliced-threads=1:keyint={}",
                                    quantizer, std::max<std::int64_t>(key_interval, 1))}};
}

/// In "doppel", found by tests/bench/encoders, as for a live screen: an eighth of the CPU time for 1.2 times the bytes. (Ten
/// bits lose 7 dB by that.)
Metadata vpx_options(const VideoOptions& options) {
    const bool is_live = options.preset == "doppel" && options.pixel_format != PixelFormat::yuv420_10;
    Metadata result{{"deadline", is_live ? "realtime" : "good"},
                    {"cpu-used", fmt::to_string(is_live ? 5 : find_preset(options.preset)->vpx)},
                    {"row-mt", "1"},
                    {"tile-columns", "2"},
                    {"b", "0"},
                    {"crf", fmt::to_string(options.crf)}};
    if (is_live) result.emplace_back("tune-content", "screen");
    // hidden frames of the colour stream would have no counterpart in that of alpha
    if (options.transparent) result.emplace_back("auto-alt-ref", "0");
    return result;
}

Metadata av1_options(const VideoOptions& options, std::string_view encoder) {
    const Preset& preset = *find_preset(options.preset);
    const auto crf = fmt::to_string(options.crf);
    if (encoder != "libsvtav1")
        return {{"cpu-used", fmt::to_string(preset.aom)}, {"row-mt", "1"}, {"b", "0"}, {"crf", crf}};
    return {
        {"preset", fmt::to_string(preset.svt)}, {"crf", crf}, {"svtav1-params", fmt::format("lp={}", encoder_threads)}};
}

/// SVT-AV1 is several times as fast as libaom, but has neither 4:4:4 nor every size.
std::vector<const char*> av1_encoders(const VideoOptions& options) {
    const auto [width, height] = options.size;
    const bool svt = options.pixel_format != PixelFormat::yuv444 && std::min(width, height) >= 64 && height <= 8704;
    return svt ? std::vector{"libsvtav1", "libaom-av1"} : std::vector{"libaom-av1"};
}

/// Ticks a second in which an mp4 says how long it lasts: as libav's of the video track, so that no frame is cut short.
int mp4_timescale(const VideoOptions& options) {
    int ticks = options.fps_numerator;
    while (ticks < 10000) ticks *= 2;
    return ticks;
}

void choose_encoder(const VideoOptions& options, Encoding& encoding) {
    switch (options.format) {
        case VideoFormat::mp4:
            encoding.encoder = &find_encoder({"libx264"}, AV_CODEC_ID_H264);
            encoding.encoder_options = x264_options(options);
            if (options.preset == "doppel") encoding.threads = slice_threads;
            encoding.container_options = {{"movflags", "+faststart"},
                                          {"movie_timescale", fmt::to_string(mp4_timescale(options))}};
            break;
        case VideoFormat::webm:
            if (codec_of(options).name == "av1") {
                encoding.encoder = &find_encoder(av1_encoders(options), AV_CODEC_ID_AV1);
                encoding.encoder_options = av1_options(options, encoding.encoder->name);
            } else {
                encoding.encoder = &find_encoder({"libvpx-vp9"}, AV_CODEC_ID_VP9);
                encoding.encoder_options = vpx_options(options);
            }
            break;
        case VideoFormat::gif:
            encoding.encoder = &find_encoder({"gif"}, AV_CODEC_ID_GIF);
            encoding.tick = {1, 100};
            break;
        case VideoFormat::apng:
            encoding.encoder = &find_encoder({"apng"}, AV_CODEC_ID_APNG);
            encoding.container_options = {{"plays", "0"}};
            encoding.png_chunks = png_text_chunks(options.metadata);
            break;
    }
}

AVPixelFormat pixels_of(const VideoOptions& options) {
    if (options.format == VideoFormat::gif) return AV_PIX_FMT_PAL8;
    if (options.format == VideoFormat::apng) return options.transparent ? AV_PIX_FMT_RGBA : AV_PIX_FMT_RGB24;
    if (options.pixel_format == PixelFormat::yuv444) return AV_PIX_FMT_YUV444P;
    if (options.pixel_format == PixelFormat::yuv420_10) return AV_PIX_FMT_YUV420P10LE;
    return options.transparent ? AV_PIX_FMT_YUVA420P : AV_PIX_FMT_YUV420P;
}

}  // namespace

void check_options(const VideoOptions& options) {
    const Codec& codec = codec_of(options);
    check_size(options, codec);
    check_rate(options);
    if (options.transparent && !codec.alpha)
        throw bad_input("{} has no transparency; webm of vp9 and apng have", codec.title);
    if (!is_yuv(options)) return;
    if (options.transparent && options.pixel_format != PixelFormat::yuv420)
        throw bad_input("{} has transparency only beside 4:2:0 of 8 bits", codec.title);
    if (!find_preset(options.preset))
        throw bad_input("there is no preset \"{}\"; there are {}", options.preset, listed(presets, &Preset::name));
    if (options.crf < 0 || options.crf > codec.largest_crf)
        throw bad_input("crf of {} must be 0 … {}; it is {}", codec.title, codec.largest_crf, options.crf);
}

Encoding encoding_of(const VideoOptions& options) {
    const AVRational rate{options.fps_numerator, options.fps_denominator};
    Encoding encoding{.container = codec_of(options).container,
                      .encoder = nullptr,
                      .pixels = pixels_of(options),
                      .size = options.size,
                      .frame_rate = rate,
                      .tick = av_inv_q(rate),
                      .threads = encoder_threads,
                      .metadata = options.metadata};
    choose_encoder(options, encoding);
    return encoding;
}

std::string extension(VideoFormat format) {
    return std::string(".") + std::ranges::find(codecs, format, &Codec::format)->container;
}

}  // namespace doppel
