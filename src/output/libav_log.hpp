#pragma once

#include <string>

namespace doppel {

/// libav, and the encoders behind it, print nothing from now on; what went wrong last is kept, for each thread.
void keep_libav_log();

/// What libav said last in this thread of what went wrong: one line without its end; empty where it said nothing since
/// it was asked last.
std::string take_libav_word();

}  // namespace doppel
