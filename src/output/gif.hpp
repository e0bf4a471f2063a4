#pragma once

#include "output/video.hpp"

namespace doppel {

/// The sink of VideoFormat::gif, of checked options. See make_video_sink().
std::unique_ptr<Sink> make_gif_sink(const FilePlace& place, const VideoOptions& options, const std::atomic<bool>& stop);

}  // namespace doppel
