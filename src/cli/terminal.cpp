#include "cli/terminal.hpp"

#include "base/machine.hpp"
#include "base/text.hpp"
#include "scene/captions.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <system_error>
#include <vector>

namespace doppel {

namespace {

// signal handlers can only use globals; these are local to this file
std::atomic<bool> stop_requested = false, termination_requested = false;
std::atomic<double> requested_s = 0;  // when, by CLOCK_MONOTONIC
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<double>::is_always_lock_free);

/// Writes to standard output without buffering; returns errno, or 0.
int write_error(std::string_view text) {
    return std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0 ? 0 : errno;
}

/// Throws Error (exit 4) for such an errno.
void check_written(int error) {
    if (error != 0)
        throw Error(code_of_errno(error),
                    fmt::format("standard output cannot be written: {}", std::generic_category().message(error)));
}

/// The first characters of the text that fit into so many columns. From U+1100 on, a character may take two.
std::string_view fitting(std::string_view text, long columns) {
    auto rest = text;
    while (!rest.empty()) {
        auto after = rest;
        const int width = next_character(after) < 0x1100 ? 1 : 2;
        if (width > columns) break;
        columns -= width, rest = after;
    }
    return text.substr(0, text.size() - rest.size());
}

/// The progress on one line of the terminal: with a bar, a shorter one, or none.
std::string bar_line(const std::string& name, double share, const std::string& numbers) {
    constexpr long usual = 28, shortest = 6;
    winsize window{};
    const bool is_known = ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 0;
    const long columns = is_known ? window.ws_col - 1 : std::numeric_limits<long>::max();
    const auto line = name + " " + numbers;
    auto width = usual;
    while (width >= shortest && fitting(line, columns - width - 1) != line) --width;
    if (width < shortest) return std::string(fitting(line, columns));
    std::string bar;
    for (long i = 0; i < width; ++i) bar += i < static_cast<long>(share * static_cast<double>(width)) ? "━" : "─";
    return name + " " + bar + " " + numbers;
}

/// Per second, with two digits if it is below 10.
std::string rate_text(double rate) {
    return rate < 10 ? two_digits(rate) : fmt::format("{:.0f}", rate);
}

/// Prints to standard error; if nobody reads it, the run continues.
template <class... Args>
void tell(fmt::format_string<Args...> format, Args&&... args) {
    std::fputs(fmt::format(format, std::forward<Args>(args)...).c_str(), stderr);
}

/// "PATH (size)", or "FOLDER/"; sanitised for a terminal.
std::string file_line(const std::filesystem::path& file) {
    std::error_code unknown;  // the file may have been moved meanwhile
    const auto size = std::filesystem::file_size(file, unknown);
    const auto more = std::filesystem::is_directory(file, unknown) ? "/"
                      : unknown                                    ? ""
                                : fmt::format(" ({})", bytes_text(static_cast<double>(size)));
    return (isatty(STDOUT_FILENO) ? on_one_line(file.string()) : file.string()) + more;
}

/// Copies the file to standard output until the reader closes it.
void stream_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::vector<char> bytes(1 << 20);
    while (file.read(bytes.data(), static_cast<std::streamsize>(bytes.size())) || file.gcount() > 0) {
        const int error = write_error({bytes.data(), static_cast<std::size_t>(file.gcount())});
        if (error == EPIPE) return;
        check_written(error);
    }
    if (!file.eof()) throw io_failed("{}: cannot be read", path.string());
}

}  // namespace

