#include "output/gif.hpp"

#include "base/error.hpp"
#include "base/machine.hpp"
#include "base/threads.hpp"
#include "output/libav_encoder.hpp"
#include "output/workers.hpp"

extern "C" {
#include <libavutil/imgutils.h>
}

#include <fmt/ranges.h>
#include <libdeflate.h>
#include <libimagequant.h>

#include <algorithm>
#include <cerrno>
#include <new>
#include <stdexcept>
#include <system_error>

namespace doppel {
namespace {

using LiqImage = Owned<liq_image, liq_image_destroy>;

void check(liq_error error) {
    if (error == LIQ_OUT_OF_MEMORY) throw std::bad_alloc();
    if (error != LIQ_OK) throw std::logic_error("libimagequant refuses its task");
}

/// A new file that has no name any more: closing it frees it.
Stream unnamed_file(const std::filesystem::path& path) {
    auto file = create_file(path);
    std::filesystem::remove(path);
    return file;
}

/// What libimagequant allocates is null only where memory is out.
template <class T>
T* checked(T* thing) {
    if (!thing) throw std::bad_alloc();
    return thing;
}

/// The 255 colours that stand best for all that was counted, by libimagequant (median cut, refined by k-means, in a
/// perceptual colour space). Each pixel becomes the nearest colour, without dithering, which would flicker from frame
/// to frame and compress badly. Pixels are rectangles of opaque RGBA, rows from the top down, no padding.
class Palette {
public:
    Palette() {
        check(liq_set_max_colors(attributes_.get(), 255));
        histogram_.reset(checked(liq_histogram_create(attributes_.get())));
    }

    void count(const std::uint8_t* rgba, Size size) {
        check(liq_histogram_add_image(histogram_.get(), attributes_.get(), view(rgba, size).get()));
    }

    /// Chooses the colours; nothing can be counted after.
    void choose() {
        liq_result* result = nullptr;
        check(liq_histogram_quantize(histogram_.get(), attributes_.get(), &result));
        result_.reset(result);
        histogram_.reset();
        check(liq_set_dithering_level(result, 0));
    }

    /// Entry 255 is transparent black and stands for no pixel; unused entries are opaque black.
    std::array<std::uint32_t, 256> argb() const {
        std::array<std::uint32_t, 256> entries;
        entries.fill(0xff000000u);
        entries[255] = 0;
        const liq_palette& palette = *liq_get_palette(result_.get());
        for (unsigned i = 0; i < palette.count; ++i) {
            const auto [r, g, b, a] = palette.entries[i];
            entries[i] |= std::uint32_t{r} << 16 | std::uint32_t{g} << 8 | b;
        }
        return entries;
    }

    /// `index` ← the entry of each pixel.
    void map(const std::uint8_t* rgba, Size size, std::uint8_t* index) {
        check(liq_write_remapped_image(result_.get(), view(rgba, size).get(), index,
                                       std::size_t(size.width) * size.height));
    }

private:
    /// No copy: `rgba` must outlive it.
    LiqImage view(const std::uint8_t* rgba, Size size) const {
        return LiqImage(checked(liq_image_create_rgba(attributes_.get(), rgba, size.width, size.height, 0)));
    }

    Owned<liq_attr, liq_attr_destroy> attributes_{checked(liq_attr_create())};
    Owned<liq_histogram, liq_histogram_destroy> histogram_;
    Owned<liq_result, liq_result_destroy> result_;
};

/// A frame in the spool begins with this; its areas and their compressed bytes follow.
struct FrameHeader {
    std::size_t areas, packed;
};

Size size_of(const Rect& area) {
    return {area.right - area.left, area.bottom - area.top};
}

/// A comment extension (GIF89a, 24) with a line for each text, in blocks of at most 255 bytes; then the trailer.
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
    GifSink(const std::filesystem::path& place, const VideoOptions& options, const std::atomic<bool>& stop)
        : options_(options),
          encoder_(place, encoding_of(options), stop),
          spool_(place),
          counting_(1, affordable(byte_count(AV_PIX_FMT_RGBA, all_of(options.size)), 8),
                    [this](SampledAreas& changes) { count(changes); }) {}

