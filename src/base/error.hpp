#pragma once

#include "base/text.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cerrno>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace doppel {

/// Exit codes of the process, one for each kind of outcome.
enum class ExitCode {
    done = 0,
    differs = 1,
    bad_input = 2,
    method_failed = 3,
    io_failed = 4,
    try_again = 75,
    interrupted = 130,
    terminated = 143
};

/// The only exception type of Doppel: a message for the user and an exit code. It is caught once, in main.
class Error : public std::runtime_error {
public:
    /// `further` = messages about other errors found at the same time. Messages are put on one line, and NUL characters
    /// are replaced.
    Error(ExitCode code, const std::string& message, std::vector<std::string> further = {})
        : std::runtime_error(on_one_line(message)), code_(code), further_(std::move(further)) {}
    ExitCode code() const { return code_; }
    const std::vector<std::string>& further() const { return further_; }

private:
    ExitCode code_;
    std::vector<std::string> further_;
};

/// Makes the errors with this exit code: ERROR("{} is missing", name).
template <ExitCode code>
inline constexpr auto error_maker = []<class... Args>(fmt::format_string<Args...> format, Args&&... args) {
    return Error(code, fmt::format(format, std::forward<Args>(args)...));
};
/// Wrong usage or input.
inline constexpr auto bad_input = error_maker<ExitCode::bad_input>;
/// The method failed: divergence, NaN.
inline constexpr auto method_failed = error_maker<ExitCode::method_failed>;
/// Reading, drawing, encoding or writing failed.
inline constexpr auto io_failed = error_maker<ExitCode::io_failed>;
/// As above, but trying again may succeed: no space, another run is writing, a shard is missing.
inline constexpr auto try_again = error_maker<ExitCode::try_again>;

/// The exit code for a failed read or write with this errno.
inline ExitCode code_of_errno(int reason) {
    return reason == ENOSPC || reason == EDQUOT ? ExitCode::try_again : ExitCode::io_failed;
}

/// The user stopped the process (exit 130, or 143 for SIGTERM).
inline Error interrupted() {
    return {ExitCode::interrupted, "interrupted"};
}
inline void throw_if_set(const std::atomic<bool>& stop) {
    if (stop) throw interrupted();
}

}  // namespace doppel
