#pragma once

#include "picture/display_list.hpp"

#include <string_view>

namespace doppel {

/// How far the pen moves along `text`, px; the same arithmetic that places the glyphs when it is drawn.
float text_width(std::string_view text, float size, Weight weight = Weight::regular);

}  // namespace doppel
