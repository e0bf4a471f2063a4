#include "output/mp4.hpp"

#include "numeric/error.hpp"
#include "output/workers.hpp"
#include "output/yuv.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/imgutils.h>
#include <libavutil/opt.h>
}

#include <algorithm>
#include <array>
#include <string_view>

namespace doppel {
namespace {

struct Free {
    void operator()(AVFormatContext* format) const {
        avio_closep(&format->pb);
        avformat_free_context(format);
    }
    void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
    void operator()(AVFrame* frame) const { av_frame_free(&frame); }
    void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};

/// What libav allocates is null only where memory is out.
template <class T>
std::unique_ptr<T, Free> owned(T* thing) {
    if (!thing) throw std::bad_alloc();
    return std::unique_ptr<T, Free>(thing);
}

const AVCodec* find_x264() {
    if (const AVCodec* codec = avcodec_find_encoder_by_name("libx264")) return codec;
    std::string others;
    void* position = nullptr;
    while (const AVCodec* codec = av_codec_iterate(&position))
        if (codec->id == AV_CODEC_ID_H264 && av_codec_is_encoder(codec))
            others += fmt::format("{}{}", others.empty() ? "" : ", ", codec->name);
    throw io_failed("libav was built here without libx264, which Doppel encodes with; its H.264 encoders: {}",
                    others.empty() ? "none" : others);
}

void check(const Mp4Options& options) {
    static constexpr std::array presets = {"ultrafast", "superfast", "veryfast", "faster",   "fast",
                                           "medium",    "slow",      "slower",   "veryslow", "placebo"};
    const auto [width, height] = options.size;
    if (width % 2 != 0 || height % 2 != 0)
        throw bad_input("H.264 needs even sizes; {}x{} is not; {}x{} would do", width, height, width + width % 2,
                        height + height % 2);
    if (std::ranges::find(presets, std::string_view(options.preset)) == presets.end())
        throw bad_input("x264 has no preset \"{}\"; it has {}", options.preset, fmt::join(presets, ", "));
    if (options.crf < 0 || options.crf > 51) throw bad_input("crf must be 0 … 51; it is {}", options.crf);
}

/// Frames wait as what changed in them; the encoder's thread puts that into the one frame it keeps. (Queueing all of a
/// 1080p frame would add a copy of 0.2 ms: as much as it takes to convert a tenth of one.)
class Mp4Sink final : public Sink {
public:
    Mp4Sink(const std::filesystem::path& path, const Mp4Options& options)
        : path_(path.string()), format_(open_format(path_)), packet_(owned(av_packet_alloc())) {
        open_codec(options);
        open_frame();
        open_file(options);
    }

    void take(const Picture& picture, const std::vector<Rect>& changed) override {
        Changes changes;
        for (const Rect& area : changed)
            if (!area.empty()) changes.push_back(convert(picture, area));
        encoder_.give(std::move(changes));
    }

    void finish() override {
        encoder_.finish();
        send(nullptr);
        check(av_write_trailer(format_.get()), "the index cannot be written");
        avio_flush(format_->pb);
        check(format_->pb->error, "cannot be written");
        check(avio_closep(&format_->pb), "cannot be closed");
    }

private:
    using Changes = std::vector<YuvPart>;

    static std::unique_ptr<AVFormatContext, Free> open_format(const std::string& path) {
        // libav prints unless told not to; and takes what is before a colon for a protocol unless one is named
        av_log_set_level(AV_LOG_QUIET);
        AVFormatContext* format = nullptr;
        avformat_alloc_output_context2(&format, nullptr, "mp4", ("file:" + path).c_str());
        return owned(format);
    }

    void open_codec(const Mp4Options& options) {
        const AVCodec* x264 = find_x264();
        codec_ = owned(avcodec_alloc_context3(x264));
        codec_->width = options.size.width;
        codec_->height = options.size.height;
        codec_->sample_aspect_ratio = {1, 1};
        codec_->framerate = {options.fps_numerator, options.fps_denominator};
        codec_->time_base = av_inv_q(codec_->framerate);
        codec_->pix_fmt = AV_PIX_FMT_YUV420P;
        codec_->color_primaries = AVCOL_PRI_BT709;
        codec_->color_trc = AVCOL_TRC_BT709;
        codec_->colorspace = AVCOL_SPC_BT709;
        codec_->color_range = AVCOL_RANGE_MPEG;
        codec_->chroma_sample_location = AVCHROMA_LOC_CENTER;
        codec_->thread_count = options.threads;
        codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
        check(av_opt_set(codec_->priv_data, "preset", options.preset.c_str(), 0), "x264 refuses the preset");
        check(av_opt_set_double(codec_->priv_data, "crf", options.crf, 0), "x264 refuses the crf");
        check(avcodec_open2(codec_.get(), x264, nullptr), "x264 cannot be opened");
    }

