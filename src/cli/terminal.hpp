#pragma once

#include "base/error.hpp"
#include "base/text.hpp"

#include <fmt/format.h>

#include <atomic>
#include <string_view>
#include <system_error>
#include <utility>

namespace doppel {

/// Becomes true when the person, or the system, asks the program to end (SIGINT, SIGTERM, SIGHUP). The second time ends
/// it at once.
const std::atomic<bool>& watch_interrupts();

/// From now on, whoever reads the progress may go away, and the work goes on.
void outlive_readers();

/// Writes to standard output, at once; tells why it could not.
std::error_code try_write_out(std::string_view text);

/// What such a failure is to the program: exit 4.
Error unwritten(const std::error_code& why);

/// As try_write_out(); throws that Error.
void write_out(std::string_view text);

/// One line of it, for people: whatever it quotes, it is shown and not obeyed.
template <class... Args>
void print_line(fmt::format_string<Args...> format, Args&&... args) {
    write_out(on_one_line(fmt::format(format, std::forward<Args>(args)...)) + "\n");
}

}  // namespace doppel
