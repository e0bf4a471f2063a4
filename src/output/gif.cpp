#include "base/error.hpp"
#include "base/machine.hpp"
#include "base/shared_library.hpp"
#include "output/blocks.hpp"
#include "output/libav_encoder.hpp"
#include "output/transaction.hpp"
#include "output/workers.hpp"

extern "C" {
#include <libavfilter/avfilter.h>
#include <libavfilter/buffersink.h>
#include <libavfilter/buffersrc.h>
}

#include <fmt/ranges.h>
#include <libdeflate.h>

#include <filesystem>
#include <new>
#include <system_error>
#include <utility>

namespace doppel {
namespace {

/// libavfilter is loaded only when a GIF is written: its thirty dependencies would add 18 ms to every command.
struct FilterLibrary {
    SharedLibrary library{{fmt::format("libavfilter.so.{}", LIBAVFILTER_VERSION_MAJOR)}};
    decltype(&avfilter_graph_alloc) graph_alloc = library["avfilter_graph_alloc"];
    decltype(&avfilter_graph_free) graph_free = library["avfilter_graph_free"];
    decltype(&avfilter_graph_parse2) graph_parse = library["avfilter_graph_parse2"];
    decltype(&avfilter_graph_config) graph_config = library["avfilter_graph_config"];
    decltype(&avfilter_graph_get_filter) graph_get_filter = library["avfilter_graph_get_filter"];
    decltype(&av_buffersrc_add_frame_flags) add_frame = library["av_buffersrc_add_frame_flags"];
    decltype(&av_buffersink_get_frame) get_frame = library["av_buffersink_get_frame"];
};

/// Throws Error (exit 4) if it cannot be loaded.
const FilterLibrary& filter_library() {
    static const FilterLibrary library;
    return library;
}

/// The description "buffer@NAME=…" of an input of a filter graph.
std::string source(std::string_view name, Size size) {
    return fmt::format("buffer@{}=video_size={}x{}:pix_fmt=bgra:time_base=1/1:pixel_aspect=1/1", name, size.width,
                       size.height);
}

/// A graph of libavfilter filters between named inputs and one output. `owner` is named in errors. All functions throw
/// Error (exit 4).
class Filters {
public:
    Filters(const std::string& owner, const std::string& text)
        : owner_(owner), graph_(checked(library_.graph_alloc())) {
        graph_->nb_threads = 1;
        AVFilterInOut *inputs = nullptr, *outputs = nullptr;  // no open inputs or outputs remain
        check(library_.graph_parse(graph_.get(), (text + ",buffersink@out").c_str(), &inputs, &outputs));
        check(library_.graph_config(graph_.get(), nullptr));
    }

    /// A null frame marks the end of the input.
    void give(const char* buffer, AVFrame* frame) {
        check(library_.add_frame(filter(buffer), frame, AV_BUFFERSRC_FLAG_KEEP_REF | AV_BUFFERSRC_FLAG_PUSH));
    }
    /// Replaces the contents of the frame.
    void take(AVFrame& frame) {
        av_frame_unref(&frame);
        check(library_.get_frame(filter("buffersink@out"), &frame));
    }

private:
    struct Free {
        void operator()(AVFilterGraph* graph) const { filter_library().graph_free(&graph); }
    };

    void check(int result) const { check_libav(result, owner_, "the palette cannot be made"); }
    AVFilterContext* filter(const char* name) const { return library_.graph_get_filter(graph_.get(), name); }

    const FilterLibrary& library_ = filter_library();
    const std::string owner_;
    const std::unique_ptr<AVFilterGraph, Free> graph_;
};

/// The frames of a film wait on the disk between two passes: a block contains the changed areas of one, and their
/// bytes, compressed.
constexpr BlockKind waiting_frames{R"({"file":"doppel frames"})", "has no frames", "is damaged"};

/// Converts RGBA to opaque BGRA in place.
void make_opaque_bgra(std::uint8_t* pixels, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; i += 4) {
        std::swap(pixels[i], pixels[i + 2]);
        pixels[i + 3] = 255;
    }
}

/// A comment extension (GIF89a, 24) with one line for each text, in blocks of at most 255 bytes, and the trailer.
std::string comment_and_end(const Metadata& metadata) {
    std::vector<std::string> lines;
    for (const auto& [key, text] : metadata) lines.push_back(key + ": " + text);
    const auto comment = fmt::format("{}", fmt::join(lines, "\n"));
    std::string bytes = comment.empty() ? "" : "\x21\xfe";
    for (std::size_t i = 0; i < comment.size(); i += 255) {
        const auto block = comment.substr(i, 255);
        bytes += static_cast<char>(block.size()) + block;
    }
    if (!comment.empty()) bytes += '\0';
    return bytes + '\x3b';
}

/// The first pass makes one palette for the whole film, the second maps each pixel to the nearest colour. There is no
/// dithering, which would flicker from frame to frame.
class GifSink final : public Sink {
public:
    GifSink(const std::filesystem::path& place, const VideoOptions& options, const std::atomic<bool>& stop)
        : options_(options),
          encoder_(place, encoding_of(options), stop),
          path_(place.string()),
          waiting_(path_ + std::string(kept_beside)),
          written_(waiting_, std::string(waiting_frames.start)),
          frame_(make_frame(options.size, AV_PIX_FMT_BGRA)),
          colours_(path_, source("film", options.size) + ",palettegen=stats_mode=full"),
          counting_(1, affordable(byte_count(AV_PIX_FMT_BGRA, all_of(options.size)), 8),
                    [this](SampledAreas& changes) { count(changes); }) {}
    GifSink(const GifSink&) = delete;
    GifSink& operator=(const GifSink&) = delete;
    ~GifSink() override {
        std::error_code ignored;
        std::filesystem::remove(waiting_, ignored);
    }

