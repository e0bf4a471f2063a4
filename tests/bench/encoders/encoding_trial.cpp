#include "bench/encoders/encoding_trial.hpp"

#include "base/error.hpp"
#include "base/machine.hpp"
#include "output/libav_encoder.hpp"

extern "C" {
#include <libavutil/mem.h>
}

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <span>

namespace doppel {
namespace {

using Packets = std::vector<Libav<AVPacket>>;

/// A sum over a part of a picture, and the size of that part.
struct Mean {
    double sum = 0, count = 0;
    void add(double value, double weight) {
        sum += value;
        count += weight;
    }
    double value() const { return count == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / count; }
};

/// Squared errors and similarities of whole pictures and of their moving parts.
struct Comparison {
    Mean whole_error, moving_error, whole_ssim, moving_ssim;
};

/// The macroblocks of a picture, row by row, and which of them move.
struct Blocks {
    static constexpr int side = 16;  // px
    explicit Blocks(Size size) : across((size.width + side - 1) / side), down((size.height + side - 1) / side) {
        moves.assign(static_cast<std::size_t>(across) * static_cast<std::size_t>(down), false);
    }
    int across, down;
    std::vector<bool> moves;

    bool at(int x, int y) const {  // px
        return moves[static_cast<std::size_t>(y / side) * static_cast<std::size_t>(across) +
                     static_cast<std::size_t>(x / side)];
    }
    void mark(const Rect& area) {
        for (int y = area.top / side; y <= (area.bottom - 1) / side; ++y)
            for (int x = area.left / side; x <= (area.right - 1) / side; ++x)
                moves[static_cast<std::size_t>(y) * static_cast<std::size_t>(across) + static_cast<std::size_t>(x)] =
                    true;
    }
};

Blocks moving_blocks(const RecordedFrames& recorded) {
    Blocks blocks(recorded.size);
    for (const auto& frame : std::span(recorded.frames).subspan(1))
        for (const auto& area : frame.areas) blocks.mark(area);
    return blocks;
}

/// Luma of a frame at a pixel.
const std::uint8_t* luma(const AVFrame& frame, int x, int y) {
    return frame.data[0] + std::ptrdiff_t{y} * frame.linesize[0] + x;
}

double squared_error(const AVFrame& a, const AVFrame& b, const Rect& area) {
    std::int64_t sum = 0;
    for (int y = area.top; y < area.bottom; ++y) {
        const auto *p = luma(a, area.left, y), *q = luma(b, area.left, y);
        int row = 0;
        for (int x = 0; x < area.right - area.left; ++x) row += (p[x] - q[x]) * (p[x] - q[x]);
        sum += row;
    }
    return static_cast<double>(sum);
}

/// Structural similarity of the 8×8 px whose corner is at (left, top).
double similarity(const AVFrame& a, const AVFrame& b, int left, int top) {
    int sum_p = 0, sum_q = 0, squares = 0, products = 0;
    for (int y = 0; y < 8; ++y) {
        const auto *p = luma(a, left, top + y), *q = luma(b, left, top + y);
        for (int x = 0; x < 8; ++x) {
            sum_p += p[x];
            sum_q += q[x];
            squares += p[x] * p[x] + q[x] * q[x];
            products += p[x] * q[x];
        }
    }
    constexpr double n = 64, c1 = 0.01 * 0.01 * 255 * 255 * n * n, c2 = 0.03 * 0.03 * 255 * 255 * n * (n - 1);
    const double pp = double(sum_p) * sum_p, qq = double(sum_q) * sum_q, pq = double(sum_p) * sum_q;
    return (2 * pq + c1) * (2 * (n * products - pq) + c2) / ((pp + qq + c1) * (n * squares - pp - qq + c2));
}

void compare(const AVFrame& a, const AVFrame& b, const Blocks& blocks, bool with_ssim, Comparison& into) {
    for (int y = 0; y < a.height; y += Blocks::side)
        for (int x = 0; x < a.width; x += Blocks::side) {
            const Rect area{x, y, std::min(x + Blocks::side, a.width), std::min(y + Blocks::side, a.height)};
            const double error = squared_error(a, b, area),
                         pixels = double(area.right - area.left) * (area.bottom - area.top);
            into.whole_error.add(error, pixels);
            if (blocks.at(x, y)) into.moving_error.add(error, pixels);
        }
    for (int y = 0; with_ssim && y + 8 <= a.height; y += 4)
        for (int x = 0; x + 8 <= a.width; x += 4) {
            const double alike = similarity(a, b, x, y);
            into.whole_ssim.add(alike, 1);
            if (blocks.at(x, y)) into.moving_ssim.add(alike, 1);
        }
}

Quality quality(const Mean& error, const Mean& ssim) {
    constexpr double peak = 255;
    return {.psnr_db = 10 * std::log10(peak * peak / error.value()), .ssim = ssim.value()};
}

Libav<AVPacket> new_packet() {
    auto* packet = av_packet_alloc();
    if (!packet) throw std::bad_alloc();
    return Libav<AVPacket>(packet);
}

void take_packets(AVCodecContext& encoder, Packets& packets) {
    for (auto packet = new_packet(); avcodec_receive_packet(&encoder, packet.get()) == 0; packet = new_packet())
        packets.push_back(std::move(packet));
}

Packets encode(const RecordedFrames& recorded, AVCodecContext& encoder, const std::atomic<bool>& stop) {
    Packets packets;
    const auto frame = make_frame(recorded.size, encoder.pix_fmt);
    std::int64_t time = 0;
    for (const auto& changes : recorded.frames) {
        throw_if_set(stop);
        check_libav(av_frame_make_writable(frame.get()), "a trial", "no memory for a frame");
        put(changes, *frame);
        frame->pts = time++;
        check_libav(avcodec_send_frame(&encoder, frame.get()), "a trial", "the encoder refuses a frame");
        take_packets(encoder, packets);
    }
    check_libav(avcodec_send_frame(&encoder, nullptr), "a trial", "the encoder refuses the end");
    take_packets(encoder, packets);
    return packets;
}

Libav<AVCodecContext> open_decoder(const AVCodecContext& encoder) {
    const auto* codec = encoder.codec_id == AV_CODEC_ID_AV1 ? avcodec_find_decoder_by_name("libdav1d") : nullptr;
    if (!codec) codec = avcodec_find_decoder(encoder.codec_id);
    if (!codec) throw io_failed("libav was built here without a decoder of {}", avcodec_get_name(encoder.codec_id));
    Libav<AVCodecContext> decoder(avcodec_alloc_context3(codec));
    if (!decoder) throw std::bad_alloc();
    const auto size = static_cast<std::size_t>(encoder.extradata_size);
    decoder->extradata = static_cast<std::uint8_t*>(av_mallocz(size + AV_INPUT_BUFFER_PADDING_SIZE));
    if (!decoder->extradata) throw std::bad_alloc();
    if (size > 0) std::memcpy(decoder->extradata, encoder.extradata, size);
    decoder->extradata_size = encoder.extradata_size;
    check_libav(avcodec_open2(decoder.get(), codec, nullptr), "a trial", "the decoder cannot be opened");
    return decoder;
}

/// Decodes the packets and compares frame by frame.
Comparison decode(const Packets& packets, const AVCodecContext& encoder, const RecordedFrames& recorded,
                  const std::atomic<bool>& stop) {
    constexpr std::size_t ssim_every = 7;  // frames: alternates between all positions among the B-frames
    const auto decoder = open_decoder(encoder);
    const auto blocks = moving_blocks(recorded);
    const auto shown = make_frame(recorded.size, encoder.pix_fmt);
    const Libav<AVFrame> decoded(av_frame_alloc());
    if (!decoded) throw std::bad_alloc();
    Comparison comparison;
    std::size_t frames = 0;
    const auto send = [&](const AVPacket* packet) {
        throw_if_set(stop);
        check_libav(avcodec_send_packet(decoder.get(), packet), "a trial", "cannot be decoded");
        while (avcodec_receive_frame(decoder.get(), decoded.get()) == 0 && frames < recorded.frames.size()) {
            put(recorded.frames[frames], *shown);
            compare(*shown, *decoded, blocks, frames % ssim_every == 0, comparison);
            ++frames;
        }
    };
    for (const auto& packet : packets) send(packet.get());
    send(nullptr);
    if (frames != recorded.frames.size())
        throw io_failed("of {} frames {} were decoded", recorded.frames.size(), frames);
    return comparison;
}

void replace(Metadata& options, const Metadata& replaced) {
    for (const auto& [key, value] : replaced) {
        const auto found = std::ranges::find(options, key, &Metadata::value_type::first);
        if (found == options.end())
            options.emplace_back(key, value);
        else if (key == "x264-params")
            found->second += ":" + value;  // x264 uses the later of two values
        else
            found->second = value;
    }
}

/// The result of encoding, before decoding.
struct Encoded {
    EncodingCost cost;
    Libav<AVCodecContext> encoder;
    Packets packets;
};

/// Includes the second stream, in which VP9 stores opacity.
std::size_t bytes_of(const AVPacket& packet) {
    std::size_t opacity = 0;
    av_packet_get_side_data(&packet, AV_PKT_DATA_MATROSKA_BLOCKADDITIONAL, &opacity);
    return static_cast<std::size_t>(packet.size) + opacity;
}

Encoded encoded(const RecordedFrames& recorded, const VideoOptions& options, const Metadata& replaced,
                const std::atomic<bool>& stop) {
    auto encoding = encoding_of(options);
    replace(encoding.encoder_options, replaced);
    capture_libav_log();
    Encoded result;
    const double start = seconds_of(CLOCK_PROCESS_CPUTIME_ID), wall_start = seconds_of(CLOCK_MONOTONIC);
    result.encoder = open_encoder(encoding, "a trial");
    result.packets = encode(recorded, *result.encoder, stop);
    result.cost.cpu_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - start;
    result.cost.wall_s = seconds_of(CLOCK_MONOTONIC) - wall_start;
    for (const auto& packet : result.packets) result.cost.bytes += bytes_of(*packet);
    if (!result.packets.empty()) result.cost.first_bytes = bytes_of(*result.packets.front());
    return result;
}

}  // namespace

EncodedFrames try_encoding(const RecordedFrames& recorded, const VideoOptions& options, const Metadata& replaced,
                           const std::atomic<bool>& stop) {
    const auto [cost, encoder, packets] = encoded(recorded, options, replaced, stop);
    const auto comparison = decode(packets, *encoder, recorded, stop);
    return {cost, quality(comparison.whole_error, comparison.whole_ssim),
            quality(comparison.moving_error, comparison.moving_ssim)};
}

EncodingCost time_encoding(const RecordedFrames& recorded, const VideoOptions& options, const Metadata& replaced,
                           const std::atomic<bool>& stop) {
    return encoded(recorded, options, replaced, stop).cost;
}

}  // namespace doppel
