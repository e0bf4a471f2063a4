#pragma once

#include "image/picture.hpp"
#include "output/folder.hpp"

#include <string>

namespace doppel {

/// "data:image/png;base64,…" of a PNG file as it is: what a page needs to show it without the file. Throws Error
/// (exit 4) where it cannot be read.
std::string data_url(const FilePlace& png);

/// The same of a picture, opaque.
std::string data_url(const Picture& picture);

}  // namespace doppel
