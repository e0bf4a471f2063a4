#include "output/decoded.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/pixdesc.h>
}

#include <algorithm>
#include <cctype>
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

/// Each box at the top level of an MP4 starts with its length (big endian, 32 bits) and its name.
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

void add_metadata(const AVDictionary* dictionary, Video& video) {
    const AVDictionaryEntry* entry = nullptr;
    while ((entry = av_dict_get(dictionary, "", entry, AV_DICT_IGNORE_SUFFIX))) {
        std::string key = entry->key;
        std::ranges::transform(key, key.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        video.metadata[key] = entry->value;
    }
    video.title = video.metadata["title"];
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
    add_metadata(format.metadata, video);
    video.average_rate = ratio(stream.avg_frame_rate);
    video.base_rate = ratio(stream.r_frame_rate);
    video.duration = seconds(stream.duration, stream.time_base);
    for (unsigned k = 0; k < format.nb_chapters; ++k) {
        const AVChapter& chapter = *format.chapters[k];
        const auto* title = av_dict_get(chapter.metadata, "title", nullptr, 0);
        video.chapters.emplace_back(av_q2d(chapter.time_base) * static_cast<double>(chapter.start),
                                    title ? title->value : "");
    }
}

/// The duration in ticks of the stream.
std::int64_t duration_of(const AVFrame& frame) {
#if LIBAVUTIL_VERSION_INT >= AV_VERSION_INT(57, 30, 100)  // FFmpeg 6
    return frame.duration;
#else
    return frame.pkt_duration;
#endif
}

/// One component of a frame, scaled to 8 bits, for any layout of planes and bits.
std::vector<double> component(const AVFrame& frame, int which) {
    const AVPixFmtDescriptor& about = *av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format));
    const bool chroma = (which == 1 || which == 2) && !(about.flags & AV_PIX_FMT_FLAG_RGB);
    const int width = chroma ? frame.width >> about.log2_chroma_w : frame.width;
    const int height = chroma ? frame.height >> about.log2_chroma_h : frame.height;
    std::vector<std::uint16_t> line(static_cast<std::size_t>(width));
    std::vector<double> result;
    const double scale = std::ldexp(1.0, 8 - about.comp[which].depth);
    for (int row = 0; row < height; ++row) {
        av_read_image_line(line.data(), const_cast<const std::uint8_t**>(frame.data), frame.linesize, &about, 0, row,
                           which, width, about.flags & AV_PIX_FMT_FLAG_PAL);
        for (const auto sample : line) result.push_back(scale * sample);
    }
    return result;
}

Luma luma_of(const AVFrame& frame, long number) {
    const AVPixFmtDescriptor& about = *av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format));
    Luma luma{number, {frame.width, frame.height}, {}, {}, {}, {}};
    if (about.flags & AV_PIX_FMT_FLAG_ALPHA)
        for (const double alpha : component(frame, about.nb_components - 1))
            luma.alpha.push_back(static_cast<std::uint8_t>(alpha));
    if (!(about.flags & AV_PIX_FMT_FLAG_RGB)) {
        luma.y = component(frame, 0);
        luma.chroma = {component(frame, 1), component(frame, 2)};
        return luma;
    }
    luma.picture = Picture(luma.size);
    for (int c = 0; c < 3; ++c) {
        const auto colour = component(frame, c);
        for (std::size_t i = 0; i < colour.size(); ++i)
            luma.picture.rgba[4 * i + std::size_t(c)] = static_cast<std::uint8_t>(colour[i]);
    }
    for (std::size_t i = 0; i < luma.picture.rgba.size() / 4; ++i)
        luma.picture.rgba[4 * i + 3] = luma.alpha.empty() ? 255 : luma.alpha[i];
    return luma;
}

double psnr(double squares, std::size_t samples) {
    return 10.0 * std::log10(255.0 * 255.0 * static_cast<double>(samples) / squares);
}

}  // namespace

Video read_video(const std::filesystem::path& path, const std::function<void(const Luma&)>& each) {
    av_log_set_level(AV_LOG_QUIET);
    AVFormatContext* opened = nullptr;
    check(avformat_open_input(&opened, ("file:" + path.string()).c_str(), nullptr, nullptr) >= 0, path, "not opened");
    const std::unique_ptr<AVFormatContext, Free> format(opened);
    check(avformat_find_stream_info(opened, nullptr) >= 0, path, "no streams");
    // an MP4 has its chapters in a second stream, of text
    const bool has_chapters = format->nb_streams == 2 && format->nb_chapters > 0 &&
                              format->streams[1]->codecpar->codec_type == AVMEDIA_TYPE_DATA;
    check(format->nb_streams == 1 || has_chapters, path, "not one stream");
    if (has_chapters) format->streams[1]->discard = AVDISCARD_ALL;
    const AVStream& stream = *format->streams[0];
    const AVCodec* decoder = avcodec_find_decoder(stream.codecpar->codec_id);
    // libav's own decoder ignores alpha
    if (stream.codecpar->codec_id == AV_CODEC_ID_VP9) decoder = avcodec_find_decoder_by_name("libvpx-vp9");
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
            if (video.times.empty()) add_metadata(frame->metadata, video);
            if (each) each(luma_of(*frame, static_cast<long>(video.times.size())));
            video.times.push_back(seconds(frame->pts, stream.time_base));
            video.lasting.push_back(seconds(duration_of(*frame), stream.time_base));
        }
    };
    while (av_read_frame(format.get(), packet.get()) >= 0) {
        if (packet->stream_index == 0)
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
    return psnr(squares, decoded.y.size());
}

double rgb_psnr(const Picture& source, const Picture& decoded) {
    if (source.size != decoded.size) throw std::runtime_error("the sizes differ");
    double squares = 0.0;
    for (std::size_t i = 0; i < source.rgba.size(); ++i)
        if (const double off = source.rgba[i] - decoded.rgba[i]; i % 4 != 3) squares += off * off;
    return psnr(squares, source.rgba.size() / 4 * 3);
}

}  // namespace doppel::test
