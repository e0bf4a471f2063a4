#pragma once

#include "output/metadata.hpp"

#include <string>

namespace doppel {

/// PNG's text chunks of metadata: tEXt where Latin-1 has all characters of a text, iTXt elsewhere. Keywords are the
/// registered ones: "Title", "Comment", …, "Software" for the encoder.
std::string png_text_chunks(const Metadata& metadata);

}  // namespace doppel
