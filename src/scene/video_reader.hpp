#pragma once

#include "scene/preset.hpp"
#include "scene/toml_reader.hpp"

namespace doppel {

// Each leaves alone what the table does not say, and throws Error (exit 2) as TomlReader does.

/// [video], all of it.
void read_video(TomlReader& table, VideoSpec& video);
/// `size`: any that a picture may have.
void read_picture_size(TomlReader& table, Size& into);

}  // namespace doppel
