#include "output/formats.hpp"

#include "output/libav_encoder.hpp"

extern "C" {
#include <libavutil/imgutils.h>
}

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace doppel {
namespace {

std::string_view pixels_words(const VideoOptions& options) {
    return pixel_format_names[static_cast<std::size_t>(options.pixel_format)];
}

std::string words_of(Size size) {
    return fmt::format("[{}, {}]", size.width, size.height);
}

}  // namespace

const FormatRow& format_row(FilmFormat format, std::string_view codec) {
    const auto* found = std::ranges::find_if(
        film_formats, [&](const FormatRow& row) { return row.format == format && row.codec == codec; });
    return found != film_formats.end() ? *found : *std::ranges::find(film_formats, format, &FormatRow::format);
}

long VideoOptions::key_interval() const {
    const auto seconds = [&](long count) { return std::max(count * fps_numerator / fps_denominator, 1L); };
    return frames > 0 ? std::clamp(frames / 8, seconds(1), seconds(5)) : seconds(5);
}

std::optional<FormatError> format_error(const VideoOptions& options) {
    const auto& row = format_row(options.format, options.codec);
    const auto [width, height] = options.size;
    const auto given = words_of(options.size);
    const bool has_alpha = row.has_alpha && (!row.is_encoded() || options.pixel_format == PixelFormat::yuv420);
    if (options.transparent && !has_alpha)
        return FormatError{
            "transparent",
            fmt::format("needs a format with opacity: png, apng, html, rgb, or webm (VP9, yuv420p); this is {}{}",
                        row.title, row.is_yuv() ? fmt::format(" in {}", pixels_words(options)) : "")};
    capture_libav_log();
    // the limit of libav: the padded bytes of a picture fit in 31 bits
    if (row.container && av_image_check_size(unsigned(width), unsigned(height), 0, nullptr) < 0)
        return FormatError{
            "size", fmt::format("exceeds what libav encodes as {}, some [16000, 16000]; it is {}", row.title, given)};
    const bool halved = row.is_yuv() && options.pixel_format != PixelFormat::yuv444;
    if (halved && (width % 2 != 0 || height % 2 != 0))
        return FormatError{
            "size", fmt::format("must be even for {} in {}; it is {}; {} is possible", row.title, pixels_words(options),
                                given, words_of({width + width % 2, height + height % 2}))};
    return std::nullopt;
}

std::optional<FormatError> rate_error(const VideoOptions& options) {
    const auto& row = format_row(options.format, options.codec);
    const long numerator = options.fps_numerator, denominator = options.fps_denominator;
    const auto given = denominator == 1 ? fmt::to_string(numerator) : fmt::format("{}/{}", numerator, denominator);
    const auto error = [&](const std::string& limit) {
        return FormatError{"fps", fmt::format("must be {}; it is {}", limit, given)};
    };
    if (row.max_fps > 0 && numerator > row.max_fps * denominator)
        return error(fmt::format("at most {}, as {}", row.max_fps, row.rate_words));
    if (row.longest_frame_s > 0 &&
        static_cast<double>(denominator) > row.longest_frame_s * static_cast<double>(numerator))
        return error(fmt::format("at least {:.3g}, as {}", 1 / row.longest_frame_s, row.rate_words));
    const long largest = std::max(numerator, denominator) / std::gcd(numerator, denominator);
    if (row.max_terms > 0 && largest > row.max_terms)
        return error(fmt::format("a fraction of whole numbers up to {}, as {}", row.max_terms, row.rate_words));
    return std::nullopt;
}

}  // namespace doppel
