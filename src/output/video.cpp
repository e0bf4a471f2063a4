#include "base/machine.hpp"
#include "output/gif.hpp"
#include "output/libav_encoder.hpp"
#include "output/sink.hpp"
#include "output/workers.hpp"

namespace doppel {
namespace {

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
