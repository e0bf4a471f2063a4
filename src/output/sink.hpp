#pragma once

#include "image/picture.hpp"

#include <atomic>
#include <string>
#include <utility>
#include <vector>

namespace doppel {

/// What a file says about itself: keys and texts in UTF-8. Every format has a place for "title", "comment",
/// "description", "artist", "copyright" and "date"; all but mp4, where libav always names itself, for "encoder" too:
/// the program that made the file.
using Metadata = std::vector<std::pair<std::string, std::string>>;

/// Of sinks that nobody asks to stop.
inline const std::atomic<bool> never_stopped = false;

/// Where pictures go: a video or a folder of images. Fed in order, closed by finish(); both may block and both throw
/// Error (exit 4) with the path and the reason. Destroyed unfinished it stops at once; whoever owns the file removes
/// it.
class Sink {
public:
    virtual ~Sink() = default;

    /// The next frame. `changed` = where it differs from the frame before (the whole of it for the first).
    virtual void take(const Picture& picture, const std::vector<Rect>& changed) = 0;

    /// All that was taken is written, completely.
    virtual void finish() = 0;
};

}  // namespace doppel
