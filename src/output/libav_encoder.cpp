#include "output/libav_encoder.hpp"

#include "base/error.hpp"
#include "base/machine.hpp"
#include "base/threads.hpp"
#include "output/files.hpp"
#include "output/sink.hpp"
#include "output/workers.hpp"

#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <stdexcept>
#include <utility>

extern "C" {
#include <libavutil/imgutils.h>
#include <libavutil/log.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
}

namespace doppel {
namespace {

// the log callback does not say which encoder calls it, but each encoder has its own thread
thread_local std::string messages;

/// One line may arrive in several calls.
void keep(void* /*source*/, int level, const char* format, va_list arguments) {
    constexpr std::size_t maximum = 4096;
    std::array<char, 512> piece{};
    if (level > AV_LOG_ERROR || std::vsnprintf(piece.data(), piece.size(), format, arguments) < 0) return;
    try {
        messages += piece.data();
        if (messages.size() > maximum) messages.erase(0, messages.size() - maximum);
    } catch (...) {  // out of memory; an exception must not pass through C code
    }
}

/// Returns and clears the last error message of this thread, one line; empty if there is none.
std::string take_libav_error() {
    auto text = std::exchange(messages, {});
    text.resize(text.find_last_not_of(" \n\r.") + 1);  // without final full stops
    return text.empty() ? text : text.substr(text.find_first_not_of(' ', text.rfind('\n') + 1));
}

template <class T>
Libav<T> owned(T* thing) {
    return Libav<T>(checked(thing));
}

/// A muxer that writes the open file. libav would open files by name and follow links, so the path of the descriptor is
/// used. (It opens an MP4 again, to put the index at the front.)
Libav<AVFormatContext> open_format(std::FILE* file, const std::string& path, const Encoding& encoding) {
    capture_libav_log();
    const auto address =
        fmt::format("{}{}", encoding.options.is_stream ? "pipe:" : "file:/proc/self/fd/", fileno(file));
    AVFormatContext* format = nullptr;
    avformat_alloc_output_context2(&format, nullptr, encoding.row.container, address.c_str());
    auto muxer = owned(format);
    if (encoding.row.format == FilmFormat::y4m) muxer->strict_std_compliance = FF_COMPLIANCE_UNOFFICIAL;  // ten bits
    check_libav(avio_open(&muxer->pb, address.c_str(), AVIO_FLAG_WRITE), path, "cannot be written");
    return muxer;
}

void set_side_data(AVPacket& packet, AVPacketSideDataType type, std::string_view bytes) {
    std::memcpy(checked(av_packet_new_side_data(&packet, type, bytes.size())), bytes.data(), bytes.size());
}

std::string text(const std::uint8_t* bytes, std::size_t size) {
    return {reinterpret_cast<const char*>(bytes), size};
}

/// Writes a packet with all that the muxer needs.
void write_block(AVPacket& packet, BlockFile& part) {
    auto bytes = text(packet.data, static_cast<std::size_t>(packet.size));
    part(packet.pts, packet.dts, packet.flags, packet.side_data_elems, bytes);
    for (int i = 0; i < packet.side_data_elems; ++i) {
        bytes = text(packet.side_data[i].data, packet.side_data[i].size);
        part(packet.side_data[i].type, bytes);
    }
    part.end_block();
}

void read_block(BlockFile& part, AVPacket& packet) {
    std::int64_t pts = 0, dts = 0;
    int flags = 0, side_data = 0;
    std::string bytes;
    part(pts, dts, flags, side_data, bytes);
    if (av_new_packet(&packet, static_cast<int>(bytes.size())) < 0) throw std::bad_alloc();
    std::memcpy(packet.data, bytes.data(), bytes.size());
    packet.pts = pts;
    packet.dts = dts;
    packet.flags = flags;
    for (int i = 0; i < side_data; ++i) {
        AVPacketSideDataType type{};
        part(type, bytes);
        set_side_data(packet, type, bytes);
    }
}

std::string version(const char* name, unsigned number) {
    return fmt::format("{} {}.{}.{}", name, AV_VERSION_MAJOR(number), AV_VERSION_MINOR(number),
                       AV_VERSION_MICRO(number));
}

/// The queue contains the changes from frame to frame; the encoder's thread applies them to its one frame. (Queueing
/// whole 1080p frames would add a copy of 0.2 ms.)
class VideoSink final : public Sink {
public:
    VideoSink(const std::filesystem::path& place, const VideoOptions& options, const std::atomic<bool>& stop)
        : encoder_(place, encoding_of(options), stop),
          sent_(options.first_frame),
          encoding_(1, affordable(byte_count(pixels_, all_of(options.size)), 8),
                    [this](SampledAreas& changes) { encode(changes); }) {}