    void take(const Picture& picture, const std::vector<Rect>& changed) override {
        SampledAreas changes = counting_.spare();
        convert(picture, changed, AV_PIX_FMT_RGBA, changes);
        counting_.give(std::move(changes));
    }

    void finish() override {
        counting_.finish();
        written_.finish();
        encode();
        encoder_.finish(comment_and_end(options_.metadata));
    }

private:
    void count(SampledAreas& changes) {
        const auto size = byte_count(AV_PIX_FMT_RGBA, changes.areas);
        make_opaque_bgra(changes.bytes.data(), size);
        show(changes, frames_++, colours_);
        packed_.resize(libdeflate_deflate_compress_bound(compressor_.get(), size));
        packed_.resize(
            libdeflate_deflate_compress(compressor_.get(), changes.bytes.data(), size, packed_.data(), packed_.size()));
        written_(changes.areas, packed_);
        written_.end_block();
    }

    /// Applies the changes to the previous frame and passes it to the filters.
    void show(const SampledAreas& changes, long k, Filters& filters) {
        if (av_frame_make_writable(frame_.get()) < 0) throw std::bad_alloc();
        put(changes, *frame_);
        frame_->pts = k;
        filters.give("buffer@film", frame_.get());
    }

    void encode() {
        constexpr Size palette_size{16, 16};
        const auto palette = make_frame(palette_size, AV_PIX_FMT_BGRA);
        colours_.give("buffer@film", nullptr);
        colours_.take(*palette);
        Filters indices(path_, source("film", options_.size) + "[film];" + source("palette", palette_size) +
                                   "[palette];[film][palette]paletteuse=dither=none");
        palette->pts = 0;
        indices.give("buffer@palette", palette.get());
        indices.give("buffer@palette", nullptr);
        BlockFile frames(waiting_, waiting_frames);
        std::filesystem::remove(waiting_);
        SampledAreas changes = counting_.spare();
        for (long k = 0; frames.next(); ++k) {
            frames(changes.areas, packed_);
            const auto size = byte_count(AV_PIX_FMT_RGBA, changes.areas);
            if (libdeflate_deflate_decompress(decompressor_.get(), packed_.data(), packed_.size(),
                                              changes.bytes.make_room(size), size, nullptr) != LIBDEFLATE_SUCCESS)
                throw frames.damaged();
            show(changes, k, indices);
            indices.take(encoder_.frame());
            const std::int64_t start = time_of(k), duration = time_of(k + 1) - start;
            // the muxer cannot know how long the last frame is shown
            encoder_.set_option("final_delay", fmt::to_string(duration));
            encoder_.send_frame(start, duration);
        }
    }

    /// Start of frame k, 1/100 s.
    std::int64_t time_of(long k) const { return av_rescale(k, 100 * options_.fps_denominator, options_.fps_numerator); }

    const VideoOptions options_;
    Encoder encoder_;
    const std::string path_, waiting_;
    BlockFile written_;
    long frames_ = 0;
    std::string packed_;
    const Owned<libdeflate_compressor, libdeflate_free_compressor> compressor_{checked(libdeflate_alloc_compressor(1))};
    const Owned<libdeflate_decompressor, libdeflate_free_decompressor> decompressor_{
        checked(libdeflate_alloc_decompressor())};
    Libav<AVFrame> frame_;
    Filters colours_;
    Workers<SampledAreas> counting_;
};

}  // namespace

void check_gif_filters() {
    filter_library();
}

std::unique_ptr<Sink> make_gif_sink(const std::filesystem::path& place, const VideoOptions& options,
                                    const std::atomic<bool>& stop) {
    return std::make_unique<GifSink>(place, options, stop);
}

}  // namespace doppel
