#pragma once

#include "image/picture.hpp"
#include "output/blocks.hpp"
#include "output/formats.hpp"

#include <atomic>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace doppel {

inline const std::atomic<bool> never_stopped = false;

/// Writes pictures in order, to a video or a folder of images. take() and finish() may block, and throw Error (exit 4)
/// with the path and the reason. Destroying an unfinished sink stops it at once; the owner of the file removes it.
class Sink {
public:
    virtual ~Sink() = default;

    /// Adds the next frame. `changed`: where it differs from the previous one; for the first frame, everything.
    virtual void take(const Picture& picture, const std::vector<Rect>& changed) = 0;

    /// Adds the pictures of a part of the film (film_part) as they are, in place of take(). All parts are required, in
    /// order. Only for formats with parts.
    virtual void add(BlockFile& /*part*/) { throw std::logic_error("this format has no parts"); }

    /// A chapter of the film that begins with this frame, after the chapter before; where the file can contain none, it
    /// is left out.
    virtual void add_chapter(long /*frame*/, const std::string& /*title*/) {}

    /// Writes all frames and completes the file.
    virtual void finish() = 0;
};

/// Threads of an encoder. The number is the same on every machine, because the output of x264 and libvpx depends on it.
/// (On two cores, x264 takes the same CPU time with eight as with two.)
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
/// For options without format_error() and rate_error(). Throws Error: exit 4 where libav has no encoder for it (those
/// present are listed) or writing fails, exit 130 soon after `stop` is set.
/// With options.part_header, the file is a part for Sink::add(); the frames counted from options.first_frame.
std::unique_ptr<Sink> make_video_sink(const std::filesystem::path& place, const VideoOptions& options,
                                      const std::atomic<bool>& stop = never_stopped);

/// Throws Error (exit 4) where libav has no encoder for the format, as make_video_sink() does.
void check_encoder(const VideoOptions& options);

/// Versions of the video libraries for the manifest: "libavcodec 59.37.100, libavformat …".
std::string libav_description();

}  // namespace doppel