    void take(const Picture& picture, const std::vector<Rect>& changed) override {
        SampledAreas changes = encoding_.spare();
        convert(picture, changed, pixels_, changes);
        encoding_.give(std::move(changes));
    }

    void add(BlockFile& part) override { encoder_.add(part); }
    void add_chapter(long frame, const std::string& title) override { encoder_.add_chapter(frame, title); }

    void finish() override {
        encoding_.finish();
        encoder_.finish();
    }

private:
    void encode(const SampledAreas& changes) {
        put(changes, encoder_.frame());
        encoder_.send_frame(sent_++, 1);
    }

    Encoder encoder_;
    const AVPixelFormat pixels_ = encoder_.pixels();
    std::int64_t sent_;
    Workers<SampledAreas> encoding_;
};

}  // namespace

void capture_libav_log() {
    av_log_set_callback(keep);
    // SVT-AV1 has its own log, which only the environment controls
    setenv("SVT_LOG", "0", 0);
}

const AVCodec& find_encoder(const std::vector<const char*>& names, std::string_view codec) {
    for (const char* name : names)
        if (const AVCodec* encoder = avcodec_find_encoder_by_name(name)) return *encoder;
    std::vector<std::string_view> others;
    void* position = nullptr;
    while (const AVCodec* other = av_codec_iterate(&position))
        if (avcodec_get_name(other->id) == codec && av_codec_is_encoder(other)) others.emplace_back(other->name);
    throw io_failed("libav was built here without {}, which Doppel encodes with; its encoders of {}: {}",
                    fmt::join(names, " and "), codec,
                    others.empty() ? "none" : fmt::format("{}", fmt::join(others, ", ")));
}

void check_libav(int result, const std::string& name, std::string_view what) {
    if (result >= 0) {
        take_libav_error();  // only a warning
        return;
    }
    std::array<char, AV_ERROR_MAX_STRING_SIZE> reason{};
    av_strerror(result, reason.data(), reason.size());
    const auto error = take_libav_error();
    throw Error(code_of_errno(AVUNERROR(result)),
                fmt::format("{}: {}: {}{}{}", name, what, error, error.empty() ? "" : ": ", reason.data()));
}

Libav<AVFrame> make_frame(Size size, AVPixelFormat pixels) {
    auto frame = owned(av_frame_alloc());
    frame->width = size.width;
    frame->height = size.height;
    frame->format = pixels;
    if (av_frame_get_buffer(frame.get(), 0) < 0) throw std::bad_alloc();
    return frame;
}

void put(const SampledAreas& changes, AVFrame& frame) {
    const auto pixels = static_cast<AVPixelFormat>(frame.format);
    const std::uint8_t* from = changes.bytes.data();
    for (const Rect& area : changes.areas)
        for (int k = 0; k < av_pix_fmt_count_planes(pixels); ++k) {
            const auto [offset, row_bytes, top, rows] = plane_area(pixels, k, area);
            const int stride = frame.linesize[k];
            av_image_copy_plane(frame.data[k] + std::ptrdiff_t{top} * stride + offset, stride, from, row_bytes,
                                row_bytes, rows);
            from += std::ptrdiff_t{row_bytes} * rows;
        }
}

Libav<AVCodecContext> open_encoder(const Encoding& encoding, const std::string& name) {
    const std::string_view encoder = encoding.encoder->name;
    // if threads cannot be started, SVT-AV1 (some 110 threads) hangs and libaom aborts
    if (encoding.row.is_yuv()) need_threads(encoder == "libsvtav1" ? 200 : 3 * encoding.threads);
    auto codec = owned(avcodec_alloc_context3(encoding.encoder));
    codec->width = encoding.options.size.width;
    codec->height = encoding.options.size.height;
    codec->sample_aspect_ratio = {1, 1};
    codec->framerate = {static_cast<int>(encoding.options.fps_numerator),
                        static_cast<int>(encoding.options.fps_denominator)};
    codec->time_base = encoding.tick;
    codec->pix_fmt = encoding.pixels;
    if (encoding.row.is_yuv()) {
        codec->color_primaries = AVCOL_PRI_BT709;
        codec->color_trc = AVCOL_TRC_BT709;
        codec->colorspace = AVCOL_SPC_BT709;
        codec->color_range = AVCOL_RANGE_MPEG;
        codec->chroma_sample_location = AVCHROMA_LOC_CENTER;
    }
    codec->thread_count = static_cast<int>(encoding.threads);
    codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    for (const auto& [key, value] : encoding.encoder_options)
        check_libav(av_opt_set(codec.get(), key.c_str(), value.c_str(), AV_OPT_SEARCH_CHILDREN), name,
                    fmt::format("{} refuses {} = {}", encoder, key, value));
    check_libav(avcodec_open2(codec.get(), encoding.encoder, nullptr), name,
                fmt::format("{} cannot be opened", encoder));
    return codec;
}

Encoder::Encoder(const std::filesystem::path& place, Encoding encoding, const std::atomic<bool>& stop)
    : path_(place == "-" ? "standard output" : place.string()),
      encoding_(std::move(encoding)),
      stop_(stop),
      packet_(owned(av_packet_alloc())) {
    frame_ = make_frame(encoding_.options.size, encoding_.pixels);
    if (!encoding_.options.part_header.empty()) {
        part_.emplace(place, encoding_.options.part_header);
        return;
    }
    file_ = place == "-" ? Stream(fdopen(dup(STDOUT_FILENO), "wb")) : create_file(place);
    if (!file_) throw cannot(path_, "written");
    format_ = open_format(file_.get(), path_, encoding_);
    for (const auto& [key, value] : encoding_.container_options) set_option(key.c_str(), value);
}

void Encoder::write_header() {
    stream_ = checked(avformat_new_stream(format_.get(), nullptr));
    check(avcodec_parameters_from_context(stream_->codecpar, codec_.get()), "the stream cannot be described");
    // MP4 multiplies 1/time_base by a power of two, so that every frame starts at a whole tick
    stream_->time_base = codec_->time_base;
    stream_->avg_frame_rate = stream_->r_frame_rate = codec_->framerate;
    // with this flag Matroska numbers its tracks instead of giving them random ids
    format_->flags |= AVFMT_FLAG_BITEXACT;
    check(avformat_init_output(format_.get(), nullptr), "the header cannot be made");
    format_->flags &= ~AVFMT_FLAG_BITEXACT;
    // set only here, because avformat_init_output() sets or clears the encoder's name
    for (const auto& [key, text] : encoding_.options.metadata)
        check(av_dict_set(&format_->metadata, key.c_str(), text.c_str(), 0), "no memory for metadata");
    check(avformat_write_header(format_.get(), nullptr), "the header cannot be written");
}

void Encoder::set_option(const char* name, const std::string& value) {
    check(av_opt_set(format_->priv_data, name, value.c_str(), 0),
          fmt::format("{} refuses {} = {}", format_->oformat->name, name, value));
}

AVFrame& Encoder::frame() {
    // copies only if the encoder still uses the frame; x264, libvpx and the AV1 encoders do not
    check(av_frame_make_writable(frame_.get()), "no memory for a frame");
    return *frame_;
}

void Encoder::send_frame(std::int64_t time, std::int64_t duration) {
    frame_->pts = time;
    duration_ = duration;
    const auto segment = time / encoding_.segment;
    if (codec_ && time % encoding_.segment == 0 && segment < encoding_.segments) end_segment();
    if (!codec_) codec_ = open_encoder(encoding_, path_);
    check(avcodec_send_frame(codec_.get(), frame_.get()), "the encoder refuses a frame");
    write_packets();
}

/// Writes the packets that the encoder still holds, and closes it.
void Encoder::end_segment() {
    check(avcodec_send_frame(codec_.get(), nullptr), "the encoder refuses the end");
    write_packets();
    codec_.reset();
}

/// Muxes all packets that the encoder has finished.
void Encoder::write_packets() {
    for (;;) {
        throw_if_set(stop_);
        const int result = avcodec_receive_packet(codec_.get(), packet_.get());
        if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) return;
        check(result, "cannot be encoded");
        if (part_)
            write_block(*packet_, *part_);
        else
            write_packet();
        av_packet_unref(packet_.get());
    }
}

