#pragma once

#include "output/folder.hpp"
#include "output/samples.hpp"
#include "output/video.hpp"

#include <libdeflate.h>
#include <libimagequant.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>

namespace doppel {

/// The 255 colours that stand best for all that was counted, by libimagequant (median cut, refined by k-means;
/// distances as the eye has them). A pixel becomes the colour nearest to it, whatever is around: no dithering, which
/// would flicker where pictures move and cost the size of a noisy one.
class Palette {
public:
    Palette();

    /// Counts the pixels of a rectangle: RGBA, opaque, rows from the top down, no padding.
    void count(const std::uint8_t* rgba, Size size);
    /// Chooses; nothing can be counted after.
    void choose();
    /// Entry 255 is transparent black and stands for no pixel.
    std::array<std::uint32_t, 256> argb() const;
    /// The number of the colour of each pixel of such a rectangle.
    void look_up(const std::uint8_t* rgba, Size size, std::uint8_t* index);

private:
    Owned<liq_attr, liq_attr_destroy> attributes_;
    Owned<liq_histogram, liq_histogram_destroy> histogram_;
    Owned<liq_result, liq_result_destroy> result_;
};

/// A film's frames on the disk between two passes over them, as what changed in each, compressed. The file has no name
/// and goes with the spool. All throw Error (exit 4) with the path and the reason.
class Spool {
public:
    /// On the file system where the file `film` is.
    Spool(const FilePlace& film, Samples samples);

    void write(const SampledAreas& frame);
    /// No write follows; the next read gives the first frame.
    void rewind();
    /// The next frame, in the order of writing.
    void read(SampledAreas& frame);

    long frames() const { return frames_; }

private:
    std::size_t bytes_of(const SampledAreas& frame) const;
    [[noreturn]] void fail(const char* what) const;

    std::filesystem::path path_;
    Samples samples_;
    Stream file_;
    Owned<libdeflate_compressor, libdeflate_free_compressor> compressor_;
    Owned<libdeflate_decompressor, libdeflate_free_decompressor> decompressor_;
    Buffer packed_;
    long frames_ = 0;
};

/// The sink of VideoFormat::gif, of checked options. See make_video_sink().
std::unique_ptr<Sink> make_gif_sink(const FilePlace& place, const VideoOptions& options, const std::atomic<bool>& stop);

}  // namespace doppel