const std::atomic<bool>& watch_interrupts() {
    struct sigaction action {};
    action.sa_handler = [](int signal) {
        const double now = seconds_of(CLOCK_MONOTONIC);
        if (!stop_requested) {
            requested_s = now;
            termination_requested = signal == SIGTERM;
            stop_requested = true;
        } else if (now - requested_s > 1) {
            std::signal(signal, SIG_DFL);
            std::raise(signal);  // ends the process when this handler returns
        }
    };
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    // the terminal was closed; nohup's setting is respected
    struct sigaction before {};
    if (sigaction(SIGHUP, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
    return stop_requested;
}

bool was_terminated() {
    return termination_requested;
}

void ignore_sigpipe() {
    std::signal(SIGPIPE, SIG_IGN);
}

void write_out(std::string_view text) {
    check_written(write_error(text));
}

void report_files(std::string_view text) {
    const int error = write_error(text);
    if (error != EPIPE && error != EBADF) check_written(error);
}

ProgressReport::ProgressReport(ProgressStyle style, std::string name, std::string unit, std::string streamed)
    : style_(style != ProgressStyle::automatic ? style
             : isatty(STDERR_FILENO)           ? ProgressStyle::bar
                                               : ProgressStyle::plain),
      name_(std::move(name)),
      unit_(std::move(unit)),
      streamed_(std::move(streamed)),
      start_(Clock::now()),
      shown_(start_) {}

void ProgressReport::operator()(const Progress& progress) {
    if (style_ == ProgressStyle::none || progress.total == 0) return;
    const auto now = Clock::now();
    if (!before_) {
        before_ = progress.done;
        start_ = now;
    }
    const auto pause = style_ == ProgressStyle::bar    ? std::chrono::milliseconds(100)
                       : style_ == ProgressStyle::json ? std::chrono::milliseconds(500)
                                                       : std::chrono::milliseconds(5000);
    if (now - shown_ < pause || progress.done == *before_) return;
    shown_ = now;

    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const double rate = static_cast<double>(progress.done - *before_) / elapsed;
    const double left = static_cast<double>(progress.total - progress.done) / rate;
    const double share = static_cast<double>(progress.done) / static_cast<double>(progress.total);
    if (style_ == ProgressStyle::json) {
        write_event({{"event", "progress"},
                     {"preset", name_},
                     {"unit", unit_},
                     {"done", progress.done},
                     {"total", progress.total},
                     {"per_second", rate},
                     {"seconds_left", left}});
    } else if (style_ == ProgressStyle::bar) {
        const auto numbers = fmt::format("{:3.0f} %  {}/{} {}  {} {}/s  {} left", 100 * share, progress.done,
                                         progress.total, unit_, rate_text(rate), unit_, duration_text(left));
        tell("\r\033[K{}", bar_line(name_, share, numbers));
        on_screen_ = true;
    } else {
        tell("{}: {}/{} {} ({:.0f} %), {} {}/s, {} left\n", name_, progress.done, progress.total, unit_, 100 * share,
             rate_text(rate), unit_, duration_text(left));
    }
}

void ProgressReport::of_proof(long done, long total, const std::string& arithmetic) {
    if (!arithmetic_.empty() && arithmetic != arithmetic_) {
        note(fmt::format("{} does not suffice; again in {}", arithmetic_, arithmetic));
        before_.reset();
    }
    arithmetic_ = arithmetic;
    (*this)({done, total});
}

void ProgressReport::warn(const std::string& sentence) {
    clear();
    if (style_ == ProgressStyle::json)
        write_event({{"event", "note"}, {"preset", name_}, {"text", sentence}});
    else
        tell("{}: {}\n", name_, on_one_line(sentence));
}

void ProgressReport::write_event(const nlohmann::ordered_json& event) {
    const auto line = event.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    if (!streamed_.empty()) return tell("{}", line);
    const int error = write_error(line);
    if (error != 0 && error != EPIPE) write_error_ = error;  // the reader may close the pipe
}

void ProgressReport::clear() {
    if (on_screen_) tell("\r\033[K");
    on_screen_ = false;
}

void ProgressReport::done(const RunResult& result) {
    clear();
    for (const auto& warning : result.warnings) warn(warning);
    if (!streamed_.empty())
        for (const auto& file : result.files)
            if (file.extension() == streamed_) stream_file(file);
    const long count = result.frames > 0 ? result.frames : result.samples;
    if (style_ == ProgressStyle::json) {
        nlohmann::ordered_json line = {
            {"event", "done"}, {"preset", name_}, {"unit", unit_}, {"done", count}, {"wall_s", result.wall_s}};
        for (const auto& file : result.files)
            if (streamed_.empty()) line["files"].push_back(file.string());
        write_event(line);
        return check_written(write_error_);
    }
    constexpr long few = 10;  // too few for a meaningful rate
    if (style_ != ProgressStyle::none && count < few)
        tell("{}: done in {:.1f} s\n", name_, result.wall_s);
    else if (style_ != ProgressStyle::none)
        tell("{}: {} {} in {:.1f} s, {} {}/s\n", name_, count, unit_, result.wall_s,
             rate_text(static_cast<double>(count) / result.wall_s), unit_);
    if (!streamed_.empty()) return;
    std::string lines;
    for (const auto& file : result.files) lines += file_line(file) + "\n";
    report_files(lines);
}

}  // namespace doppel
