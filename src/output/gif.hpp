#pragma once

#include "output/sink.hpp"

namespace doppel {

/// Throws Error (exit 4) if libavfilter is missing.
void check_gif_filters();

/// The sink for FilmFormat::gif; the options must be checked. See make_video_sink().
std::unique_ptr<Sink> make_gif_sink(const std::filesystem::path& place, const VideoOptions& options,
                                    const std::atomic<bool>& stop);

}  // namespace doppel
