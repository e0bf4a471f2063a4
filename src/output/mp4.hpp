#pragma once

#include "output/sink.hpp"

#include <filesystem>
#include <memory>
#include <string>

namespace doppel {

struct Mp4Options {
    Size size;                // px, both even
    int fps_numerator = 120;  // frames/s = numerator / denominator
    int fps_denominator = 1;
    std::string preset = "veryfast";  // x264's
    int crf = 18;                     // 0…51, lower is better
    int threads = 0;                  // of the encoder; 0 = its own choice
    std::string title = {};           // metadata; none where empty
};

/// H.264 in MP4: yuv420p, BT.709 (limited range) converted and tagged, constant frame rate, the index at the front.
/// take() converts what changed; a thread of the sink's encodes, fed through a queue of a few frames.
/// Throws Error: exit 2 where the size is odd, exit 4 where libav has no H.264 encoder or writing fails.
std::unique_ptr<Sink> make_mp4_sink(const std::filesystem::path& path, const Mp4Options& options);

/// Versions of the libraries that write the video, for the manifest: "libavcodec 59.37.100, libavformat …".
std::string libav_description();

}  // namespace doppel
