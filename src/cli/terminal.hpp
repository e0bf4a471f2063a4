#pragma once

#include "base/error.hpp"
#include "base/text.hpp"
#include "film/run.hpp"
#include "scene/field.hpp"

#include <fmt/format.h>
#include <nlohmann/json_fwd.hpp>

#include <array>
#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace doppel {

/// Becomes true when the user or the system asks the program to end (SIGINT, SIGTERM, SIGHUP). A signal within a
/// second is the same request (timeout sends two); a later one ends it at once.
const std::atomic<bool>& watch_interrupts();

/// Whether it was SIGTERM: exit 143 instead of 130.
bool was_terminated();

/// From now on, readers of the progress may close the pipe, and the work continues.
void ignore_sigpipe();

/// Writes to standard output without buffering. Throws Error (exit 4).
void write_out(std::string_view text);

/// As write_out(), about files that are complete: a closed standard output or a reader that left is no failure.
void report_files(std::string_view text);

/// Writes one line for people; quoted text is sanitised.
template <class... Args>
void print_line(fmt::format_string<Args...> format, Args&&... args) {
    write_out(on_one_line(fmt::format(format, std::forward<Args>(args)...)) + "\n");
}

/// automatic: a bar on a terminal, and plain lines otherwise.
enum class ProgressStyle { automatic, bar, plain, json, none };
template <>
inline constexpr auto names_of<ProgressStyle> = std::to_array<std::string_view>({"auto", "bar", "plain", "json",
                                                                                 "none"});

/// Shows the progress of a run: as a bar, as a line every few seconds, or as JSON lines for programs. JSON goes to
/// standard output, the others to standard error.
class ProgressReport {
public:
    /// `streamed` = extension of the one file that goes to standard output after the run; empty: none.
    ProgressReport(ProgressStyle style, std::string name, std::string unit, std::string streamed = {});
    ~ProgressReport() { clear(); }
    ProgressReport(const ProgressReport&) = delete;
    ProgressReport& operator=(const ProgressReport&) = delete;

    void operator()(const Progress& progress);
    void note(const std::string& sentence) {
        if (style_ != ProgressStyle::none) warn(sentence);
    }
    /// Of a proof (scene/scene.hpp).
    void of_proof(long done, long total, const std::string& arithmetic);
    /// Prints a warning, in every style.
    void warn(const std::string& sentence);
    /// Reports the end of the run and its files. Throws Error (exit 4) if that cannot be written, unless the reader has
    /// left.
    void done(const RunResult& result);
    /// Removes the bar from the screen, as the destructor does before an error is printed.
    void clear();

private:
    using Clock = std::chrono::steady_clock;

    /// Writes a JSON line; a failure does not end the run.
    void write_event(const nlohmann::ordered_json& event);

    ProgressStyle style_;
    std::string name_, unit_, streamed_;  // unit: "frames"
    std::string arithmetic_{};            // of the last of_proof()
    Clock::time_point start_, shown_;
    std::optional<long> before_;  // progress at the first report, from an earlier run
    bool on_screen_ = false;
    int write_error_ = 0;  // errno of a failed JSON line
};

}  // namespace doppel