void Encoder::write_packet() {
    if (!stream_) write_header();
    if (!encoding_.png_chunks.empty()) insert_png_chunks();
    packet_->duration = duration_;
    end_ = std::max(end_, packet_->pts + duration_);
    av_packet_rescale_ts(packet_.get(), encoding_.tick, stream_->time_base);
    check(av_write_frame(format_.get(), packet_.get()), "cannot be written");
}

/// The header needs an open encoder. It gets a frame, as some encoders need one, and is closed.
void Encoder::open_without_frames() {
    codec_ = open_encoder(encoding_, path_);
    frame_->pts = 0;
    check(avcodec_send_frame(codec_.get(), frame_.get()), "the encoder refuses a frame");
    write_header();
    check(avcodec_send_frame(codec_.get(), nullptr), "the encoder refuses the end");
    while (avcodec_receive_packet(codec_.get(), packet_.get()) >= 0) av_packet_unref(packet_.get());
    codec_.reset();
}

void Encoder::add(BlockFile& part) {
    if (!stream_) open_without_frames();
    while (part.next()) {
        throw_if_set(stop_);
        read_block(part, *packet_);
        write_packet();
        av_packet_unref(packet_.get());
    }
}

/// The header of an APNG is part of the first packet.
void Encoder::insert_png_chunks() {
    std::size_t size = 0;
    const auto* header = av_packet_get_side_data(packet_.get(), AV_PKT_DATA_NEW_EXTRADATA, &size);
    if (!header) return;
    set_side_data(*packet_, AV_PKT_DATA_NEW_EXTRADATA, text(header, size) + encoding_.png_chunks);
    encoding_.png_chunks.clear();
}

