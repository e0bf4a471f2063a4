#pragma once

#include "image/picture.hpp"
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

/// From now on libav and its encoders print nothing; the last error message of each thread is kept.
void capture_libav_log();

/// Takes the last error message of this thread, one line; empty where there is none.
std::string take_libav_error();

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

/// The first of these encoders that libav has. Throws Error (exit 4) that lists its encoders for the codec.
const AVCodec& find_encoder(const std::vector<const char*>& names, AVCodecID codec);

/// Parameters of container and encoder.
struct Encoding {
    const char* container;   // libav's name of it
    const AVCodec* encoder;  // of find_encoder()
    AVPixelFormat pixels;    // Y, Cb and Cr are tagged BT.709, limited range, chroma in the centre
    Size size;
    AVRational frame_rate;
    AVRational tick;  // s, the time base
    std::size_t threads = 1;
    Metadata encoder_options = {}, container_options = {};  // by libav's names
    Metadata metadata = {};
    std::string png_chunks = {};  // to follow the header of an APNG
};

/// Throws as check_video() for everything but a missing encoder.
void check_options(const VideoOptions& options);

/// For options that check_options() passes. Throws Error (exit 4) where libav lacks the encoder.
Encoding encoding_of(const VideoOptions& options);

/// An encoder with these parameters, opened. `name` = what errors are about. Throws Error (exit 4).
Libav<AVCodecContext> open_encoder(const Encoding& encoding, const std::string& name);

/// Throws Error (exit 4) where libav returned an error: "NAME: WHAT: …", with its reasons.
void check_libav(int result, const std::string& name, std::string_view what);

/// A frame with room for its samples.
Libav<AVFrame> make_frame(Size size, AVPixelFormat pixels);

/// Copies what changed to its place in the frame.
void put(const SampledAreas& changes, AVFrame& frame);

/// An encoder and the file it fills. All throw Error: exit 4 with the path and libav's reason, exit 130 soon after
/// `stop` is set.
class Encoder {
public:
    /// Opens the file. The encoder is opened with the first frame: SVT-AV1 hangs if closed without one.
    Encoder(const std::filesystem::path& place, Encoding encoding, const std::atomic<bool>& stop);

    AVPixelFormat pixels() const { return encoding_.pixels; }
    /// The frame last sent, writable.
    AVFrame& frame();
    /// Encodes frame() with this start and duration, in ticks.
    void send_frame(std::int64_t time, std::int64_t duration);
    /// Of the container; takes effect with the next write.
    void set_option(const char* name, const std::string& value);
    /// After the last frame (there must have been one): completes the file, then overwrites its last `replaced` bytes
    /// with `ending`.
    void finish(std::string_view ending = {}, int replaced = 0);

private:
    void write_header();
    void write_packets();
    void insert_png_chunks();
    void check(int result, std::string_view what) const;

    const std::string path_;
    Encoding encoding_;
    const std::atomic<bool>& stop_;
    Stream file_;
    Libav<AVFormatContext> format_;  // which writes it
    Libav<AVCodecContext> codec_;
    Libav<AVFrame> frame_;
    Libav<AVPacket> packet_;
    AVStream* stream_ = nullptr;
    std::int64_t duration_ = 1;
};

}  // namespace doppel
