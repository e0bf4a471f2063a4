#include "output/video.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/pixdesc.h>
}

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <stdexcept>

namespace doppel::test {
namespace {

struct Free {
    void operator()(AVFormatContext* format) const { avformat_close_input(&format); }
    void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
    void operator()(AVFrame* frame) const { av_frame_free(&frame); }
    void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};

void check(bool fine, const std::filesystem::path& path, const char* what) {
    if (!fine) throw std::runtime_error(path.string() + ": " + what);
}

std::string word(const char* text) {
    return text ? text : "unknown";
}
Ratio ratio(AVRational r) {
    return {r.num, r.den};
}
Ratio seconds(std::int64_t ticks, AVRational base) {
    return {ticks * base.num, base.den};
}

/// The boxes at the top level of an MP4 each start with their length (big endian, 32 bits) and name.
bool moov_comes_first(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    for (unsigned char head[8]; file.read(reinterpret_cast<char*>(head), 8);) {
        const std::string name(head + 4, head + 8);
        if (name == "moov" || name == "mdat") return name == "moov";
        const long length = long{head[0]} << 24 | head[1] << 16 | head[2] << 8 | head[3];
        file.seekg(length - 8, std::ios::cur);
    }
    return false;
}

void describe(const AVFormatContext& format, const AVStream& stream, Video& video) {
    const AVCodecParameters& p = *stream.codecpar;
    video.size = {p.width, p.height};
    video.codec = avcodec_get_name(p.codec_id);
    video.pixel_format = word(av_get_pix_fmt_name(static_cast<AVPixelFormat>(p.format)));
    video.range = word(av_color_range_name(p.color_range));
    video.matrix = word(av_color_space_name(p.color_space));
    video.primaries = word(av_color_primaries_name(p.color_primaries));
    video.transfer = word(av_color_transfer_name(p.color_trc));
    video.chroma_location = word(av_chroma_location_name(p.chroma_location));
    if (const auto* entry = av_dict_get(format.metadata, "title", nullptr, 0)) video.title = entry->value;
    video.average_rate = ratio(stream.avg_frame_rate);
    video.base_rate = ratio(stream.r_frame_rate);
    video.duration = seconds(stream.duration, stream.time_base);
}

Luma luma_of(const AVFrame& frame, long number) {
    Luma luma{number, {frame.width, frame.height}, {}};
    for (int row = 0; row < frame.height; ++row) {
        const std::uint8_t* from = frame.data[0] + std::ptrdiff_t(row) * frame.linesize[0];
        luma.y.insert(luma.y.end(), from, from + frame.width);
    }
    return luma;
}

}  // namespace

Video read_video(const std::filesystem::path& path, const std::function<void(const Luma&)>& each) {
    av_log_set_level(AV_LOG_QUIET);
    AVFormatContext* opened = nullptr;
    check(avformat_open_input(&opened, ("file:" + path.string()).c_str(), nullptr, nullptr) >= 0, path, "not opened");
    const std::unique_ptr<AVFormatContext, Free> format(opened);
    check(avformat_find_stream_info(opened, nullptr) >= 0 && format->nb_streams == 1, path, "not one stream");
    const AVStream& stream = *format->streams[0];
    const AVCodec* decoder = avcodec_find_decoder(stream.codecpar->codec_id);
    check(decoder, path, "no decoder");
    const std::unique_ptr<AVCodecContext, Free> codec(avcodec_alloc_context3(decoder));
    avcodec_parameters_to_context(codec.get(), stream.codecpar);
    codec->pkt_timebase = stream.time_base;
    check(avcodec_open2(codec.get(), decoder, nullptr) >= 0, path, "the decoder does not open");

    Video video;
    describe(*format, stream, video);
    video.index_at_front = moov_comes_first(path);
    const std::unique_ptr<AVPacket, Free> packet(av_packet_alloc());
    const std::unique_ptr<AVFrame, Free> frame(av_frame_alloc());
    const auto take_frames = [&] {
        while (avcodec_receive_frame(codec.get(), frame.get()) >= 0) {
            check(frame->decode_error_flags == 0, path, "a frame is damaged");
            if (each) each(luma_of(*frame, static_cast<long>(video.times.size())));
            video.times.push_back(seconds(frame->pts, stream.time_base));
            video.lasting.push_back(seconds(frame->pkt_duration, stream.time_base));
        }
    };
    while (av_read_frame(format.get(), packet.get()) >= 0) {
        check(avcodec_send_packet(codec.get(), packet.get()) >= 0, path, "a packet is refused");
        av_packet_unref(packet.get());
        take_frames();
    }
    avcodec_send_packet(codec.get(), nullptr);
    take_frames();
    return video;
}

double luma_psnr(const Picture& source, const Luma& decoded) {
    if (source.size != decoded.size) throw std::runtime_error("the sizes differ");
    double squares = 0.0;
    for (std::size_t i = 0; i < decoded.y.size(); ++i) {
        const std::uint8_t* pixel = &source.rgba[4 * i];
        const double y = 16.0 + 219.0 / 255.0 * (0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2]);
        squares += (y - decoded.y[i]) * (y - decoded.y[i]);
    }
    return 10.0 * std::log10(255.0 * 255.0 * static_cast<double>(decoded.y.size()) / squares);
}

}  // namespace doppel::test
