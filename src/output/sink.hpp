#pragma once

#include "image/picture.hpp"
#include "output/files.hpp"
#include "output/formats.hpp"

#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace doppel {

/// For sinks that are never asked to stop.
inline const std::atomic<bool> never_stopped = false;

/// Writes pictures in order, to a video or a folder of images. take() and finish() may block, and throw Error (exit 4)
/// with the path and the reason. Destroyed unfinished it stops at once; the file's owner removes it.
class Sink {
public:
    virtual ~Sink() = default;

    /// The next frame. `changed`: where it differs from the one before (everywhere, for the first).
    virtual void take(const Picture& picture, const std::vector<Rect>& changed) = 0;

    /// Writes all that was taken, and completes the file.
    virtual void finish() = 0;
};

/// Threads of an encoder, the same on every machine, as the output of x264 and libvpx depends on them. (On two cores,
/// eight take x264 as much CPU time as two.)
inline constexpr std::size_t encoder_threads = 8;

/// A video file:
/// mp4   H.264, the index at the front.
/// webm  VP9 or AV1. Time base 1 ms: frames start within 0.5 ms of their time.
/// gif   One palette of 255 colours for all frames, no dithering; loops for ever. Time base 1/100 s: frames start
///       within 0.005 s of their time. Two passes: frames wait on the disk until finish().
/// apng  Exact pixels and times; loops for ever.
/// mp4 and webm are BT.709 (limited range), converted and tagged, at a constant rate. Alpha is not premultiplied.
/// The same pictures and options give the same bytes.
/// take() converts what changed; a thread of the sink encodes, fed through a queue of a few frames.
/// Throws Error: exit 2 for options that the format cannot have, exit 4 where libav has no encoder for it (those
/// present are listed) or writing fails, exit 130 soon after `stop` is set.
std::unique_ptr<Sink> make_video_sink(const std::filesystem::path& place, const VideoOptions& options,
                                      const std::atomic<bool>& stop = never_stopped);

/// Throws as make_video_sink(), but opens no file. A sequence of PNGs has nothing that is missing.
void check_video(const VideoOptions& options);

/// Versions of the libraries that write the video, for the manifest: "libavcodec 59.37.100, libavformat …".
std::string libav_description();

}  // namespace doppel
