#pragma once

#include "base/error.hpp"
#include "base/text.hpp"
#include "film/run.hpp"

#include <fmt/format.h>
#include <nlohmann/json_fwd.hpp>

#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace doppel {

/// Becomes true when the person, or the system, asks the program to end (SIGINT, SIGTERM, SIGHUP). The second time ends
/// it at once.
const std::atomic<bool>& watch_interrupts();

/// Whether it was SIGTERM: exit 143 in place of 130.
bool was_terminated();

/// From now on, whoever reads the progress may go away, and the work goes on.
void ignore_sigpipe();

/// Writes to standard output, at once. Throws Error (exit 4).
void write_out(std::string_view text);

/// As write_out(), of files that are there: what nobody reads, because standard output is closed or its reader went, is
/// no failure.
void tell_of_files(std::string_view text);

/// One line of it, for people: whatever it quotes, it is shown and not obeyed.
template <class... Args>
void print_line(fmt::format_string<Args...> format, Args&&... args) {
    write_out(on_one_line(fmt::format(format, std::forward<Args>(args)...)) + "\n");
}

enum class ProgressStyle { bar, plain, json, none };

/// "auto" is a bar on a terminal and plain lines elsewhere.
ProgressStyle progress_style(const std::string& name);

/// Tells the person how far a run is: a bar that renews itself, a line every few seconds, or JSON lines for a program
/// (on standard output; the others on standard error).
class ProgressReport {
public:
    /// `streamed` = how the name of the one file ends that goes to standard output when the run is done, and nothing else
    /// does; empty: none.
    ProgressReport(ProgressStyle style, std::string name, std::string unit, std::string streamed = {});

    void operator()(const Progress& progress);
    /// A sentence of its own.
    void note(const std::string& sentence);
    /// One that is no progress: it is said in every style.
    void warn(const std::string& sentence);
    /// The run is done, and its files are there. Throws Error (exit 4) where that could not be written to someone who
    /// still listens.
    void done(const RunResult& result);
    /// Takes the bar off the screen, before an error is printed.
    void clear();

private:
    using Clock = std::chrono::steady_clock;

    /// A JSON line; what keeps it from being written does not end the run.
    void tell(const nlohmann::ordered_json& event);

    ProgressStyle style_;
    std::string name_, unit_, streamed_;  // of what; "frames"
    Clock::time_point start_, shown_;
    std::optional<long> before_;  // done when first heard of, by an earlier run
    bool on_screen_ = false;
    int write_error_ = 0;  // errno: why a JSON line could not be written
};

}  // namespace doppel
