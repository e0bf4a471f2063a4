#pragma once

#include "image/picture.hpp"
#include "output/files.hpp"

#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace doppel {

/// A file's metadata: keys and texts, UTF-8. Every format stores "title", "comment", "description", "artist",
/// "copyright" and "date"; all but mp4 (where libav names itself) also "encoder", the program that made the file.
using Metadata = std::vector<std::pair<std::string, std::string>>;

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

enum class VideoFormat { mp4, webm, gif, apng };

/// Of H.264, VP9 and AV1: chroma subsampling and bits a sample.
enum class PixelFormat { yuv420, yuv444, yuv420_10 };

/// Threads of an encoder, the same on every machine, as the output of x264 and libvpx depends on them. (On two cores,
/// eight take x264 as much CPU time as two.)
inline constexpr std::size_t encoder_threads = 8;

struct VideoOptions {
    VideoFormat format = VideoFormat::mp4;
    std::string codec = {};   // "h264" (mp4), "vp9" or "av1" (webm); empty = h264, vp9
    Size size;                // px; even where chroma is for 2×2 pixels
    int fps_numerator = 120;  // frames/s
    int fps_denominator = 1;
    PixelFormat pixel_format = PixelFormat::yuv420;  // gif and apng: not used
    std::string preset = "doppel";                   // or x264's names, for each codec; gif and apng: not used
    int crf = 18;              // h264 0…51, vp9 and av1 0…63, lower is better; gif and apng: not used
    bool transparent = false;  // the pictures' alpha counts: apng, webm of vp9; else it is taken for 255
    Metadata metadata = {};
};

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

/// Throws as make_video_sink(), but opens no file.
void check_video(const VideoOptions& options);

/// ".mp4", ".webm", ".gif", ".apng".
std::string extension(VideoFormat format);

/// Versions of the libraries that write the video, for the manifest: "libavcodec 59.37.100, libavformat …".
std::string libav_description();

}  // namespace doppel
