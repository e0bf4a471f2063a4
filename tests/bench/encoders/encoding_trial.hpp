#pragma once

#include "output/samples.hpp"
#include "output/sink.hpp"

#include <atomic>
#include <cstddef>
#include <vector>

namespace doppel {

/// Frames in memory: for each frame its difference from the previous one, in 4:2:0.
struct RecordedFrames {
    Size size;
    std::vector<SampledAreas> frames;
};

/// The quality of decoded frames, for luma: peak signal-to-noise ratio, dB, and the mean structural
/// similarity (Wang et al. 2004) of squares of 8×8 px, 4 px apart, of every seventh frame.
struct Quality {
    double psnr_db = 0, ssim = 0;
};

/// The cost of encoding frames.
struct EncodingCost {
    double cpu_s = 0, wall_s = 0;            // encoding only; the CPU time of all threads of the process
    std::size_t bytes = 0, first_bytes = 0;  // of all frames; of the first, a key frame
};

/// The cost and quality of encoded frames.
struct EncodedFrames : EncodingCost {
    Quality whole,
        moving;  // of the picture; of its macroblocks (16×16 px) that differ between any two frames, NaN if none do
};

/// Encodes the frames with `options`, replacing some of the encoder's options (by libav's names; those of "x264-params"
/// are added), decodes them and compares. For mp4 and webm in 4:2:0, without a file; the opacity of
/// transparent frames counts only in bytes. Throws Error like make_video_sink().
EncodedFrames try_encoding(const RecordedFrames& recorded, const VideoOptions& options, const Metadata& replaced = {},
                           const std::atomic<bool>& stop = never_stopped);

/// Encodes without decoding.
EncodingCost time_encoding(const RecordedFrames& recorded, const VideoOptions& options, const Metadata& replaced = {},
                           const std::atomic<bool>& stop = never_stopped);

}  // namespace doppel
