#pragma once

#include "output/samples.hpp"
#include "output/sink.hpp"

#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

namespace doppel {

/// Frames in memory: of each what differs from the one before it, in 4:2:0.
struct RecordedFrames {
    Size size;
    std::vector<SampledAreas> frames;
};

/// How near decoded frames come to what was encoded, of luma: peak signal to noise, dB, and the mean structural
/// similarity (Wang et al. 2004) of squares of 8×8 px, 4 px apart, of every seventh frame.
struct Quality {
    double psnr_db = 0, ssim = 0;
};

/// What an encoder takes for frames.
struct EncodingCost {
    double cpu_s = 0, wall_s = 0;            // of encoding alone; the CPU time of all threads of the process
    std::size_t bytes = 0, first_bytes = 0;  // of all frames; of the first, which is whole
};

/// What an encoder makes of frames.
struct EncodedFrames : EncodingCost {
    Quality whole,
        moving;  // of the picture; of its macroblocks (16×16 px) that differ between any two frames, NaN where none do
};

/// Encodes the frames with what `options` stand for, some of the encoder's options replaced (by libav's names; those
/// of "x264-params" are added), decodes them and compares. Of mp4 and webm in 4:2:0, without a file; the opacity of
/// transparent frames counts in bytes alone. Throws Error as make_video_sink() does.
EncodedFrames try_encoding(const RecordedFrames& recorded, const VideoOptions& options, const Metadata& replaced = {},
                           const std::atomic<bool>& stop = never_stopped);

/// Encodes alone.
EncodingCost time_encoding(const RecordedFrames& recorded, const VideoOptions& options, const Metadata& replaced = {},
                           const std::atomic<bool>& stop = never_stopped);

}  // namespace doppel
