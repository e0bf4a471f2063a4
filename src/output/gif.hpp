#pragma once

#include "output/files.hpp"
#include "output/samples.hpp"
#include "output/sink.hpp"

#include <libdeflate.h>

#include <filesystem>
#include <memory>

namespace doppel {

/// A film's frames on the disk between two passes over them: what changed in each, RGBA, compressed. The file has no
/// name and goes with the spool. All throw Error (exit 4) with the path and the reason.
class Spool {
public:
    /// On the file system where the file `film` is.
    explicit Spool(const std::filesystem::path& film);

    void write(const SampledAreas& frame);
    /// No write follows; the next read gives the first frame.
    void rewind();
    /// The next frame, in the order of writing.
    void read(SampledAreas& frame);

    long frames() const { return frames_; }

private:
    void put(const void* bytes, std::size_t count);
    void get(void* bytes, std::size_t count);
    [[noreturn]] void fail(const char* what) const;

    std::filesystem::path path_;
    Stream file_;
    Owned<libdeflate_compressor, libdeflate_free_compressor> compressor_;
    Owned<libdeflate_decompressor, libdeflate_free_decompressor> decompressor_;
    Buffer packed_;
    long frames_ = 0;
};

/// Throws Error (exit 4) where there is no libavfilter.
void check_gif_filters();

/// The sink of FilmFormat::gif, of checked options. See make_video_sink().
std::unique_ptr<Sink> make_gif_sink(const std::filesystem::path& place, const VideoOptions& options,
                                    const std::atomic<bool>& stop);

}  // namespace doppel
