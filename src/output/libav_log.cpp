#include "output/libav_encoder.hpp"

extern "C" {
#include <libavutil/log.h>
}

#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace doppel {
namespace {

// the log callback cannot tell one encoder from another, but each has its thread
thread_local std::string messages;

/// A line may come in pieces.
void keep(void* /*source*/, int level, const char* format, va_list arguments) {
    constexpr std::size_t enough = 4096;
    std::array<char, 512> piece{};
    if (level > AV_LOG_ERROR || std::vsnprintf(piece.data(), piece.size(), format, arguments) < 0) return;
    try {
        messages += piece.data();
        if (messages.size() > enough) messages.erase(0, messages.size() - enough);
    } catch (...) {  // out of memory; no exception may pass through C
    }
}

}  // namespace

void capture_libav_log() {
    av_log_set_callback(keep);
    // SVT-AV1 has its own log, set by the environment alone
    setenv("SVT_LOG", "0", 0);
}

// without control characters and final full stops
std::string take_libav_error() {
    auto text = std::exchange(messages, {});
    for (char& c : text)
        if ((c >= 0 && c < ' ' && c != '\n') || c == 127) c = ' ';
    text.resize(text.find_last_not_of(" \n.") + 1);
    return text.empty() ? text : text.substr(text.find_first_not_of(' ', text.rfind('\n') + 1));
}

}  // namespace doppel
