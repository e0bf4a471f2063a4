#pragma once

#include "output/sink.hpp"

namespace doppel {

/// Throws Error (exit 4) where there is no libavfilter.
void check_gif_filters();

/// The sink of FilmFormat::gif, of checked options. See make_video_sink().
std::unique_ptr<Sink> make_gif_sink(const std::filesystem::path& place, const VideoOptions& options,
                                    const std::atomic<bool>& stop);

}  // namespace doppel
