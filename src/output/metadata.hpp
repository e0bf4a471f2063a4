#pragma once

#include <string>
#include <utility>
#include <vector>

namespace doppel {

/// What a file says about itself: keys and texts in UTF-8. Every format has a place for "title", "comment",
/// "description", "artist", "copyright" and "date"; all but mp4, where libav always names itself, for "encoder" too:
/// the program that made the file.
using Metadata = std::vector<std::pair<std::string, std::string>>;

}  // namespace doppel
