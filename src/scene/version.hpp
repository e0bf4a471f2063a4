#pragma once

#include <string_view>

namespace doppel {

std::string_view version();   // "0.1.0"
std::string_view revision();  // of git when it was built, "-dirty" if changed since; "unknown" without git

}  // namespace doppel