    void open_frame() {
        frame_ = owned(av_frame_alloc());
        frame_->width = codec_->width;
        frame_->height = codec_->height;
        frame_->format = codec_->pix_fmt;
        frame_->pts = 0;
        check(av_frame_get_buffer(frame_.get(), 0), "no memory for a frame");
    }

    void open_file(const Mp4Options& options) {
        stream_ = avformat_new_stream(format_.get(), nullptr);
        if (!stream_) throw std::bad_alloc();
        check(avcodec_parameters_from_context(stream_->codecpar, codec_.get()), "the stream cannot be described");
        // the muxer multiplies 1/time_base by a power of two: every frame starts at a whole tick
        stream_->time_base = codec_->time_base;
        stream_->avg_frame_rate = stream_->r_frame_rate = codec_->framerate;
        if (!options.title.empty()) av_dict_set(&format_->metadata, "title", options.title.c_str(), 0);
        check(av_opt_set(format_->priv_data, "movflags", "+faststart", 0), "the muxer refuses faststart");
        check(avio_open(&format_->pb, format_->url, AVIO_FLAG_WRITE), "cannot be opened");
        check(avformat_write_header(format_.get(), nullptr), "the header cannot be written");
    }

    void encode(const Changes& changes) {
        check(av_frame_make_writable(frame_.get()), "no memory for a frame");
        for (const YuvPart& part : changes) paste(part);
        send(frame_.get());
        ++frame_->pts;
    }

    void paste(const YuvPart& part) {
        const int left = part.area.left, top = part.area.top;
        const std::array planes = {part.y(), part.cb(), part.cr()};
        for (std::size_t k = 0; k < planes.size(); ++k) {
            const int scale = k == 0 ? 1 : 2, width = part.width() / scale, stride = frame_->linesize[k];
            std::uint8_t* to = frame_->data[k] + std::ptrdiff_t(top / scale) * stride + left / scale;
            av_image_copy_plane(to, stride, planes[k], width, width, part.height() / scale);
        }
    }

    /// To the encoder, and what comes out of it to the file; no frame means that there are no more.
    void send(const AVFrame* frame) {
        check(avcodec_send_frame(codec_.get(), frame), "x264 refuses a frame");
        for (;;) {
            const int result = avcodec_receive_packet(codec_.get(), packet_.get());
            if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) return;
            check(result, "x264 cannot encode");
            packet_->duration = 1;
            av_packet_rescale_ts(packet_.get(), codec_->time_base, stream_->time_base);
            check(av_write_frame(format_.get(), packet_.get()), "cannot be written");
            av_packet_unref(packet_.get());
        }
    }

    void check(int result, std::string_view what) const {
        if (result >= 0) return;
        std::array<char, AV_ERROR_MAX_STRING_SIZE> reason{};
        av_strerror(result, reason.data(), reason.size());
        throw io_failed("{}: {}: {}", path_, what, reason.data());
    }

    std::string path_;
    std::unique_ptr<AVFormatContext, Free> format_;
    std::unique_ptr<AVCodecContext, Free> codec_;
    std::unique_ptr<AVFrame, Free> frame_;  // the picture as it is now; pts counts the frames
    std::unique_ptr<AVPacket, Free> packet_;
    AVStream* stream_ = nullptr;
    Workers<Changes> encoder_{1, 8, [this](const Changes& changes) { encode(changes); }};
};

std::string version(const char* name, unsigned number) {
    return fmt::format("{} {}.{}.{}", name, AV_VERSION_MAJOR(number), AV_VERSION_MINOR(number),
                       AV_VERSION_MICRO(number));
}

}  // namespace

std::unique_ptr<Sink> make_mp4_sink(const std::filesystem::path& path, const Mp4Options& options) {
    check(options);
    return std::make_unique<Mp4Sink>(path, options);
}

std::string libav_description() {
    return version("libavcodec", avcodec_version()) + ", " + version("libavformat", avformat_version());
}

}  // namespace doppel
