#pragma once

#include "film/run.hpp"

#include <nlohmann/json_fwd.hpp>

#include <chrono>
#include <optional>
#include <string>
#include <system_error>

namespace doppel {

enum class ProgressStyle { bar, plain, json, none };

/// "auto" is a bar on a terminal and plain lines elsewhere.
ProgressStyle progress_style(const std::string& name);

/// Tells the person how far a run is: a bar that renews itself, a line every few seconds, or JSON lines for a program
/// (on standard output; the others on standard error).
class ProgressReport {
public:
    ProgressReport(ProgressStyle style, std::string name, std::string unit);

    void operator()(const Progress& progress);
    /// A sentence of its own.
    void note(const std::string& sentence);
    /// The run is done, and its files are there. Throws Error (exit 4) where a JSON line could not be written to
    /// someone who still listens.
    void done(const RunResult& result);
    /// Takes the bar off the screen, before an error is printed.
    void clear();

private:
    using Clock = std::chrono::steady_clock;

    /// A JSON line; what keeps it from being written does not end the run.
    void tell(const nlohmann::ordered_json& event);

    ProgressStyle style_;
    std::string name_, unit_;  // of what; "frames"
    Clock::time_point start_, shown_;
    std::optional<long> before_;  // done when first heard of, by an earlier run
    bool on_screen_ = false;
    std::error_code unheard_;  // why a JSON line could not be written
};

}  // namespace doppel
