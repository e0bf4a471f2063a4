#pragma once

#include "output/folder.hpp"
#include "output/samples.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>

struct libdeflate_compressor;
struct libdeflate_decompressor;

namespace doppel {

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
    struct Free {
        void operator()(std::FILE* file) const { std::fclose(file); }
        void operator()(libdeflate_compressor* compressor) const;
        void operator()(libdeflate_decompressor* decompressor) const;
    };
    std::size_t bytes_of(const SampledAreas& frame) const;
    [[noreturn]] void fail(const char* what) const;

    std::filesystem::path path_;
    Samples samples_;
    std::unique_ptr<std::FILE, Free> file_;
    std::unique_ptr<libdeflate_compressor, Free> compressor_;
    std::unique_ptr<libdeflate_decompressor, Free> decompressor_;
    Buffer packed_;
    long frames_ = 0;
};

}  // namespace doppel
