#include "output/libav_log.hpp"

extern "C" {
#include <libavutil/log.h>
}

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace doppel {
namespace {

// libav calls back with nothing that could tell one encoder of ours from another: it is the thread that does
thread_local std::string line, last_line;

bool is_blank(char c) {
    return static_cast<unsigned char>(c) <= ' ' || c == 127;
}

/// Without line breaks, other control characters, and what ends a sentence.
std::string cleaned(std::string text) {
    std::replace_if(text.begin(), text.end(), is_blank, ' ');
    const auto last = text.find_last_not_of(" .");
    text.resize(last == std::string::npos ? 0 : last + 1);
    return text.substr(std::min(text.find_first_not_of(' '), text.size()));
}

/// A line may come in pieces.
void keep(void* /*source*/, int level, const char* format, va_list arguments) {
    if (level > AV_LOG_ERROR) return;
    std::array<char, 512> piece{};
    if (std::vsnprintf(piece.data(), piece.size(), format, arguments) < 0) return;
    try {
        line += piece.data();
        if (!line.ends_with('\n')) return;
        if (auto whole = cleaned(std::move(line)); !whole.empty()) last_line = std::move(whole);
        line.clear();
    } catch (...) {  // no memory for words; none can pass through C
    }
}

}  // namespace

void keep_libav_log() {
    av_log_set_callback(keep);
    // SVT-AV1 has a log of its own, and asks the environment alone
    setenv("SVT_LOG", "0", 0);
}

std::string take_libav_word() {
    if (auto rest = cleaned(std::move(line)); !rest.empty()) last_line = std::move(rest);
    line.clear();
    return std::exchange(last_line, {});
}

}  // namespace doppel
