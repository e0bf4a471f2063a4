#include "cli/print.hpp"

#include <cerrno>
#include <cstdio>

namespace doppel {

std::error_code try_write_out(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return {};
    return {errno, std::generic_category()};
}

void write_out(std::string_view text) {
    if (const auto fault = try_write_out(text)) throw unwritten(fault);
}

Error unwritten(const std::error_code& why) {
    return io_failed("standard output cannot be written: {}", why.message());
}

}  // namespace doppel
