#pragma once

#include "image/picture.hpp"
#include "output/folder.hpp"
#include "output/video.hpp"

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

/// libav, and the encoders behind it, print nothing from now on; what went wrong last is kept, for each thread.
void capture_libav_log();

/// What libav said last in this thread of what went wrong: one line without its end; empty where it said nothing since
/// it was asked last.
std::string take_libav_error();

/// The file that a muxer of libav fills, opened as create_file() does: libav itself, given a name, would follow links.
class LibavFile {
public:
    /// Throws Error (exit 4).
    explicit LibavFile(const FilePlace& place) : file_(create_file(place)) {}
    ~LibavFile();
    LibavFile(const LibavFile&) = delete;
    LibavFile& operator=(const LibavFile&) = delete;

    /// The muxer, which this outlives, writes here; where it opens its file anew to read it (to move the index of an
    /// MP4 to the front) it gets this one.
    void attach(AVFormatContext& format);

    /// All that was written has left the process. libav's code of what failed, 0 where nothing did.
    int close();

private:
    Descriptor file_;
    AVIOContext* writer_ = nullptr;
};

/// Frees what libav allocated.
struct LibavFree {
    void operator()(AVFormatContext* format) const { avformat_free_context(format); }
    void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
    void operator()(AVFrame* frame) const { av_frame_free(&frame); }
    void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
template <class T>
using Libav = std::unique_ptr<T, LibavFree>;

/// The first of these encoders that libav has. Throws Error (exit 4) that lists what it has for the codec instead.
const AVCodec& find_encoder(const std::vector<const char*>& names, AVCodecID codec);

/// How a film becomes a file.
struct Encoding {
    const char* container;   // libav's name of it
    const AVCodec* encoder;  // of find_encoder()
    AVPixelFormat pixels;    // Y, Cb and Cr are tagged BT.709, limited range, chroma in the centre
    Size size;
    AVRational frame_rate;
    AVRational tick;  // s; the times of frames are counted in it
    std::size_t threads = 1;
    Metadata encoder_options = {}, container_options = {};  // by libav's names
    Metadata metadata = {};
    std::string png_chunks = {};  // to follow the header of an APNG
};

/// Throws as check_video() for everything but a missing encoder.
void check_options(const VideoOptions& options);

/// What libav has to do, of checked options. Throws Error (exit 4) where it lacks the encoder.
Encoding encoding_of(const VideoOptions& options);

/// An encoder and the file it fills. All throw Error: exit 4 with the path and libav's reason, exit 130 soon after
/// `stop` is set.
class Encoder {
public:
    /// Opens the file. The encoder itself is opened with the first frame: SVT-AV1 waits for ever where it is closed
    /// before it had one.
    Encoder(const FilePlace& place, Encoding encoding, const std::atomic<bool>& stop);

    AVPixelFormat pixels() const { return encoding_.pixels; }
    /// The picture as it is now: its planes can be written to.
    AVFrame& frame();
    /// The picture is the next frame; it starts at this time and lasts so long, in ticks.
    void send_frame(std::int64_t time, std::int64_t lasting);
    /// Of the container; it counts from the next write on.
    void set_option(const char* name, const std::string& value);
    /// No frame follows (there must have been one); the file is complete, but for its last bytes, as many as told,
    /// which `ending` takes the place of.
    void finish(std::string_view ending = {}, int replaced = 0);

private:
    void open_codec();
    void open_frame();
    void write_header();
    void write_packets();
    void insert_png_chunks();
    void check(int result, std::string_view what) const;

    const std::string path_;
    Encoding encoding_;
    const std::atomic<bool>& stop_;
    LibavFile file_;
    Libav<AVFormatContext> format_;
    Libav<AVCodecContext> codec_;
    Libav<AVFrame> frame_;
    Libav<AVPacket> packet_;
    AVStream* stream_ = nullptr;
    std::int64_t lasting_ = 1;
};

}  // namespace doppel
