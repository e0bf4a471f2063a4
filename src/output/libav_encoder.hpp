#pragma once

#include "image/picture.hpp"
#include "output/blocks.hpp"
#include "output/samples.hpp"
#include "output/sink.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <atomic>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

/// Makes libav and its encoders print nothing; the last error message of each thread is kept.
void capture_libav_log();

/// Frees what libav allocated.
struct LibavFree {
    void operator()(AVFormatContext* format) const {
        auto* file = format->pb;
        avformat_free_context(format);
        avio_closep(&file);
    }
    void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
    void operator()(AVFrame* frame) const { av_frame_free(&frame); }
    void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
template <class T>
using Libav = std::unique_ptr<T, LibavFree>;

/// The first of these encoders that libav contains. Throws Error (exit 4) that lists libav's encoders for the codec.
const AVCodec& find_encoder(const std::vector<const char*>& names, std::string_view codec);

struct Encoding {
    VideoOptions options;
    const FormatRow& row;
    const AVCodec* encoder;          // from find_encoder()
    AVPixelFormat pixels;            // Y, Cb and Cr are tagged BT.709, limited range, chroma in the centre
    AVRational tick;                 // time base, s
    long segment = 1, segments = 1;  // frames after which the encoder starts anew, and the number of such segments
    std::size_t threads = encoder_threads;
    Metadata encoder_options = {}, container_options = {};  // with libav's names
    std::string png_chunks = {};                            // inserted after the header of an APNG
};

/// For checked options of a format with an encoder. Throws Error (exit 4) if libav lacks the encoder.
Encoding encoding_of(const VideoOptions& options);

/// Opens an encoder with these parameters. `name` is named in errors. Throws Error (exit 4).
Libav<AVCodecContext> open_encoder(const Encoding& encoding, const std::string& name);

/// Throws Error (exit 4) "NAME: WHAT: …" with libav's reasons if `result` is an error.
void check_libav(int result, const std::string& name, std::string_view what);

/// A frame with allocated planes.
Libav<AVFrame> make_frame(Size size, AVPixelFormat pixels);

/// Copies the changed areas to their places in the frame.
void put(const SampledAreas& changes, AVFrame& frame);

/// An encoder and its output file, a video or a part of one. All functions throw Error: exit 4 with the path and
/// libav's reason, exit 130 soon after `stop` is set.
class Encoder {
public:
    /// Opens the file; "-" is standard output. The encoder is opened with the first frame: SVT-AV1 hangs if closed
    /// without one.
    Encoder(const std::filesystem::path& place, Encoding encoding, const std::atomic<bool>& stop);

    AVPixelFormat pixels() const { return encoding_.pixels; }
    /// The frame sent last, made writable.
    AVFrame& frame();
    /// Encodes frame() with this start and duration, in ticks.
    void send_frame(std::int64_t time, std::int64_t duration);
    /// Adds the packets of a part, in place of frames. All parts are required, in order.
    void add(BlockFile& part);
    /// A chapter that begins at this tick, and ends where the next one begins.
    void add_chapter(std::int64_t time, const std::string& title) { chapters_.emplace_back(time, title); }
    /// Sets an option of the container; it takes effect at the next write.
    void set_option(const char* name, const std::string& value);
    /// Completes the file after the last frame; at least one frame is required. `ending` replaces its last byte.
    void finish(std::string_view ending = {});

private:
    void open_without_frames();
    void write_header();
    void write_chapters();
    void end_segment();
    void write_packets();
    void write_packet();
    void insert_png_chunks();
    void check(int result, std::string_view what) const;

    const std::string path_;
    Encoding encoding_;
    const std::atomic<bool>& stop_;
    Stream file_;
    std::optional<BlockFile> part_;
    Libav<AVFormatContext> format_;  // writes the file, unless it is a part
    Libav<AVCodecContext> codec_;
    Libav<AVFrame> frame_;
    Libav<AVPacket> packet_;
    AVStream* stream_ = nullptr;
    std::int64_t duration_ = 1, end_ = 0;  // of the last packet, ticks
    std::vector<std::pair<std::int64_t, std::string>> chapters_;
};

/// Throws Error (exit 4) if libavfilter is missing.
void check_gif_filters();

/// The sink for FilmFormat::gif; the options must be checked. See make_video_sink().
std::unique_ptr<Sink> make_gif_sink(const std::filesystem::path& place, const VideoOptions& options,
                                    const std::atomic<bool>& stop);

}  // namespace doppel