    void take(const Picture& picture, const std::vector<Rect>& changed) override {
        SampledAreas changes = spare_.take();
        convert(picture, changed, AV_PIX_FMT_RGBA, changes);
        counting_.give(std::move(changes));
    }

    void finish() override {
        counting_.finish();
        encode();
        encoder_.finish(comment_and_end(options_.metadata), 1);
    }

private:
    /// First pass: counts colours.
    void count(SampledAreas& changes) {
        std::uint8_t* rgba = changes.bytes.data();
        for (const Rect& area : changes.areas) {
            const std::size_t bytes = byte_count(AV_PIX_FMT_RGBA, area);
            for (std::size_t i = 3; i < bytes; i += 4) rgba[i] = 255;
            palette_.count(rgba, size_of(area));
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
            const std::int64_t start = time_of(k), duration = time_of(k + 1) - start;
            // the muxer cannot know how long the last frame lasts
            encoder_.set_option("final_delay", fmt::to_string(duration));
            encoder_.send_frame(start, duration);
        }
    }

    void paste(const SampledAreas& changes, AVFrame& frame) {
        const std::uint8_t* rgba = changes.bytes.data();
        for (const Rect& area : changes.areas) {
            const Size size = size_of(area);
            std::uint8_t* index = indices_.make_room(std::size_t(size.width) * size.height);
            palette_.map(rgba, size, index);
            const int stride = frame.linesize[0];
            av_image_copy_plane(frame.data[0] + std::ptrdiff_t{area.top} * stride + area.left, stride, index,
                                size.width, size.width, size.height);
            rgba += byte_count(AV_PIX_FMT_RGBA, area);
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

Spool::Spool(const std::filesystem::path& film)
    : path_(film),
      file_(unnamed_file(film.string() + ".spool")),
      compressor_(checked(libdeflate_alloc_compressor(1))),
      decompressor_(checked(libdeflate_alloc_decompressor())) {}

void Spool::write(const SampledAreas& frame) {
    const std::size_t size = byte_count(AV_PIX_FMT_RGBA, frame.areas),
                      bound = libdeflate_deflate_compress_bound(compressor_.get(), size);
    std::uint8_t* packed = packed_.make_room(bound);
    const FrameHeader header{frame.areas.size(),
                             libdeflate_deflate_compress(compressor_.get(), frame.bytes.data(), size, packed, bound)};
    put(&header, sizeof header);
    put(frame.areas.data(), frame.areas.size() * sizeof(Rect));
    put(packed, header.packed);
    ++frames_;
}

void Spool::rewind() {
    if (std::fflush(file_.get()) != 0) fail("cannot be written");
    if (std::fseek(file_.get(), 0, SEEK_SET) != 0) fail("cannot be read");
}

void Spool::read(SampledAreas& frame) {
    FrameHeader header{};
    get(&header, sizeof header);
    frame.areas.resize(header.areas);
    get(frame.areas.data(), header.areas * sizeof(Rect));
    std::uint8_t* packed = packed_.make_room(header.packed);
    get(packed, header.packed);
    const std::size_t size = byte_count(AV_PIX_FMT_RGBA, frame.areas);
    if (libdeflate_deflate_decompress(decompressor_.get(), packed, header.packed, frame.bytes.make_room(size), size,
                                      nullptr) != LIBDEFLATE_SUCCESS)
        fail("is damaged");
}

void Spool::put(const void* bytes, std::size_t count) {
    if (count > 0 && std::fwrite(bytes, 1, count, file_.get()) != count) fail("cannot be written");
}

void Spool::get(void* bytes, std::size_t count) {
    if (count > 0 && std::fread(bytes, 1, count, file_.get()) != count) fail("cannot be read");
}

void Spool::fail(const char* what) const {
    throw Error(code_of_errno(errno), fmt::format("{}: its frames on the disk: {}: {}", path_.string(), what,
                                                  std::generic_category().message(errno)));
}

std::unique_ptr<Sink> make_gif_sink(const std::filesystem::path& place, const VideoOptions& options,
                                    const std::atomic<bool>& stop) {
    // libimagequant's OpenMP starts one thread a core for each caller, and ends the program where it cannot
    need_threads(2 * std::size_t{std::thread::hardware_concurrency()});
    return std::make_unique<GifSink>(place, options, stop);
}

}  // namespace doppel
