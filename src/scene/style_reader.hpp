#pragma once

#include "scene/toml_reader.hpp"
#include "scene/video_spec.hpp"

namespace doppel {

/// `theme`, the name of one of themes.
void read_theme(TomlReader& table, std::string& into);

/// What [video] says of colours, widths, sizes of words, and trails. Throws Error (exit 2).
void read_style(TomlReader& video, VideoSpec& into);

}  // namespace doppel
