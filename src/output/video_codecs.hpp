#pragma once

#include "output/libav_encoder.hpp"
#include "output/samples.hpp"
#include "output/video.hpp"

namespace doppel {

/// Throws as check_video() for everything but a missing encoder.
void check_options(const VideoOptions& options);

/// What libav has to do, of checked options, and what it takes the pictures as (gif: rgb, before they get a palette).
/// Throws Error (exit 4) where it lacks the encoder.
Encoding encoding_of(const VideoOptions& options);
Samples samples_of(const VideoOptions& options);

}  // namespace doppel