void Encoder::write_chapters() {
    if (chapters_.empty()) return;
    format_->chapters = static_cast<AVChapter**>(checked(av_calloc(chapters_.size(), sizeof(AVChapter*))));
    for (const auto& [time, title] : chapters_) {
        auto* chapter = static_cast<AVChapter*>(checked(av_mallocz(sizeof(AVChapter))));
        format_->chapters[format_->nb_chapters++] = chapter;
        chapter->id = static_cast<int>(format_->nb_chapters);
        chapter->time_base = encoding_.tick;
        chapter->start = time;
        const bool is_last = format_->nb_chapters == chapters_.size();
        chapter->end = is_last ? end_ : chapters_[format_->nb_chapters].first;
        check(av_dict_set(&chapter->metadata, "title", title.c_str(), 0), "no memory for chapters");
    }
}

void Encoder::finish(std::string_view ending) {
    if (codec_) end_segment();
    if (part_) return part_->finish();
    if (!stream_) throw std::logic_error("a video without frames");
    if (!encoding_.options.is_stream) write_chapters();
    check(av_write_trailer(format_.get()), "the end cannot be written");
    if (!ending.empty()) {
        check(static_cast<int>(std::min<std::int64_t>(avio_seek(format_->pb, -1, SEEK_CUR), 0)), "cannot seek");
        avio_write(format_->pb, reinterpret_cast<const unsigned char*>(ending.data()), static_cast<int>(ending.size()));
    }
    check(avio_closep(&format_->pb), "cannot be written");
}

void Encoder::check(int result, std::string_view what) const {
    check_libav(result, path_, what);
}

std::string libav_description() {
    return version("libavcodec", avcodec_version()) + ", " + version("libavformat", avformat_version());
}

std::unique_ptr<Sink> make_video_sink(const std::filesystem::path& place, const VideoOptions& options,
                                      const std::atomic<bool>& stop) {
    if (options.format == FilmFormat::gif) return make_gif_sink(place, options, stop);
    return std::make_unique<VideoSink>(place, options, stop);
}

void check_encoder(const VideoOptions& options) {
    if (format_row(options.format, options.codec).encoder) encoding_of(options);
    if (options.format == FilmFormat::gif) check_gif_filters();
}

}  // namespace doppel
