#pragma once

#include "output/folder.hpp"

extern "C" {
#include <libavformat/avformat.h>
}

namespace doppel {

/// The file that a muxer of libav fills, opened as create_file() does: libav itself, given a name, would follow links.
class LibavFile {
public:
    /// Throws Error (exit 4).
    explicit LibavFile(const FilePlace& place) : file_(create_file(place)) {}
    ~LibavFile();
    LibavFile(const LibavFile&) = delete;
    LibavFile& operator=(const LibavFile&) = delete;

    /// The muxer, which this outlives, writes here; where it opens its file anew to read it (to move the index of an
    /// MP4 to the front) it gets this one.
    void attach(AVFormatContext& format);

    /// All that was written has left the process. libav's code of what failed, 0 where nothing did.
    int close();

private:
    Descriptor file_;
    AVIOContext* writer_ = nullptr;
};

}  // namespace doppel
