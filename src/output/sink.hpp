#pragma once

#include "image/picture.hpp"

#include <atomic>
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

}  // namespace doppel
