#include "output/gif.hpp"

#include "base/error.hpp"
#include "base/machine.hpp"
#include "base/threads.hpp"
#include "output/palette.hpp"
#include "output/pool.hpp"
#include "output/spool.hpp"
#include "output/video_codecs.hpp"
#include "output/workers.hpp"

extern "C" {
#include <libavutil/imgutils.h>
}

#include <algorithm>

namespace doppel {
namespace {

/// A comment as GIF has it (GIF89a, 24): a line for each text, in blocks of at most 255 bytes; then the byte that ends
/// the file.
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

class GifSink final : public Sink {
public:
    GifSink(const FilePlace& place, const VideoOptions& options, const std::atomic<bool>& stop)
        : options_(options),
          encoder_(place, encoding_of(options), stop),
          spool_(place, Samples::rgba),
          counting_(1, in_hand(byte_count(Samples::rgba, all_of(options.size)), 8),
                    [this](SampledAreas& changes) { count(changes); }) {}

    void take(const Picture& picture, const std::vector<Rect>& changed) override {
        SampledAreas changes = spare_.take();
        convert(picture, changed, Samples::rgba, changes);
        counting_.give(std::move(changes));
    }

    void finish() override {
        counting_.finish();
        encode();
        encoder_.finish(comment_and_end(options_.metadata), 1);
    }

private:
    /// First pass: what colours there are.
    void count(SampledAreas& changes) {
        std::uint8_t* rgba = changes.bytes.data();
        for (const Rect& area : changes.areas) {
            const std::size_t bytes = byte_count(Samples::rgba, area);
            for (std::size_t i = 3; i < bytes; i += 4) rgba[i] = 255;
            palette_.count(rgba, {area.right - area.left, area.bottom - area.top});
            rgba += bytes;
        }
        spool_.write(changes);
        spare_.give_back(std::move(changes));
    }

    /// Second pass.
    void encode() {
        palette_.choose();
        const auto colours = palette_.argb();
        spool_.rewind();
        SampledAreas changes = spare_.take();
        for (long k = 0; k < spool_.frames(); ++k) {
            spool_.read(changes);
            AVFrame& frame = encoder_.frame();
            std::ranges::copy(colours, reinterpret_cast<std::uint32_t*>(frame.data[1]));
            paste(changes, frame);
            const std::int64_t start = time_of(k), lasting = time_of(k + 1) - start;
            // what the last frame lasts, libav has to be told
            encoder_.set_option("final_delay", fmt::to_string(lasting));
            encoder_.send_frame(start, lasting);
        }
    }

    void paste(const SampledAreas& changes, AVFrame& frame) {
        const std::uint8_t* rgba = changes.bytes.data();
        for (const Rect& area : changes.areas) {
            const Size size{area.right - area.left, area.bottom - area.top};
            std::uint8_t* index = indices_.make_room(std::size_t(size.width) * size.height);
            palette_.look_up(rgba, size, index);
            const int stride = frame.linesize[0];
            av_image_copy_plane(frame.data[0] + std::ptrdiff_t{area.top} * stride + area.left, stride, index,
                                size.width, size.width, size.height);
            rgba += byte_count(Samples::rgba, area);
        }
    }

    /// When frame k starts, 1/100 s.
    std::int64_t time_of(long k) const {
        return av_rescale(k, std::int64_t{100} * options_.fps_denominator, options_.fps_numerator);
    }

    const VideoOptions options_;
    Encoder encoder_;
    Spool spool_;
    Palette palette_;
    Buffer indices_;
    Pool<SampledAreas> spare_;
    Workers<SampledAreas> counting_;
};

}  // namespace

std::unique_ptr<Sink> make_gif_sink(const FilePlace& place, const VideoOptions& options,
                                    const std::atomic<bool>& stop) {
    // libimagequant's OpenMP starts one a core for each thread that calls it, and ends the program where it cannot
    need_threads(2 * std::size_t{std::thread::hardware_concurrency()});
    return std::make_unique<GifSink>(place, options, stop);
}

}  // namespace doppel
